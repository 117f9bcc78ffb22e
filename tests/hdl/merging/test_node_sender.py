"""The units of a node one after the other, against units in software."""

import random

import pytest
from hdl_bench.bench import Agent, Drive, simulate
from hdl_bench.streams import Sink, no_pause, pauses

from cardcage.hdl.merging.node_sender import NodeSender

BITS = {"id_bits": 3, "address_bits": 5, "depth_bits": 9}


class Units(Agent):
    """Units that each have ``pixels[unit]`` to send, the first after ``first()`` clocks, the others
    each after ``gap()``; they settle after ``settle()`` clocks."""

    def __init__(self, lines, pixels, *, first=no_pause, gap=no_pause, settle=no_pause):
        self.lines, self.gap = lines, gap
        self.pixels = [list(pixels_of_unit) for pixels_of_unit in pixels]
        self.waits = [first() for _ in pixels]
        self.settle = settle()
        self.clock = 0
        self.started = None

    @property
    def finished(self):
        return self.started is not None and not any(self.pixels)

    def drive(self, ctx):
        lines, unit = self.lines, ctx.get(self.lines.unit)
        going = self.started is not None and self.clock > self.started
        left = self.pixels[unit] if going and unit < len(self.pixels) else []
        valid = bool(left) and self.waits[unit] == 0
        ctx.set(lines.settled, self.clock >= self.settle)
        ctx.set(lines.valid, valid)
        ctx.set(lines.pixel, left[0] if valid else dict.fromkeys(("address", "depth", "color"), 0))
        ctx.set(lines.more, len(left) > valid)
        self.offered = left if valid else None

    def sample(self, ctx):
        if ctx.get(self.lines.start):
            assert self.started is None and self.clock >= self.settle
            self.started = self.clock
        elif self.started is not None:
            self.waits = [max(0, wait - 1) for wait in self.waits]
        if self.offered and ctx.get(self.lines.ready):
            self.offered.pop(0)
            self.waits[ctx.get(self.lines.unit)] = self.gap()
        self.clock += 1


def random_pixels(pick, most):
    return [{"address": pick.randrange(32), "depth": pick.getrandbits(9),
             "color": pick.getrandbits(24)} for _ in range(pick.randint(0, most))]


def run(pixels, *, pause=no_pause, begin=0, **waits):
    dut = NodeSender(**BITS)
    units = Units(dut.units, pixels, **waits)
    wanted = [(0, unit, pixel["address"], pixel["depth"], pixel["color"])
              for unit, of_unit in enumerate(pixels) for pixel in of_unit]
    sink = Sink(dut.words, len(wanted) + 1, pause)

    def start(ctx, clock):
        ctx.set(dut.total, len(pixels))
        ctx.set(dut.start, clock == begin)

    simulate(dut, Drive(start), units, sink, after=10)
    *sent, last = sink.items
    assert [(word.last, word.pixel.unit, word.pixel.address, word.pixel.depth, word.pixel.color)
            for word in sent] == wanted
    assert last.last
    return units, sink


@pytest.mark.parametrize("units", [1, 2, 5, 7])
@pytest.mark.parametrize("seed", range(3))
def test_random_units(units, seed):
    """Slow ones, ones that have nothing, and a left neighbour that makes it wait."""
    pick = random.Random(f"{units} {seed}")
    name = f"node {units} {seed}"
    run([random_pixels(pick, pick.choice((0, 1, 12))) for _ in range(units)], begin=seed,
        pause=pauses(f"{name} takes"), first=pauses(f"{name} first"), gap=pauses(f"{name} gaps"),
        settle=pauses(f"{name} settle"))


@pytest.mark.parametrize("counts", [(3, 4, 1, 2), (0, 3, 0, 0), (0,), (5,)], ids=str)
def test_a_pixel_a_clock(counts):
    """From unit to unit; one that has none takes a clock."""
    pixels = [[{"address": address, "depth": unit, "color": address} for address in range(count)]
              for unit, count in enumerate(counts)]
    units, sink = run(pixels)
    assert units.started == 1  # a clock after start
    clocks = sum(max(1, count) for count in counts)
    assert sink.clocks[-1] == units.started + 1 + clocks
