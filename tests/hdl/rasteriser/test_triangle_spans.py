"""Spans of random triangles on random domains: every covered pixel of the domain, once."""

import random
from dataclasses import replace
from itertools import pairwise

import pytest
from hdl_bench.bench import Drive, Until, Watch, simulate
from hdl_bench.domains import IN_SQUARES, MACHINES, SETTLED, blocks
from hdl_bench.pictures import (
    covered,
    prepare,
    prepared_values,
    random_triangles,
    small_machine,
)
from hdl_bench.streams import Sink, Source, no_pause, once, pauses
from suite.cases import chosen

from cardcage.golden.specification import commands
from cardcage.hdl.rasteriser.triangle_spans import TriangleSpans


def stride(interlace, units):
    """Distances in x and y between the pixels of a block of ``units`` of the machine's units, or
    between its squares, where processing elements interlace in these, or between its rows, where
    these are shifted."""
    axes = {1: "", 2: "y", 4: "xy", 8: "xyy", 16: "xyxy"}[interlace.units >> interlace.share_bits]
    if interlace.skew and units == 1:
        axes = axes[:-1] + "x" * (interlace.units > 1)
    fixed = axes[: (interlace.units // units).bit_length() - 1]
    return 1 << fixed.count("x"), 1 << fixed.count("y")


def expected_spans(configuration, display_list, prepared, first, end):
    """Runs (x, y, pixels, x stride), triangle by triangle, block by block, row by row, and of a
    row square by square."""
    interlace = configuration.interlace
    for index, primitive in enumerate(prepared.primitive):
        pixels = covered(display_list, primitive, interlace)
        for start, size in blocks(first, end):
            across, _ = stride(interlace, size)
            in_squares = interlace.square_bits > 0 and across > 1
            step = 1 if interlace.square_bits else across
            runs = {}
            for x, y in sorted(pixels):
                if start <= interlace.unit(x, y) < start + size:
                    square = x >> interlace.square_bits if in_squares else 0
                    runs.setdefault((y, square), []).append(x)
            for (y, _), columns in sorted(runs.items()):
                assert all(b - a == step for a, b in pairwise(columns)), "a hole in a run"
                yield index, (columns[0], y, len(columns), step)


def owned_rows(interlace, start, size, top, bottom):
    """Rows top … bottom - 1 on which the block has pixels."""
    side, down = 1 << interlace.square_bits, stride(interlace, size)[1]
    offset = interlace.pixel(start, 0)[1] // side
    return [row for row in range(top, bottom) if (row // side - offset) % down == 0]


def schedule(configuration, prepared, expected, first, end):
    """The clock of every span, and that in which each triangle is taken, when nothing waits.

    A row a clock, and the next triangle at once; where there are several blocks, two clocks to
    find the first row of the first and three for that of each other.
    """
    interlace = configuration.interlace
    parts = list(blocks(first, end))
    whole = len(parts) == 1
    spans, triangles, clock = {}, [], SETTLED
    for index in range(len(prepared)):
        triangles.append(clock)
        walk = clock + (1 if whole else 3)
        for start, size in parts:
            walked = owned_rows(interlace, start, size, int(prepared.top[index]),
                                int(prepared.bottom[index]))
            spans |= {(index, start, row): walk + place + TriangleSpans.latency - 1
                      for place, row in enumerate(walked)}
            walk += max(1, len(walked)) + 3
        clock = walk - 4 + (0 if whole else 2)
    starts = {unit: start for start, size in parts for unit in range(start, start + size)}
    return [spans[index, starts[interlace.unit(x, y)], y]
            for index, (x, y, _, _) in expected], triangles


def reached(configuration, display_list, first, end):
    """Prepared triangles that have a row in the domain, as the queue before lets them through,
    with the first such row."""
    prepared = prepare(configuration, display_list)
    start, size = next(blocks(first, end), (0, 0))
    kept, values = [], []
    for index, triangle in enumerate(prepared_values(configuration, prepared)):
        # The one after the last row may lie past the picture.
        rows = (owned_rows(configuration.interlace, start, size, triangle["top"],
                           triangle["bottom"] + 64) if size == end - first else [0, 0])
        if rows[0] < triangle["bottom"]:
            kept.append(index)
            del triangle["planes"]
            values.append(triangle | {"first_row": rows[0], "second_row": rows[1],
                                      "one_row": rows[1] >= triangle["bottom"]})
    return kept, values


def columns(span):
    return range(span.x, span.end, span.stride)


def run(configuration, display_list, first, end, pause):
    dut = TriangleSpans(configuration=configuration)
    kept, triangles = reached(configuration, display_list, first, end)
    prepared = prepare(configuration, display_list)
    prepared = replace(prepared, **{name: getattr(prepared, name)[kept]
                                    for name in ("primitive", "top", "bottom")})
    expected = list(expected_spans(configuration, display_list, prepared, first, end))
    source = Source(dut.triangles, triangles, once(SETTLED, pause[0]))
    sink = Sink(dut.spans, pause=pause[1])

    def lines(ctx, clock):
        ctx.set(dut.total, configuration.units)
        ctx.set(dut.first, first)
        ctx.set(dut.end, end)
        ctx.set(dut.width, configuration.interlace.width)

    def ended():
        return sum(item.last for item in sink.items)

    def busy(ctx, clock):
        # A triangle is there from the clock after it is taken until its last span is taken.
        assert ctx.get(dut.busy) == (ended() < len(source.taken))

    simulate(dut, Drive(lines), Watch(busy), source, Until(ended, len(triangles)), sink, after=3)
    assert ended() == len(triangles)
    found = [(clock, span) for clock, span in zip(sink.clocks, sink.items, strict=True)
             if not span.none]
    for (_, span), (index, (x, y, pixels, across)) in zip(found, expected, strict=True):
        assert (span.x, span.y, len(columns(span)), span.stride) == (x, y, pixels, across)
        triangle = triangles[index]
        assert (span.left, span.y_steps) == (triangle["left"], y - triangle["top"])
    # What ends a triangle comes after all its spans.
    ends = [place for place, span in enumerate(sink.items) if span.last]
    assert ends == sorted(ends) and ends[-1] == len(sink.items) - 1
    return prepared, expected, source, found


@pytest.mark.parametrize("machine", MACHINES)
@pytest.mark.parametrize(("seed", "skew"), [(0, False), (1, True)])
def test_spans_are_the_covered_pixels_of_the_domain(machine, seed, skew):
    cards, (first, end), words, (width, height) = MACHINES[machine]
    configuration = small_machine(cards, width, height, words=words, skew=skew)
    display_list = random_triangles(f"{machine} {seed}", 60, width=width, height=height,
                                    extreme=True)
    _, expected, _, _ = run(configuration, display_list, first, end,
                            (pauses(f"in {seed}"), pauses(f"out {seed}")))
    assert len(expected) > 5


@pytest.mark.parametrize("machine", MACHINES)
@pytest.mark.parametrize("skew", chosen([False, True], True))
def test_latency_and_throughput(machine, skew):
    cards, (first, end), words, (width, height) = MACHINES[machine]
    configuration = small_machine(cards, width, height, words=words, skew=skew)
    display_list = random_triangles(f"{machine} speed", 40, width=width, height=height)
    prepared, expected, source, found = run(configuration, display_list, first, end,
                                            (no_pause, no_pause))
    spans, triangles = schedule(configuration, prepared, expected, first, end)
    assert [clock for clock, _ in found] == spans
    assert source.taken == triangles


@pytest.mark.parametrize("machine", IN_SQUARES)
@pytest.mark.parametrize("seed", [None, 0])
def test_spans_in_squares(machine, seed):
    """Row by row a span for each square; without pauses a span a clock, an empty row one too."""
    cards, block, (first, end), (width, height) = IN_SQUARES[machine]
    configuration = small_machine(cards, width, height, block=block)
    display_list = random_triangles(f"{machine} {seed}", 40, width=width, height=height,
                                    extreme=seed is not None)
    pause = (no_pause,) * 2 if seed is None else (pauses(f"in {seed}"), pauses(f"out {seed}"))
    prepared, expected, _, found = run(configuration, display_list, first, end, pause)
    assert len(expected) > 5
    if seed is not None:
        return
    clock, clocks = SETTLED + TriangleSpans.latency, []
    for index in range(len(prepared)):
        for row in owned_rows(configuration.interlace, first, end - first,
                              int(prepared.top[index]), int(prepared.bottom[index])):
            spans = sum((number, y) == (index, row) for number, (_, y, _, _) in expected)
            clocks += range(clock, clock + spans)
            clock += max(1, spans)
    assert [clock for clock, _ in found] == clocks


def any_outlines(configuration, first, end, source, count):
    """Outlines of random bits, but with ``top`` and ``bottom`` held to the picture; those that the
    queue before lets through."""
    interlace = configuration.interlace
    layout = commands.prepared_triangle_layout(configuration)
    del layout["planes"]
    (start, size), *others = blocks(first, end)
    found = []
    while len(found) < count:
        outline = commands.unpack(layout, source.getrandbits(commands.layout_bits(layout)))
        for row in ("top", "bottom"):
            outline[row] = min(outline[row], interlace.height)
        top, bottom = outline["top"], outline["bottom"]
        # Of several blocks nothing is known early: these are the lattice of none.
        rows = (source.choices(range(interlace.height), k=2) if others
                else owned_rows(interlace, start, size, top, top + 64))
        if others or rows[0] < bottom:
            found.append(outline | {"first_row": rows[0], "second_row": rows[1],
                                    "one_row": source.randrange(2) if others
                                    else rows[1] >= bottom})
    return found


@pytest.mark.parametrize("on_screen", chosen([False, True], True))
@pytest.mark.parametrize("machine", [*MACHINES, *IN_SQUARES])
def test_whatever_the_outline_its_spans_end_and_lie_in_the_picture(machine, on_screen):
    """Also where columns have no sign, but bits for more than the picture has."""
    if machine in MACHINES:
        cards, (first, end), words, (width, height) = MACHINES[machine]
        options = {"words": words}
    else:
        cards, block, (first, end), (width, height) = IN_SQUARES[machine]
        options = {"block": block}
    if on_screen:
        options["edge_column_bits"] = width.bit_length()
    configuration = small_machine(cards, width, height, **options)
    assert configuration.edges_on_screen == on_screen
    interlace = configuration.interlace
    outlines = any_outlines(configuration, first, end, random.Random(f"outlines {machine}"), 60)
    dut = TriangleSpans(configuration=configuration)
    source = Source(dut.triangles, outlines, once(SETTLED, no_pause))
    sink = Sink(dut.spans)

    def lines(ctx, clock):
        ctx.set(dut.total, configuration.units)
        ctx.set(dut.first, first)
        ctx.set(dut.end, end)
        ctx.set(dut.width, interlace.width)

    # A row or a span a clock, and three clocks more for a block.
    most = len(outlines) * interlace.height * (width + 3 * (end - first))
    simulate(dut, Drive(lines), source, Until(lambda: sum(item.last for item in sink.items),
                                              len(outlines)), sink, after=3, limit=most)
    assert sum(item.last for item in sink.items) == len(outlines)
    spans = [span for span in sink.items if not span.none]
    assert spans
    for span in spans:
        assert span.x < span.end <= interlace.width and span.y < interlace.height
        assert all(first <= interlace.unit(x, span.y) < end for x in columns(span))


def test_an_empty_domain_takes_a_clock_a_triangle_and_ends_each():
    configuration = small_machine("PPM")
    dut = TriangleSpans(configuration=configuration)
    _, triangles = reached(configuration, random_triangles(1, 30, width=8, height=8), 0, 1)
    source = Source(dut.triangles, triangles, once(SETTLED, no_pause))
    sink = Sink(dut.spans, len(triangles))
    simulate(dut, Drive(lambda ctx, clock: ctx.set(dut.total, 1)), source, sink, after=5)
    assert source.taken == [SETTLED + place for place in range(len(triangles))]
    assert all(span.none and span.last for span in sink.items)


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
            _, _, _, found = run(configuration, display_list, first, end,
                                 (no_pause, pauses(round_)))
            pixels += [(x, span.y) for _, span in found for x in columns(span)]
        everything = [pixel for primitive in range(5)
                      for pixel in covered(display_list, primitive, configuration.interlace)]
        assert sorted(pixels) == sorted(everything)
