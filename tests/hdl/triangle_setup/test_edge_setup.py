"""Start and step of single edges against ``golden.reference.triangle_setup``."""

import random

import numpy as np
import pytest
from hdl_bench.bench import Drive, simulate
from hdl_bench.pictures import random_triangles, small_machine
from hdl_bench.pipelines import Results, Starts

from cardcage.golden.reference.triangle_setup import carry_edges, outline
from cardcage.golden.specification.configuration import MAXIMUM_SETUP_INTERVAL
from cardcage.golden.specification.sampling_grid import Grid
from cardcage.hdl.triangle_setup.edge_setup import EdgeSetup


def edges_of(configuration, seed, count):
    """(inputs, start, step) of edges with rows, in random order."""
    interlace = configuration.interlace
    listed = random_triangles(seed, count, width=configuration.width, height=configuration.height,
                              sub_bits=configuration.sub_bits, extreme=True)
    grid = Grid.of(listed, interlace.x_shift, interlace.y_shift)
    outlines = outline(listed, grid)
    boxes = outlines.boxes
    order = np.argsort(boxes.position[:, :, 1], axis=1, kind="stable")
    by_height = np.take_along_axis(boxes.position, order[:, :, None], axis=1).tolist()
    edges = []
    for edge, ends, first, beyond in (
        (outlines.long, (0, 2), boxes.top, boxes.bottom),
        (outlines.upper, (0, 1), boxes.top, outlines.middle),
        (outlines.lower, (1, 2), outlines.middle, boxes.bottom),
    ):
        carried = carry_edges(edge, column_bits=configuration.edge_column_bits,
                              fraction_bits=configuration.edge_fraction_bits)
        for triangle in np.flatnonzero(beyond > first).tolist():
            (x, y), (end_x, end_y) = (by_height[triangle][end] for end in ends)
            sample = int(first[triangle]) * grid.unit_y + grid.unit_y // 2
            edges.append(({"x": x - grid.unit_x // 2, "run": end_x - x, "height": end_y - y,
                           "distance": sample - y},
                          int(carried.start[triangle]), int(carried.step[triangle])))
    random.Random(f"order {seed}").shuffle(edges)
    return edges


def run(configuration, edges, seed, gap=lambda: 0):
    """All ``edges`` through the unit, ``gap()`` clocks later than it could take each."""
    dut = EdgeSetup(configuration=configuration)
    grid = {name: getattr(configuration.interlace, name)
            for name in ("width", "height", "x_shift", "y_shift")}
    starts = Starts(dut, dut.begin, ("x", "run", "height", "distance"),
                    [inputs for inputs, _, _ in edges], lambda: dut.interval + gap(), seed)
    start, step = (Results(done, result, len(edges)) for done, result in (
        (dut.start_done, dut.start_result), (dut.step_done, dut.step_result)))
    simulate(dut, Drive(lambda ctx, clock: ctx.set(dut.grid, grid)), starts, start, step,
             after=dut.latency + 3, limit=60_000)
    assert start.values == [value for _, value, _ in edges]
    assert step.values == [value for _, _, value in edges]
    # In time, whatever the pauses between them.
    assert start.clocks == [clock + dut.latency for clock in starts.clocks]
    assert all(begun < stepped <= started for begun, stepped, started in
               zip(starts.clocks, step.clocks, start.clocks, strict=True))
    return dut, starts


MACHINES = {
    "a stage a bit": {},
    "two clocks a step": {"setup_interval": 2},
    "a few stages": {"setup_interval": 7},
    "one divider": {"setup_interval": MAXIMUM_SETUP_INTERVAL},
    "few bits": {"sub_bits": 1},
    "many bits": {"sub_bits": 8},
    "not square": {"width": 3, "height": 21},
    "y halved": {"words": 128},
    "both halved": {"words": 64},
}


@pytest.mark.parametrize("kind", MACHINES)
def test_equal_to_golden_at_random_times(kind):
    configuration = small_machine("PM", **{"width": 16, "height": 16} | MACHINES[kind])
    edges = edges_of(configuration, kind, 40 if configuration.setup_interval < 7 else 12)
    assert len(edges) > 15
    pick = random.Random(f"gaps {kind}")
    run(configuration, edges, kind, lambda: pick.choice((0, 0, 1, 3, pick.randrange(40))))


@pytest.mark.parametrize(("interval", "actual"), [(1, 1), (2, 2), (9, 8), (256, 30)])
def test_latency_and_throughput(interval, actual):
    """An edge a division, one after the other; its results ``latency`` clocks later."""
    configuration = small_machine("PM", 16, 16, setup_interval=interval)
    edges = edges_of(configuration, "speed", 12)
    dut, starts = run(configuration, edges, "speed")
    assert dut.interval == actual
    assert starts.clocks == [place * dut.interval for place in range(len(edges))]
