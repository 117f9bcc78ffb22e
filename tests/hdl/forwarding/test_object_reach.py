"""Boxes of meshes, moved: the regions that the golden model finds, of every object."""

import random

import numpy as np
import pytest
from hdl_bench.bench import Drive, Until, simulate
from hdl_bench.streams import Sink, Source, no_pause, once, pauses
from object_bench.objects import from_far

from cardcage.golden.objects.object_boxes import ObjectBoxes
from cardcage.golden.scenes.quantise import PictureFormat
from cardcage.golden.scenes.scene_files.object_list import ObjectList, ObjectMesh
from cardcage.golden.specification.configuration import MachineConfiguration
from cardcage.hdl.forwarding.object_reach import ObjectReach

MACHINES = {
    "grid": {"cards": "3x(PM)", "width": 40, "height": 24, "regions": (5, 3), "sub_bits": 4},
    "strips": {"cards": "2x(PM)", "width": 33, "height": 17, "regions": (1, 17), "sub_bits": 1},
    "one region": {"cards": "2x(PM)", "width": 7, "height": 9, "regions": (1, 1), "sub_bits": 8},
}


def some_objects(seed, configuration, count):
    """Everywhere in the guard band, many with their edges on pixel centres."""
    numbers = np.random.default_rng(seed)
    picture = PictureFormat(configuration.width, configuration.height,
                            sub_bits=configuration.sub_bits)
    unit, band = 1 << picture.sub_bits, picture.guard_band << picture.sub_bits
    reach = np.array([0, 1, unit, 9 * unit, band // 4])
    meshes = [ObjectMesh(numbers.integers(-size, size + 1, (1, 3, 2)), np.zeros((1, 3), int),
                         np.zeros((1, 3, 3), np.uint8)) for size in reach for _ in range(2)]
    mesh = numbers.integers(0, len(meshes), count)
    size = np.array([picture.width, picture.height]) * unit
    place = np.where(numbers.random((count, 1)) < 0.8,
                     numbers.integers(-4 * unit, size + 4 * unit, (count, 2)),
                     numbers.integers(-band * 3 // 4, band * 3 // 4, (count, 2)))
    place[::2] = place[::2] // unit * unit + numbers.integers(0, 2, place[::2].shape) * unit // 2
    return ObjectList(picture, (0, 0, 0), tuple(meshes), mesh,
                      np.concatenate([place, numbers.integers(0, 99, (count, 1))], axis=1),
                      numbers.integers(0, 256, (count, 3)).astype(np.uint8))


@pytest.mark.parametrize("seed", [None, 1])
@pytest.mark.parametrize("name", MACHINES)
def test_regions_of_objects(name, seed):
    configuration = MachineConfiguration(
        **MACHINES[name], setup="hardware", objects="elements", mesh_triangles=10, meshes=10,
        balance="static", order_bits=9)
    objects = some_objects(name.encode()[0], configuration, 250)
    if seed is not None:  # an origin out of the guard band makes no difference
        objects = from_far(objects, 3 << configuration.coordinate_bits - 2, -7)
    boxes, regions = ObjectBoxes.of(objects), configuration.dealt_regions
    dut = ObjectReach(configuration=configuration)
    loads = [(0, (9, 9, 9, 9)), (0, (1, 1, 1, 1)), (1, None),
             *((0, mesh.box) for mesh in objects.meshes), (0, (5, 5, 5, 5))]
    limit = 1 << configuration.coordinate_bits

    def load(ctx, clock):
        clear, box = loads[clock] if clock < len(loads) else (0, None)
        ctx.set(dut.clear, clear)
        ctx.set(dut.store, box is not None)
        if box is not None:
            ctx.set(dut.box, {end: value % limit for end, value in zip(
                ("left", "top", "right", "bottom"), box, strict=True)})

    items = [{"mesh": mesh, "x": x, "y": y, "depth": depth, "red": red, "green": 1, "blue": 2,
              "round": number, "element": number % 2} for number, (mesh, (x, y, depth), (red, *_))
             in enumerate(zip(objects.mesh.tolist(), objects.offset.tolist(),
                              objects.color.tolist(), strict=True))]
    drawn = np.flatnonzero(~boxes.empty)
    pace = no_pause if seed is None else pauses(seed)
    source = Source(dut.objects, [
        {**item, "x": item["x"] % limit, "y": item["y"] % limit} for item in items],
        once(len(loads) + 1, pace))
    sink = Sink(dut.reaching, len(drawn), no_pause if seed is None else pauses((seed, "out")))
    simulate(dut, Drive(load, len(loads)), source, sink,
             Until(lambda: len(source.taken), len(items)), after=4)
    assert 30 < len(drawn) < 245 and len(sink.items) == len(drawn)
    for number, item in zip(drawn, sink.items, strict=True):
        reach = item.reach
        assert (reach.left, reach.right, reach.top, reach.bottom) == (
            boxes.left[number] >> regions.x_bits, boxes.right[number] >> regions.x_bits,
            boxes.top[number] >> regions.y_bits, boxes.bottom[number] >> regions.y_bits), number
        bits = configuration.coordinate_bits
        place = item.object >> configuration.mesh_bits
        assert place & ((1 << bits) - 1) == objects.offset[number, 0] % (1 << bits)
        assert item.object >> configuration.mesh_bits + 2 * bits + (
            configuration.depth_bits + 24) == number
    if seed is None:
        taken = [source.taken[number] for number in drawn]
        assert [out - begin for out, begin in zip(sink.clocks, taken, strict=True)] == (
            [ObjectReach.latency] * len(drawn))


def test_busy_is_high_as_long_as_it_holds_an_object():
    configuration = MachineConfiguration(
        **MACHINES["grid"], setup="hardware", objects="elements", mesh_triangles=1, meshes=1,
        balance="static", order_bits=3)
    dut = ObjectReach(configuration=configuration)
    pick, held = random.Random(3), 0

    def drive(ctx, clock):
        nonlocal held
        ctx.set(dut.store, clock == 0)
        ctx.set(dut.box, {"left": 0, "top": 0, "right": 100, "bottom": 100})
        ctx.set(dut.objects.valid, clock > 2 and pick.random() < 0.2)
        ctx.set(dut.reaching.ready, pick.random() < 0.5)
        assert ctx.get(dut.busy) == (held > 0)
        held += ctx.get(dut.objects.valid) & ctx.get(dut.objects.ready)
        held -= ctx.get(dut.reaching.valid) & ctx.get(dut.reaching.ready)

    simulate(dut, Drive(drive, 400))
