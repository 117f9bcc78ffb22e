"""Extents on lattices, against the pixels that the interlace has in them."""

import random
from itertools import groupby

import pytest
from hdl_bench.bench import Until, Watch, simulate
from hdl_bench.domains import IN_LINES, IN_SQUARES, MACHINES, Lattice, blocks, domain
from hdl_bench.streams import Sink, Source, no_pause, pauses

from cardcage.hdl.rasteriser.span_clip import SpanClip


def extents(configuration, parts, seed, count):
    """Rows of the blocks with any two columns of the picture; some are none."""
    pick = random.Random(f"extents {seed}")
    width, height = configuration.interlace.width, configuration.interlace.height
    for _ in range(count):
        part = pick.choice(parts)
        rows = part.rows(0, height)
        none = pick.random() < 0.15 or not rows  # that is all there is in a row that is not its own
        extent = {
            "first": pick.randrange(width + 1), "beyond": pick.randrange(width + 1),
            "y": pick.choice(rows) if rows else 0, "rows": pick.randrange(height),
            "left": pick.randrange(width), "none": none, "last": pick.randrange(2),
            "lattice": part.fields}
        yield extent, [] if none else [x for x in range(extent["first"], extent["beyond"])
                                       if part.owns(x, extent["y"])]


def spans(configuration, extent, owned):
    """Runs of the owned pixels, in squares one for each run of neighbours, and their stride."""
    stride = 1 if configuration.interlace.square_bits else extent["lattice"]["x_mask"] + 1
    # Along a run the pixel grows by the stride when its place grows by one.
    runs = [[x for _, x in run] for _, run in groupby(
        enumerate(owned), key=lambda placed: placed[1] - stride * placed[0])]
    found = [(run, stride, 0, extent["last"] and run is runs[-1]) for run in runs]
    return found or ([([], stride, 1, 1)] if extent["last"] else [])


def run(name, seed, pause, count=120, **changes):
    """Every span compared; returns the unit, both ends, and the number of spans of each extent."""
    configuration, first, end = domain(name, **changes)
    parts = [Lattice(configuration, *block) for block in blocks(first, end)]
    sent = list(extents(configuration, parts, f"{name} {seed}", count))
    expected = [[(extent, *span) for span in spans(configuration, extent, owned)]
                for extent, owned in sent]
    everything = [span for several in expected for span in several]
    dut = SpanClip(configuration=configuration)
    source = Source(dut.extents, [extent for extent, _ in sent], pause[0])
    sink = Sink(dut.spans, len(everything), pause[1])
    empty = []

    def watch(ctx, clock):
        if ctx.get(dut.empty):
            empty.append(clock)

    simulate(dut, Watch(watch), source, sink, Until(lambda: len(source.taken), count), after=3)
    for item, (extent, pixels, stride, none, last) in zip(sink.items, everything, strict=True):
        assert (item.none, item.last) == (none, last)
        if not none:
            assert item.stride == stride
            assert list(range(item.x, item.end, item.stride)) == pixels
            assert item.end <= extent["beyond"]
            assert (item.y, item.left, item.y_steps) == (extent["y"], extent["left"],
                                                         extent["rows"])
    # An extent without a pixel is said to be one in the clock in which it is taken.
    assert empty == [clock for clock, (_, owned) in zip(source.taken, sent, strict=True)
                     if not owned]
    return dut, source, sink, [len(several) for several in expected]


@pytest.mark.parametrize(("name", "skew"), [*((name, skew) for name in MACHINES
                                             for skew in (False, True)),
                                            *((name, False) for name in [*IN_SQUARES, *IN_LINES])])
def test_spans_are_the_owned_pixels_of_the_extent(name, skew):
    *_, counts = run(name, skew, (pauses(f"in {name}"), pauses(f"out {name}")), skew=skew)
    assert 0 in counts and 1 in counts
    assert max(counts) > 1 or name not in IN_SQUARES or name in ("all", "one of two, rows only")


@pytest.mark.parametrize("name", [*MACHINES, *IN_SQUARES, *IN_LINES])
def test_latency_and_throughput(name):
    """A span a clock; an extent without one costs a clock."""
    dut, source, sink, counts = run(name, "speed", (no_pause, no_pause))
    assert dut.latency == 1
    clock, taken, clocks = 0, [], []
    for count in counts:
        clocks += range(clock + dut.latency, clock + dut.latency + count)
        clock += max(1, count)
        taken.append(clock - 1)
    assert source.taken == taken
    assert sink.clocks == clocks
