"""The units of a node, two at a time and these in turn, against units in software."""

import random

import pytest
from hdl_bench.bench import Drive, simulate
from hdl_bench.sending_units import Units, in_turn, random_pixels
from hdl_bench.streams import Sink, no_pause, pauses

from cardcage.hdl.merging.node_sender import NodeSender

BITS = {"id_bits": 3, "address_bits": 5, "depth_bits": 9}


def run(pixels, *, pause=no_pause, begin=0, **waits):
    dut = NodeSender(**BITS)
    units = Units(dut.units, pixels, **waits)
    wanted = [(0, unit, pixel["address"], pixel["depth"], pixel["color"])
              for unit, pixel in in_turn(pixels)]
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
