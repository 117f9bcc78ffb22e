"""Boxes of triangles against the regions that a table gives an element."""

import random

import pytest
from amaranth.hdl import Module
from amaranth.lib import wiring
from amaranth.lib.wiring import In, Out
from hdl_bench.bench import Agent, simulate
from hdl_bench.regions import MACHINES, NEVER_LARGE, Deal, random_table, region_machine

from cardcage.hdl.backplane.region_lines import RegionLines
from cardcage.hdl.backplane.words import prepared_triangle_layout
from cardcage.hdl.regions.region_filter import RegionFilter


class Filtered(wiring.Component):
    """A filter in a module of its own."""

    def __init__(self, configuration):
        self.configuration = configuration
        self.filter = RegionFilter(configuration=configuration)
        super().__init__({
            "regions": In(RegionLines(configuration)),
            "element": In(configuration.element_bits),
            "triangle": In(prepared_triangle_layout(configuration)),
            "own": Out(4),
            "large": Out(1),
            "keep": Out(1),
        })

    def elaborate(self, platform):
        m = Module()
        share = self.filter.add_to(m, self.triangle, self)
        m.d.comb += [self.own.eq(share.own), self.large.eq(share.large), self.keep.eq(share.keep)]
        return m


def boxes(pick, configuration, count):
    """Left, right, top, bottom; most of a few pixels, some of none, some on the regions' edges."""
    regions = configuration.dealt_regions

    def sides(size, bits):
        begin = pick.choice((pick.randrange(size), pick.randrange(size) >> bits << bits))
        length = pick.choice((0, 1, 2, 1 << bits, (1 << bits) + 1, 2 << bits, size))
        return begin, min(size, begin + length)

    for _ in range(count):
        yield (*sides(configuration.width, regions.x_bits),
               *sides(configuration.height, regions.y_bits))


class Boxes(Agent):
    """A box in every clock once the table is there, and a clock later what is said of it."""

    def __init__(self, dut, table, element, seed, after):
        self.dut, self.table, self.element, self.after = dut, table, element, after
        self.boxes = list(boxes(random.Random(f"boxes {seed}"), dut.configuration, 200))
        self.kept, self.clock = [], 0

    @property
    def finished(self):
        return len(self.kept) == len(self.boxes)

    def drive(self, ctx):
        place = self.clock - self.after
        if 0 <= place < len(self.boxes):
            left, right, top, bottom = self.boxes[place]
            ctx.set(self.dut.triangle, {"left": left, "right": right, "top": top,
                                        "bottom": bottom})

    def sample(self, ctx):
        due = self.clock - self.after - RegionFilter.latency
        self.clock += 1
        if due < 0 or self.finished:
            return
        regions = self.dut.configuration.dealt_regions
        left, right, top, bottom = self.boxes[due]
        columns = range(left >> regions.x_bits, (right - 1 >> regions.x_bits) + 1)
        rows = range(top >> regions.y_bits, (bottom - 1 >> regions.y_bits) + 1)
        keep = ctx.get(self.dut.keep)
        if left >= right or top >= bottom:
            assert not keep
            self.kept.append("empty")
        elif len(columns) > 2 or len(rows) > 2:
            assert keep and ctx.get(self.dut.large)
            self.kept.append("large")
        else:
            own = {(row, column): self.table[row * regions.columns + column] == self.element
                   for row in rows for column in columns}
            bits = sum(bool(own.get((rows[0] + place // 2, columns[0] + place % 2))) << place
                       for place in range(4))
            assert not ctx.get(self.dut.large)
            assert (ctx.get(self.dut.own), keep) == (bits, bits > 0)
            self.kept.append("kept" if bits else "dropped")


@pytest.mark.parametrize("machine", MACHINES)
@pytest.mark.parametrize("seed", range(2))
def test_what_meets_a_region_of_its_own_is_kept(machine, seed):
    """A triangle in every clock; the table of before is not looked at."""
    configuration = region_machine(machine)
    before, table = (random_table(configuration, f"{machine} {seed} {which}") for which in range(2))
    element = seed % configuration.processing_elements
    dut = Filtered(configuration)
    deal = Deal(dut.regions, configuration, [before, table], dut.element, element)
    found = Boxes(dut, table, element, f"{machine} {seed}", deal.clocks)
    simulate(dut, deal, found)
    kinds = {"empty", "large", "kept", "dropped"} - ({"large"} if machine in NEVER_LARGE else set())
    assert set(found.kept) == kinds and RegionFilter.latency == 1
