"""Spans of random triangles on random domains: every covered pixel of the domain, once."""

import random
from itertools import pairwise

import pytest
from hdl_bench.bench import Drive, simulate
from hdl_bench.pictures import (
    covered,
    prepare,
    prepared_values,
    random_triangles,
    small_machine,
)
from hdl_bench.streams import Sink, Source, no_pause, pauses

from cardcage.golden.commands import CHANNELS
from cardcage.hdl.span_walker import SpanWalker


def stride(interlace, units):
    """Distances in x and y between the pixels of a block of ``units`` of the machine's units."""
    axes = {1: "", 2: "y", 4: "xy", 8: "xyy", 16: "xyxy"}[interlace.units]
    fixed = axes[: (interlace.units // units).bit_length() - 1]
    return 1 << fixed.count("x"), 1 << fixed.count("y")


def blocks(first, end):
    """The domain as aligned blocks of a power of two of units, each as large as can be."""
    while first < end:
        size = 1
        while first % (2 * size) == 0 and first + 2 * size <= end:
            size *= 2
        yield first, size
        first += size


def expected_spans(configuration, display_list, prepared, first, end):
    """Runs (x, y, pixels, x stride), triangle by triangle, block by block, row by row."""
    interlace = configuration.interlace
    for index, primitive in enumerate(prepared.primitive):
        pixels = covered(display_list, primitive, interlace)
        for start, size in blocks(first, end):
            across, _ = stride(interlace, size)
            rows = {}
            for x, y in sorted(pixels):
                if start <= interlace.unit(x, y) < start + size:
                    rows.setdefault(y, []).append(x)
            for y in sorted(rows):
                assert all(b - a == across for a, b in pairwise(rows[y])), "a hole in a run"
                yield index, (rows[y][0], y, len(rows[y]), across)


def schedule(configuration, prepared, expected, first, end):
    """The clock of every span, and of the last row of every triangle, when nothing waits.

    Per block: a clock to load, one for each bit of the row stride, then a row a clock.
    """
    interlace = configuration.interlace
    spans, triangles, clock = {}, [], 0
    for index in range(len(prepared)):
        rows = range(int(prepared.top[index]), int(prepared.bottom[index]))
        for start, size in blocks(first, end):
            down = stride(interlace, size)[1]
            offset = min(interlace.pixel(unit, 0)[1] for unit in range(start, start + size))
            clock += 1 + down.bit_length() - 1
            walked = [row for row in rows if (row - offset) % down == 0]
            spans |= {(index, start, row): clock + place for place, row in enumerate(walked)}
            clock += max(1, len(walked))
        triangles.append(clock - 1)
    starts = {unit: start for start, size in blocks(first, end)
              for unit in range(start, start + size)}
    return [spans[index, starts[interlace.unit(x, y)], y]
            for index, (x, y, _, _) in expected], triangles


def run(configuration, display_list, first, end, pause):
    dut = SpanWalker(configuration=configuration)
    prepared = prepare(configuration, display_list)
    triangles = prepared_values(configuration, prepared)
    expected = list(expected_spans(configuration, display_list, prepared, first, end))
    source = Source(dut.triangles, triangles, pause[0])
    sink = Sink(dut.spans, len(expected), pause[1])

    def lines(ctx, clock):
        ctx.set(dut.total, configuration.units)
        ctx.set(dut.first, first)
        ctx.set(dut.end, end)

    simulate(dut, Drive(lines), source, sink, after=3)
    for span, (index, (x, y, pixels, across)) in zip(sink.items, expected, strict=True):
        assert (span.x, span.y, span.more, 1 << span.x_stride_bits) == (x, y, pixels - 1, across)
        triangle = triangles[index]
        assert (span.x_steps, span.y_steps) == (x - triangle["left"], y - triangle["top"])
        assert {part: span.planes.depth[part] for part in ("start", "step_x", "step_y")} == (
            triangle["planes"]["depth"])
        assert [span.planes[name] for name in CHANNELS] == [
            triangle["planes"][name] for name in CHANNELS]
    return prepared, expected, source, sink


#: Cards, the domain to walk, words (0: enough), picture.
MACHINES = {
    "one unit": ("PM", (0, 1), 0, (8, 8)),
    "all four units": ("PMMMM", (0, 4), 0, (8, 8)),
    "half of four": ("PMMPMM", (2, 4), 0, (9, 8)),
    "the first of four": ("PMPMMM", (0, 1), 0, (8, 8)),
    "three of four": ("PMPMMM", (1, 4), 0, (8, 7)),
    "unequal share of eight": ("PMPMMMMMPMM", (1, 6), 0, (8, 8)),
    "one of eight": ("PMMPMPMMMMM", (2, 3), 0, (8, 8)),
    "most of sixteen": ("PMMMPMMMMMMMMMMMPMM", (3, 14), 0, (8, 8)),
    "one of sixteen, small picture": ("PMMMMMPMPMMMMMMMMMM", (5, 6), 0, (8, 6)),
    "coarser": ("PMPMMM", (1, 4), 8, (8, 8)),
    "much coarser": ("PMM", (0, 2), 2, (8, 8)),
}


@pytest.mark.parametrize("machine", MACHINES)
@pytest.mark.parametrize("seed", range(2))
def test_spans_are_the_covered_pixels_of_the_domain(machine, seed):
    cards, (first, end), words, (width, height) = MACHINES[machine]
    configuration = small_machine(cards, width, height, words=words)
    display_list = random_triangles(f"{machine} {seed}", 60, width=width, height=height,
                                    extreme=True)
    _, expected, _, _ = run(configuration, display_list, first, end,
                            (pauses(f"in {seed}"), pauses(f"out {seed}")))
    assert len(expected) > 5


def test_gouraud_planes_pass_through():
    configuration = small_machine("PM", 8, 8, shading="gouraud")
    display_list = random_triangles(5, 4, width=8, height=8)
    dut = SpanWalker(configuration=configuration)
    triangles = prepared_values(configuration, prepare(configuration, display_list))
    sink = Sink(dut.spans)

    def lines(ctx, clock):
        ctx.set(dut.total, 1)
        ctx.set(dut.end, 1)

    simulate(dut, Drive(lines), Source(dut.triangles, triangles), sink, after=3)
    planes = [{name: {part: span.planes[name][part] for part in ("start", "step_x", "step_y")}
               for name in ("depth", *CHANNELS)} for span in sink.items]
    assert planes
    assert all(plane in [triangle["planes"] for triangle in triangles] for plane in planes)


@pytest.mark.parametrize("machine", MACHINES)
def test_latency_and_throughput(machine):
    cards, (first, end), words, (width, height) = MACHINES[machine]
    configuration = small_machine(cards, width, height, words=words)
    display_list = random_triangles(f"{machine} speed", 40, width=width, height=height)
    prepared, expected, source, sink = run(configuration, display_list, first, end,
                                           (no_pause, no_pause))
    spans, triangles = schedule(configuration, prepared, expected, first, end)
    assert sink.clocks == spans
    assert source.taken == triangles


def test_an_empty_domain_takes_a_clock_a_triangle_and_gives_nothing():
    configuration = small_machine("PPM")
    display_list = random_triangles(1, 30, width=8, height=8)
    dut = SpanWalker(configuration=configuration)
    triangles = prepared_values(configuration, prepare(configuration, display_list))
    source, sink = Source(dut.triangles, triangles), Sink(dut.spans)
    simulate(dut, Drive(lambda ctx, clock: ctx.set(dut.total, 1)), source, sink, after=5)
    assert source.taken == list(range(len(triangles)))
    assert not sink.items


def test_every_share_of_eight_units_adds_up():
    """Random cuts of the eight units into domains: together they are the covered pixels."""
    choose = random.Random("cuts")
    for round_ in range(3):
        cuts = sorted(choose.sample(range(1, 8), choose.randrange(1, 4)))
        ends = [0, *cuts, 8]
        cards = "".join("P" + "M" * (b - a) for a, b in pairwise(ends))
        configuration = small_machine(cards)
        display_list = random_triangles(f"cut {round_}", 5, width=8, height=8)
        pixels = []
        for first, end in pairwise(ends):
            _, _, _, sink = run(configuration, display_list, first, end,
                                (no_pause, pauses(round_)))
            pixels += [(span.x + step * (1 << span.x_stride_bits), span.y)
                       for span in sink.items for step in range(span.more + 1)]
        everything = [pixel for primitive in range(5)
                      for pixel in covered(display_list, primitive, configuration.interlace)]
        assert sorted(pixels) == sorted(everything)
