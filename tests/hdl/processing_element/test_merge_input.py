"""Which fragments reach the depth test, and when they are somebody else's drawing."""

import random

import pytest
from hdl_bench.bench import Drive, Watch, simulate
from hdl_bench.streams import Sink, Source, no_pause, pauses

from cardcage.hdl.processing_element.merge_input import MergeInput

BITS = {"id_bits": 4, "address_bits": 5, "depth_bits": 9}


def random_fragments(pick, count):
    return [{"unit": pick.randrange(16), "address": pick.getrandbits(5),
             "depth": pick.getrandbits(9), "color": pick.getrandbits(24)} for _ in range(count)]


def values(items):
    return [tuple(getattr(item, name) for name in ("unit", "address", "depth", "color"))
            for item in items]


@pytest.mark.parametrize(("first", "end"), [(0, 1), (3, 7), (8, 15), (5, 5)])
@pytest.mark.parametrize("stall", [False, True])
def test_drawing_then_merging(first, end, stall):
    """What is drawn goes through as it is; of what is received, the domain's own."""
    pick = random.Random(f"{first} {end}")
    drawn, received = random_fragments(pick, 20), random_fragments(pick, 60)
    mine = [pixel for pixel in received if first <= pixel["unit"] < end]
    dut = MergeInput(**BITS)
    name = f"{first} {end}"
    pause = pauses if stall else lambda seed: no_pause
    drawing = Source(dut.drawn, drawn, pause(f"{name} drawn"))

    class Later(Source):
        """Nothing is received while anything is drawn."""

        def drive(self, ctx):
            if drawing.finished:
                super().drive(ctx)

    merging = Later(dut.received, received, pause(f"{name} received"))
    sink = Sink(dut.fragments, len(drawn) + len(mine), pause(f"{name} takes"))
    begun = None

    def domain(ctx, clock):
        ctx.set(dut.first, first)
        ctx.set(dut.end, end)

    def watch(ctx, clock):
        nonlocal begun
        assert ctx.get(dut.merging) == (begun is not None)
        if begun is None and ctx.get(dut.received.valid):
            begun = clock

    simulate(dut, Drive(domain), drawing, merging, sink, Watch(watch), after=4)
    assert begun is not None
    assert values(sink.items) == [tuple(pixel.values()) for pixel in drawn + mine]
    if not stall:  # one that is another element's takes a clock as well
        assert drawing.taken == list(range(20))
        assert merging.taken == list(range(20, 80))
        own = [clock for clock, pixel in zip(merging.taken, received, strict=True)
               if pixel in mine]
        assert sink.clocks == [*drawing.taken, *own]


def test_a_new_frame_is_drawing_again():
    dut = MergeInput(**BITS)
    said = []

    def drive(ctx, clock):
        ctx.set(dut.received.valid, clock in (1, 6))
        ctx.set(dut.frame_start, clock == 4)

    simulate(dut, Drive(drive), Watch(lambda ctx, clock: said.append(ctx.get(dut.merging)), 9))
    assert said == [0, 0, 1, 1, 1, 0, 0, 1, 1]
