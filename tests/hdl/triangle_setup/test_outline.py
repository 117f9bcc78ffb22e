"""Outlines of triangles against the boxes, areas and turns of
``golden.reference.triangle_setup``."""

import random
from dataclasses import replace

import numpy as np
import pytest
from hdl_bench.bench import Drive, Watch, simulate
from hdl_bench.pictures import random_triangles, small_machine
from hdl_bench.streams import Sink, Source, no_pause, pauses

from cardcage.golden.reference import triangle_words
from cardcage.golden.reference.triangle_setup import outline
from cardcage.golden.specification import commands
from cardcage.golden.specification.sampling_grid import Grid
from cardcage.hdl.triangle_setup.outline import TriangleOutline
from cardcage.hdl.triangle_setup.vertex_sort import interpolants


def expected_outlines(configuration, listed):
    """What is left of the list, as nested dicts, in order."""
    interlace = configuration.interlace
    outlines = outline(listed, Grid.of(listed, interlace.x_shift, interlace.y_shift))
    boxes = outlines.boxes
    found = []
    for place, primitive in enumerate(boxes.primitive.tolist()):
        corners = [{"x": int(x), "y": int(y), "depth": int(depth),
                    **dict(zip(commands.CHANNELS, map(int, color), strict=True))}
                   for (x, y), depth, color in zip(
                       listed.position[primitive], listed.depth[primitive],
                       listed.color[primitive], strict=True)]
        upper, middle, lower = sorted(corners, key=lambda corner: corner["y"])
        clockwise = bool(outlines.long_edge_left[place])
        around = (middle, lower) if clockwise else (lower, middle)
        flat = sum(corners[0][name] << 8 * number for number, name in enumerate(commands.CHANNELS))
        found.append({
            "box": {name: int(getattr(boxes, name)[place])
                    for name in ("top", "bottom", "left", "right")}
            | {"middle": int(outlines.middle[place])},
            "clockwise": int(clockwise),
            "double_area": int(boxes.double_area[place]),
            "x": upper["x"], "y": upper["y"],
            "middle_x": middle["x"] - upper["x"], "middle_y": middle["y"] - upper["y"],
            "lower_x": lower["x"] - upper["x"], "lower_y": lower["y"] - upper["y"],
            "values": {name: {"upper": upper[name], "first": around[0][name] - upper[name],
                              "second": around[1][name] - upper[name]}
                       for name in interpolants(configuration)},
            "color": flat if configuration.shading == "flat" else 0,
        })
    return boxes.primitive.tolist(), found


def as_dict(constant):
    """A structure's value as nested dicts."""
    return {name: as_dict(constant[name]) if hasattr(constant[name], "shape") else constant[name]
            for name in constant.shape().members}


def run(configuration, listed, pause=(no_pause, no_pause)):
    """The whole list through the unit; all that comes out is compared.

    The unit, the source, the sink, and the primitives that are left.
    """
    primitives, expected = expected_outlines(configuration, listed)
    dut = TriangleOutline(configuration=configuration)
    words = [word >> commands.BODY_OFFSET
             for word in triangle_words.triangles(configuration, listed)]
    source = Source(dut.triangles, words, pause[0])
    sink = Sink(dut.outlines, len(expected), pause[1])
    grid = {name: getattr(configuration.interlace, name)
            for name in ("width", "height", "x_shift", "y_shift")}
    held = []
    simulate(dut, Drive(lambda ctx, clock: ctx.set(dut.grid, grid)), source, sink,
             Watch(lambda ctx, clock: held.append(ctx.get(dut.busy))), after=dut.latency + 3)
    assert [as_dict(item) for item in sink.items] == expected
    leaves = dict(zip(primitives, sink.clocks, strict=True))
    surely, perhaps = (
        {clock for primitive, taken in enumerate(source.taken)
         for clock in range(taken, leaves.get(primitive, taken + dropped))}
        for dropped in (0, dut.latency))
    busy = {clock - 1 for clock, is_busy in enumerate(held) if is_busy}
    assert surely <= busy <= perhaps
    return dut, source, sink, primitives


MACHINES = {
    "flat": {},
    "gouraud": {"shading": "gouraud"},
    "few bits": {"sub_bits": 1, "depth_bits": 2},
    "many bits": {"sub_bits": 8, "depth_bits": 32, "shading": "gouraud"},
    "not square": {"width": 3, "height": 21},
    "y halved": {"words": 128},
    "both halved": {"words": 64, "shading": "gouraud"},
    "one pixel": {"words": 1},
}


def machine(kind):
    return small_machine("PM", **{"width": 16, "height": 16} | MACHINES[kind])


def scene(configuration, seed, count):
    """Triangles of every kind; of every fifth two vertices are level, in a column, or the same.
    The first two have the least area there is, either way around, at a pixel centre."""
    listed = random_triangles(seed, count, width=configuration.width, height=configuration.height,
                              sub_bits=configuration.sub_bits,
                              depth_bits=configuration.depth_bits, extreme=True)
    position = listed.position.copy()
    pick = random.Random(f"degenerate {seed}")
    for triangle in range(0, count, 5):
        corner, other = pick.sample(range(3), 2)
        axes = pick.choice(([0], [1], [0, 1]))
        position[triangle, corner, axes] = position[triangle, other, axes]
    interlace = configuration.interlace
    x, y = (1 << configuration.sub_bits + shift - 1
            for shift in (interlace.x_shift, interlace.y_shift))
    position[0] = [[x, y], [x + 1, y], [x, y + 1]]
    position[1] = position[0, ::-1]
    return replace(listed, position=position)


@pytest.mark.parametrize("kind", MACHINES)
def test_equal_to_golden_under_random_stalls(kind):
    configuration = machine(kind)
    seed = f"outline {kind}"
    count = 80
    _, _, _, left = run(configuration, scene(configuration, seed, count),
                        (pauses(f"in {seed}"), pauses(f"out {seed}")))
    assert 0 < len(left) < count, "some are kept and some dropped"


def test_latency_and_throughput():
    """A triangle a clock, kept or dropped, each ``latency`` clocks later."""
    configuration = machine("gouraud")
    count = 60
    dut, source, sink, left = run(configuration, scene(configuration, "speed", count))
    assert source.taken == list(range(count))
    assert sink.clocks == [primitive + dut.latency for primitive in left]
    assert len(left) < count


def test_no_more_is_taken_than_the_queue_holds():
    """Behind a sink that waits: as many as it has places, and those that are dropped besides."""
    configuration = machine("flat")
    listed = random_triangles("full", 300, width=16, height=16)
    [kept, _] = expected_outlines(configuration, listed)
    hidden = np.setdiff1d(np.arange(300), kept)[:3]
    order = np.concatenate([kept[:10], hidden, kept[10:40]])
    listed = replace(listed, position=listed.position[order], depth=listed.depth[order],
                     color=listed.color[order])
    wait = 100
    waits = iter([wait] + [0] * len(order))
    dut, source, _, _ = run(configuration, listed, (no_pause, lambda: next(waits)))
    taken = sum(clock < wait for clock in source.taken)
    assert len(hidden) == 3 and taken == dut.queue_depth + len(hidden)
