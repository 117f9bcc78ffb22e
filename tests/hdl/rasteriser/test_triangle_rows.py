"""Rows of outlines on lattices, against the rows in which the interlace has pixels."""

import random

import pytest
from amaranth.hdl import Cat
from hdl_bench.bench import Drive, Watch, simulate
from hdl_bench.domains import (
    IN_LINES,
    IN_SQUARES,
    MACHINES,
    SETTLED,
    Lattice,
    blocks,
    domain,
    masked,
)
from hdl_bench.pictures import small_machine
from hdl_bench.streams import Sink, Source, no_pause, once, pauses

from cardcage.golden.specification import commands
from cardcage.hdl.rasteriser.triangle_rows import TriangleRows


def outlines(configuration, parts, seed, count):
    """Outlines of random bits in the picture's rows, as the queue before lets them through."""
    pick = random.Random(f"outlines {seed}")
    height = configuration.interlace.height
    layout = commands.prepared_triangle_layout(configuration)
    del layout["planes"]
    found = []
    while len(found) < count:
        outline = commands.unpack(layout, pick.getrandbits(commands.layout_bits(layout)))
        outline |= {row: pick.randrange(height + 1) for row in ("top", "middle", "bottom")}
        first, second = (pick.randrange(height) for _ in range(2))
        one = pick.randrange(2)
        if len(parts) == 1:  # of several blocks nothing is known early: that was anything
            first, second, *_ = parts[0].rows(outline["top"])
            one = second >= outline["bottom"]
        if len(parts) != 1 or first < outline["bottom"]:
            found.append(outline | {"first_row": first, "second_row": second, "one_row": one})
    return found


def rows_of(outline, parts):
    """Block by block, all that a row says; the last one says no more than that there is none."""
    for number, part in enumerate(parts):
        rows = part.rows(outline["top"], outline["bottom"])
        final = number == len(parts) - 1
        for y in rows:
            upper = y < outline["middle"]
            yield {
                "y": y, "rows": y - outline["top"],
                "short_rows": y - outline["top" if upper else "middle"],
                "long_edge_left": outline["long_edge_left"], "long": outline["long"],
                "short": outline["upper" if upper else "lower"], "left": outline["left"],
                "lattice": part.fields, "none": 0, "last": final and y == rows[-1],
            }
        if final and not rows:
            yield {"none": 1, "last": 1}
    if not parts:
        yield {"none": 1, "last": 1}


def said(row, expected):
    """What ``row`` says of the fields of ``expected``, in its words."""
    found = {}
    for name, value in expected.items():
        if name == "lattice":
            found[name] = masked(row.lattice)
        elif isinstance(value, dict):
            found[name] = {part: row[name][part] for part in value}
        else:
            found[name] = row[name]
    return found


def run(configuration, first, end, seed, pause, count=30):
    """``count`` triangles; returns the unit, its blocks, the outlines, and both ends."""
    parts = [Lattice(configuration, *block) for block in blocks(first, end)]
    triangles = outlines(configuration, parts, seed, count)
    expected = [row for outline in triangles for row in rows_of(outline, parts)]
    dut = TriangleRows(configuration=configuration)
    source = Source(dut.triangles, triangles, once(SETTLED, pause[0]))
    sink = Sink(dut.rows, len(expected), pause[1])
    preparing = 0

    def lines(ctx, clock):
        ctx.set(dut.total, configuration.units)
        ctx.set(dut.first, first)
        ctx.set(dut.end, end)

    def watch(ctx, clock):
        nonlocal preparing
        held = len(source.taken) > sum(item.last for item in sink.items)
        # Where there may be several blocks it takes a clock to know that there is one.
        whole = len(parts) == 1 and (clock > 0 or configuration.aligned_domains)
        prepares = ctx.get(dut.preparing)
        preparing += prepares
        if parts:
            assert ctx.get(Cat(dut.whole, dut.busy, dut.preparing)) == (
                whole | held << 1 | prepares << 2), f"clock {clock}"
        if len(parts) == 1 and clock:
            assert masked(ctx.get(dut.lattice)) == parts[0].fields

    simulate(dut, Drive(lines), Watch(watch), source, sink, after=5)
    for item, row in zip(sink.items, expected, strict=True):
        assert said(item, row) == row
    # A triangle looks for the first row of each of several blocks, and goes back to the first one.
    assert preparing == (3 * len(parts) * count if len(parts) > 1 else 0)
    return dut, parts, triangles, source, sink


@pytest.mark.parametrize(("name", "skew"), [*((name, skew) for name in MACHINES
                                             for skew in (False, True)),
                                            *((name, False) for name in [*IN_SQUARES, *IN_LINES])])
def test_rows_are_those_the_domain_has_pixels_in(name, skew):
    configuration, first, end = domain(name, skew=skew)
    run(configuration, first, end, f"{name} {skew}", (pauses(f"in {name}"), pauses(f"out {name}")))


@pytest.mark.parametrize(("cards", "unit"), [("PPM", 0), ("PPMMMM", 0), ("PMMMMP", 4)])
@pytest.mark.parametrize("seed", [None, 0])
def test_without_units_a_triangle_has_one_row_that_is_none(cards, unit, seed):
    pause = (no_pause,) * 2 if seed is None else (pauses("in"), pauses("out"))
    _, _, triangles, source, sink = run(small_machine(cards), unit, unit, f"{cards} {seed}", pause)
    assert len(sink.items) == len(triangles)
    if seed is None:
        assert source.taken == list(range(SETTLED, SETTLED + len(triangles)))


@pytest.mark.parametrize("name", [*MACHINES, *IN_SQUARES, *IN_LINES])
def test_latency_and_throughput(name):
    """A row a clock and the next triangle at once; where there are several blocks three clocks
    more for each, and a clock for one without rows."""
    configuration, first, end = domain(name)
    dut, parts, triangles, source, sink = run(configuration, first, end, f"{name} speed",
                                              (no_pause, no_pause))
    assert dut.latency == 2
    several = len(parts) > 1
    taken, clocks, clock = [], [], SETTLED
    for outline in triangles:
        taken.append(clock)
        clock += 2 * several  # until its first row is known
        for number, part in enumerate(parts):
            rows = len(part.rows(outline["top"], outline["bottom"]))
            clocks += range(clock + dut.latency, clock + dut.latency + rows)
            if not rows and number == len(parts) - 1:
                clocks.append(clock + dut.latency)
            clock += max(1, rows) + 3 * several
        clock -= several  # back to the first block, which is one known before
    assert source.taken == taken
    assert sink.clocks == clocks
