"""Boxes of triangles against the pixels of a domain, as the golden interlace gives them."""

import random

import numpy as np
import pytest
from amaranth.hdl import Module
from amaranth.lib import wiring
from amaranth.lib.wiring import In, Out
from hdl_bench.bench import Agent, simulate
from hdl_bench.pictures import small_machine

from cardcage.hdl.backplane.words import prepared_triangle_layout, row_shape
from cardcage.hdl.mapping.lattice import LatticeBlock
from cardcage.hdl.processing_element.share_filter import ShareFilter

#: Machines with what is odd about them; each aligned block of units is tried as a domain.
MACHINES = {
    "one unit": {"cards": "PM"},
    "interlaced pixel by pixel": {"cards": "8x(PM)", "width": 13, "height": 11},
    "in squares": {"cards": "4x(PMM)", "block": 4, "width": 21, "height": 18},
    "skewed": {"cards": "8x(PM)", "skew": True, "width": 16, "height": 16},
}


class Filtered(wiring.Component):
    """A filter in a module of its own, and the lattice of the domain it is told."""

    def __init__(self, configuration):
        self.configuration = configuration
        self.filter = ShareFilter(configuration=configuration)
        super().__init__({
            "first": In(configuration.id_bits),
            "end": In(configuration.id_bits),
            "whole": In(1),
            "triangle": In(prepared_triangle_layout(configuration)),
            "first_row": Out(row_shape(configuration)),
            "keep": Out(1),
        })

    def elaborate(self, platform):
        m = Module()
        m.submodules.block = block = LatticeBlock(configuration=self.configuration)
        inputs = wiring.Signature(self.filter.members).create()
        share = self.filter.add_to(m, self.triangle, inputs)
        m.d.comb += [
            block.total.eq(self.configuration.units),
            block.first.eq(self.first),
            block.end.eq(self.end),
            inputs.lattice.eq(block.lattice),
            inputs.whole.eq(self.whole),
            self.first_row.eq(share.first_row),
            self.keep.eq(share.keep),
        ]
        return m


def owned_pixels(configuration, first, end):
    """bool [row, column]: it belongs to one of the units."""
    interlace = configuration.interlace
    y, x = np.mgrid[:interlace.height, :interlace.width]
    unit = interlace.unit(x, y)
    return (first <= unit) & (unit < end)


def boxes(pick, width, height, count):
    """Left, right, top, bottom of boxes with at least a pixel, most of them small."""
    for _ in range(count):
        left, top = pick.randrange(width), pick.randrange(height)
        yield (left, min(width, left + pick.choice((1, 1, 2, 3, width))),
               top, min(height, top + pick.choice((1, 1, 2, 3, height))))


class Boxes(Agent):
    """A box in every clock, and a clock later whether it was kept."""

    def __init__(self, dut, first, end, whole, seed):
        self.dut, self.lines = dut, {"first": first, "end": end, "whole": whole}
        self.owned = owned = owned_pixels(dut.configuration, first, end)
        height, width = owned.shape
        pick = random.Random(f"boxes {seed}")
        self.boxes = list(boxes(pick, width, height, 60))
        # Of shifted rows every column counts that some row owns.
        self.rows, self.columns = owned.any(axis=1), owned.any(axis=0)
        self.kept, self.clock = [], 0

    @property
    def finished(self):
        return len(self.kept) == len(self.boxes)

    def drive(self, ctx):
        for name, value in self.lines.items():
            ctx.set(getattr(self.dut, name), value)
        if self.clock < len(self.boxes):
            left, right, top, bottom = self.boxes[self.clock]
            ctx.set(self.dut.triangle, {"left": left, "right": right, "top": top,
                                        "bottom": bottom})

    def sample(self, ctx):
        if self.clock < len(self.boxes):
            *_, top, bottom = self.boxes[self.clock]
            owned = np.flatnonzero(self.rows[top:bottom])
            row = ctx.get(self.dut.first_row)
            assert row == top + owned[0] if owned.size else row >= bottom
        due = self.clock - ShareFilter.latency
        if due >= 0:
            left, right, top, bottom = self.boxes[due]
            keep = bool(ctx.get(self.dut.keep))
            assert keep == (not self.lines["whole"] or bool(
                self.rows[top:bottom].any() and self.columns[left:right].any()))
            assert keep or not self.owned[top:bottom, left:right].any()
            self.kept.append(keep)
        self.clock += 1


def run(configuration, first, end, *, whole=1):
    seed = f"{configuration.cards} {first} {end} {whole}"
    print(f"seed {seed}")
    boxes = Boxes(Filtered(configuration), first, end, whole, seed)
    simulate(boxes.dut, boxes)
    return boxes


@pytest.mark.parametrize("machine", MACHINES)
def test_what_may_have_pixels_of_the_domain_is_kept(machine):
    """Each aligned block of units; without shifted rows a box is kept just where it has pixels."""
    configuration = small_machine(**MACHINES[machine])
    kept = dropped = 0
    for bits in range(configuration.share_bits, configuration.units.bit_length()):
        if configuration.square_bits and bits != configuration.share_bits:
            continue  # in squares a share is the only block
        for first in range(0, configuration.units, 1 << bits):
            run_ = run(configuration, first, first + (1 << bits))
            kept += sum(run_.kept)
            dropped += len(run_.kept) - sum(run_.kept)
            if not configuration.skew:
                for keep, (left, right, top, bottom) in zip(run_.kept, run_.boxes, strict=True):
                    assert keep == run_.owned[top:bottom, left:right].any()
    assert kept > 30
    assert dropped > 30 or machine == "one unit"


def test_a_domain_of_several_blocks_keeps_all():
    configuration = small_machine(**MACHINES["interlaced pixel by pixel"])
    assert all(run(configuration, 3, 4, whole=0).kept)
    assert not all(run(configuration, 3, 4).kept)
