"""Spans of random triangles in the regions of a random table: every covered pixel there, once."""

import random

import pytest
from hdl_bench.bench import Until, Watch, simulate
from hdl_bench.pictures import covered, random_triangles
from hdl_bench.regions import (
    MACHINES,
    NEVER_LARGE,
    Deal,
    Dealt,
    random_table,
    region_machine,
)
from hdl_bench.streams import Sink, Source, no_pause, once, pauses
from suite.cases import chosen

from cardcage.golden.specification import commands
from cardcage.hdl.rasteriser.triangle_spans import TriangleSpans
from cardcage.hdl.regions.region_spans import RegionSpans


def dealt(machine, seed, count=50, **changes):
    configuration = region_machine(machine, **changes)
    display_list = random_triangles(f"{machine} {seed}", count, width=configuration.width,
                                    height=configuration.height, extreme=True)
    table = random_table(configuration, f"{machine} {seed}")
    return display_list, Dealt(configuration, table, seed % configuration.processing_elements,
                               display_list)


def run(case, pause, kept=None):
    """Every span compared; returns the clocks in which triangles were taken and in which rows
    were cut, the spans with their clocks, and the visits of each triangle."""
    configuration = case.configuration
    kept = case.kept() if kept is None else kept
    dut = RegionSpans(configuration=configuration)
    # The table before is another one: the one that is meant must be read.
    before = random_table(configuration, "before")
    deal = Deal(dut.regions, configuration, [before, case.table], dut.element, case.element)
    source = Source(dut.triangles, [case.outline(index) for index in kept],
                    once(deal.clocks, pause[0]))
    sink = Sink(dut.spans, pause=pause[1])
    rows = []

    def ended():
        return sum(item.last for item in sink.items)

    def watch(ctx, clock):
        row = ctx.get(dut.row)
        if row.valid:
            rows.append((clock, row.slot, row.pixels, row.ends))
        assert ctx.get(dut.busy) or ended() == len(source.taken)

    simulate(dut, deal, Watch(watch), source, Until(ended, len(kept)), sink, after=3, limit=100_000)
    visits = [case.visits(index) for index in kept]
    expected, expected_rows = [], []
    for index, visited in zip(kept, visits, strict=True):
        triangle = case.values[index]
        for visit in visited:
            for y, first, beyond in visit.rows:
                ends = y == visit.rows[-1][0]
                expected_rows.append((visit.slot, max(0, beyond - first), ends))
                last = ends and visit is visited[-1]
                if first < beyond:
                    expected.append((first, beyond, y, triangle["left"], y - triangle["top"],
                                     visit.slot, 0, last))
                elif last:
                    expected.append((1, 1))
        if not visited:
            expected.append((1, 1))
    got = [(item.none, item.last) if item.none else
           (item.x, item.end, item.y, item.left, item.y_steps, item.slot, item.none, item.last)
           for item in sink.items]
    assert got == expected
    assert [row[1:] for row in rows] == expected_rows
    return source.taken, rows, sink, visits, kept, deal


@pytest.mark.parametrize("machine", MACHINES)
@pytest.mark.parametrize("seed", [1])
def test_spans_are_those_of_its_visits(machine, seed):
    _, case = dealt(machine, seed)
    *_, visits, kept, _ = run(case, (pauses(f"in {seed}"), pauses(f"out {seed}")))
    assert sum(map(len, visits)) > 20
    assert any(map(case.large, kept)) == (machine not in NEVER_LARGE)


@pytest.mark.parametrize("machine", MACHINES)
def test_all_elements_together_have_every_covered_pixel_once(machine):
    display_list, case = dealt(machine, 7, count=12)
    pixels = []
    for element in range(case.configuration.processing_elements):
        other = Dealt(case.configuration, case.table, element, display_list)
        kept = other.kept()
        if kept:
            _, _, sink, *_ = run(other, (no_pause, no_pause))
            pixels += [(x, span.y) for span in sink.items if not span.none
                       for x in range(span.x, span.end)]
    everything = [pixel for primitive in range(display_list.triangles)
                  for pixel in covered(display_list, primitive, _whole(case.configuration))]
    assert sorted(pixels) == sorted(everything)


def _whole(configuration):
    return configuration.pictures()[0]


@pytest.mark.parametrize("machine", MACHINES)
def test_a_row_a_clock_without_bubbles_where_boxes_are_small(machine):
    _, case = dealt(machine, 3, count=300)
    kept = [index for index in case.kept() if not case.large(index)][:30]
    assert len(kept) > 10
    taken, rows, sink, visits, *_, deal = run(case, (no_pause, no_pause), kept)
    lengths = [[len(visit.rows) for visit in visited] for visited in visits]
    total = sum(map(sum, lengths))
    first = deal.clocks + RegionSpans.latency - 1
    assert [clock for clock, *_ in rows] == list(range(first, first + total))
    assert sink.clocks[-1] == first + total
    # A triangle leaves when its last visit begins.
    clock, expected = deal.clocks, []
    for visited in lengths:
        expected.append(clock + sum(visited[:-1]))
        clock += sum(visited)
    assert taken == expected


def test_a_row_takes_as_long_as_without_regions():
    assert RegionSpans.latency == TriangleSpans.latency


def any_outlines(case, seed, count):
    """Outlines of random bits that the filter lets through: each box has rows in the picture, and
    columns, where these are few with bits for regions that it may have."""
    source = random.Random(f"outlines {seed}")
    regions, height = case.regions, case.configuration.height
    layout = commands.prepared_triangle_layout(case.configuration)
    del layout["planes"]
    for _ in range(count):
        outline = commands.unpack(layout, source.getrandbits(commands.layout_bits(layout)))
        outline["top"] %= height
        outline["bottom"] = source.randint(outline["top"] + 1, height)
        sides = sorted(source.sample(range(1 << case.configuration.x_bits), 2))
        outline |= {"left": sides[0], "right": sides[1]}
        across = (sides[1] - 1 >> regions.x_bits) - (sides[0] >> regions.x_bits)
        down = (outline["bottom"] - 1 >> regions.y_bits) - (outline["top"] >> regions.y_bits)
        large = across > 1 or down > 1
        own = [1, 3, 5, 15][min(across, 1) + 2 * min(down, 1)]
        yield outline | {"large": large, "own": 0 if large else
                         source.choice([bits for bits in range(1, 16) if bits & ~own == 0])}


@pytest.mark.parametrize("on_screen", chosen([False, True], True))
@pytest.mark.parametrize("machine", MACHINES)
def test_whatever_the_outline_its_spans_end_and_lie_in_its_regions(machine, on_screen):
    """Also where columns have no sign, but bits for more than the picture has."""
    size = MACHINES[machine][1]
    _, case = dealt(machine, 5, 1, **(
        {"edge_column_bits": size[0].bit_length()} if on_screen else {}))
    configuration = case.configuration
    assert configuration.edges_on_screen == on_screen
    outlines = list(any_outlines(case, f"{machine} {on_screen}", 60))
    dut = RegionSpans(configuration=configuration)
    deal = Deal(dut.regions, configuration, [case.table], dut.element, case.element)
    source = Source(dut.triangles, outlines, once(deal.clocks, no_pause))
    sink = Sink(dut.spans)
    simulate(dut, deal, source, Until(lambda: sum(item.last for item in sink.items),
                                      len(outlines)), sink, after=9, limit=60_000)
    assert sum(item.last for item in sink.items) == len(outlines)
    large = iter(outlines)
    outline = next(large)
    for span in sink.items:
        if not span.none:
            assert span.x < span.end <= configuration.width and span.y < configuration.height
            assert span.x >> case.regions.x_bits == span.end - 1 >> case.regions.x_bits
            if outline["large"]:  # of a small box the bits say what is its own
                assert case.own(span.x >> case.regions.x_bits, span.y >> case.regions.y_bits)
        if span.last:
            outline = next(large, None)
