"""Columns of edges at rows in any order, against the intercept as a rational number."""

import random
from fractions import Fraction
from math import ceil

import pytest
from hdl_bench.bench import Drive, simulate
from hdl_bench.pictures import prepare, prepared_values, random_triangles, small_machine
from hdl_bench.streams import Sink, Source, no_pause, pauses

from cardcage.golden.specification.sampling_grid import Grid
from cardcage.hdl.rasteriser.edge_columns import EdgeColumns


def first_column(begin, end, row, grid):
    """The first pixel whose sample is not left of the edge, on the sample line of ``row``."""
    y = Fraction(row * grid.unit_y + grid.unit_y // 2)
    x = begin[0] + (y - begin[1]) * Fraction(end[0] - begin[0], end[1] - begin[1])
    return ceil((x - grid.unit_x // 2) / grid.unit_x)


def extents(display_list, prepared, values, grid, seed):
    """Rows as they are sent, in any order, and where each must begin and end."""
    source = random.Random(f"rows {seed}")
    found = []
    for index, triangle in enumerate(values):
        low, mid, high = sorted(map(tuple, display_list.position[prepared.primitive[index]]
                                    .tolist()), key=lambda corner: corner[1])
        for y in range(triangle["top"], triangle["bottom"]):
            upper = y < triangle["middle"]
            columns = [first_column(low, high, y, grid),
                       first_column(*((low, mid) if upper else (mid, high)), y, grid)]
            if not triangle["long_edge_left"]:
                columns.reverse()
            begin, end = (min(max(column, 0), grid.width) for column in columns)
            row = {
                "y": y, "rows": y - triangle["top"],
                "short_rows": y - triangle["top" if upper else "middle"],
                "long_edge_left": triangle["long_edge_left"], "long": triangle["long"],
                "short": triangle["upper" if upper else "lower"], "left": triangle["left"],
                "none": source.randrange(2), "last": source.randrange(2),
            }
            found.append((row, {"first": begin, "beyond": end, **{
                name: row[name] for name in ("y", "rows", "left", "none", "last")}}))
    source.shuffle(found)
    return found


def run(seed, words, shifts, pause):
    configuration = small_machine("PM", 16, 16, words=words, sub_bits=3)
    interlace = configuration.interlace
    assert (interlace.x_shift, interlace.y_shift) == shifts
    display_list = random_triangles(seed, 40, width=16, height=16, sub_bits=3, extreme=True)
    prepared = prepare(configuration, display_list)
    wanted = extents(display_list, prepared, prepared_values(configuration, prepared),
                     Grid.of(display_list, *shifts), seed)
    dut = EdgeColumns(configuration=configuration)
    source = Source(dut.rows, [row for row, _ in wanted], pause[0])
    sink = Sink(dut.extents, len(wanted), pause[1])
    simulate(dut, Drive(lambda ctx, clock: ctx.set(dut.width, interlace.width)), source, sink,
             after=6)
    assert len(wanted) > 50
    for got, (_, extent) in zip(sink.items, wanted, strict=True):
        assert {name: got[name] for name in extent} == extent
    return dut, source, sink


@pytest.mark.parametrize(("words", "shifts"), [(0, (0, 0)), (128, (0, 1)), (64, (1, 1))])
@pytest.mark.parametrize("seed", range(2))
def test_every_row_of_every_edge(seed, words, shifts):
    run(seed, words, shifts, (pauses(f"in {seed}"), pauses(f"out {seed}")))


def test_latency_and_throughput():
    dut, source, sink = run("speed", 0, (0, 0), (no_pause, no_pause))
    assert dut.latency == 4
    assert source.taken == list(range(len(source.taken)))
    assert sink.clocks == [clock + dut.latency for clock in source.taken]


@pytest.mark.parametrize("width", [5, 9, 15])
@pytest.mark.parametrize("more", [0, 3])
def test_no_extent_leaves_the_screen_whatever_the_words(width, more):
    """With as many bits as a column on the screen has, none of them signed, and with more."""
    bits = width.bit_length() + more
    configuration = small_machine("PM", width, 4, edge_column_bits=bits, edge_fraction_bits=3)
    assert configuration.edges_on_screen == (more == 0)
    columns = list(range(1 << bits))
    dut = EdgeColumns(configuration=configuration)
    source = Source(dut.rows, [{"long_edge_left": 1, "long": {"start": column << 3 | 5},
                                "short": {"start": other << 3}}
                               for column, other in zip(columns, columns[::-1], strict=True)])
    sink = Sink(dut.extents, len(columns))
    simulate(dut, Drive(lambda ctx, clock: ctx.set(dut.width, width)), source, sink)

    def held(column):
        return 0 if more and column >> bits - 1 else min(column, width)

    assert [(extent.first, extent.beyond) for extent in sink.items] == [
        (held(column), held(other)) for column, other in zip(columns, columns[::-1], strict=True)]
