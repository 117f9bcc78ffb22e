"""Set-up in hardware, every bit of what it gives against
``golden.reference.triangle_setup.prepare``."""

import random
from dataclasses import replace
from math import ceil

import numpy as np
import pytest
from hdl_bench.bench import Drive, Watch, simulate
from hdl_bench.pictures import prepare, prepared_values, random_triangles, small_machine
from hdl_bench.streams import Sink, Source, no_pause, pauses
from suite.cases import chosen
from wide_machines import wide_machine

from cardcage.golden.planning.machine_plan import plan
from cardcage.golden.planning.scene_needs import fitted
from cardcage.golden.reference import triangle_words
from cardcage.golden.specification import commands
from cardcage.golden.specification.configuration import MAXIMUM_SETUP_INTERVAL
from cardcage.golden.specification.display_list import DisplayList
from cardcage.hdl.triangle_setup.triangle_setup import TriangleSetup


def flattened(configuration, triangle):
    """Path → value of each field of a prepared triangle, given as one number."""
    def fields(layout, offset, prefix=""):
        for name, entry in layout.items():
            if isinstance(entry, int):
                yield prefix + name, triangle >> offset & (1 << entry) - 1
                offset += entry
            else:
                yield from fields(entry, offset, f"{prefix}{name}.")
                offset += commands.layout_bits(entry)

    return dict(fields(commands.prepared_triangle_layout(configuration), 0))


def shares(configuration, display_list):
    """A round and a node for each triangle, any that their bits hold."""
    source = np.random.default_rng(len(display_list.position))
    bits = {"round": configuration.order_bits, "node": configuration.node_bits}
    return {name: source.integers(0, 1 << width, len(display_list.position))
            for name, width in bits.items() if width}


def run(configuration, display_list, pause=(no_pause, no_pause), after=4):
    """Every triangle of the list through the unit; all that comes out is compared."""
    layout = commands.prepared_triangle_layout(configuration)
    prepared, share = prepare(configuration, display_list), shares(configuration, display_list)
    expected = []
    for primitive, values in zip(prepared.primitive, prepared_values(configuration, prepared),
                                 strict=True):
        own = {name: int(array[primitive]) for name, array in share.items()}
        values["planes"] |= own
        expected.append(commands.pack(layout, values | own))
    dut = TriangleSetup(configuration=configuration)
    words = [word >> commands.BODY_OFFSET
             for word in triangle_words.triangles(configuration, display_list, share)]
    source = Source(dut.vertices, words, pause[0])
    sink = Sink(dut.triangles, len(expected), pause[1])
    held = []

    def busy(ctx, clock):
        held.append(ctx.get(dut.busy))

    # What is dropped at the end has to be gone, too.
    simulate(dut, Drive(lambda ctx, clock: ctx.set(dut.total, configuration.units)), source, sink,
             Watch(busy), after=after + dut.latency, limit=60_000)
    found = [item.as_bits() for item in sink.items]
    assert len(found) == len(expected)
    for number, pair in enumerate(zip(found, expected, strict=True)):
        if pair[0] != pair[1]:
            assert flattened(configuration, pair[0]) == flattened(configuration, pair[1]), number
    assert not held[-1]
    first, last = source.taken[0], (sink.clocks or source.taken)[-1]
    assert all(held[first + 1:last + 1]), "empty while a triangle was inside"
    return dut, source, sink


KINDS = {
    "flat": {},
    "gouraud": {"shading": "gouraud"},
    "two clocks a step": {"setup_interval": 2, "shading": "gouraud"},
    "a few stages": {"setup_interval": 7},
    "one divider": {"setup_interval": MAXIMUM_SETUP_INTERVAL, "shading": "gouraud"},
    "no fraction": {"fraction_bits": 0, "shading": "gouraud"},
    "few bits": {"sub_bits": 1, "depth_bits": 2, "fraction_bits": 30},
    "many bits": {"sub_bits": 8, "depth_bits": 32, "fraction_bits": 44, "shading": "gouraud"},
    "not square": {"width": 3, "height": 21},
    "y halved": {"words": 128},
    "both halved": {"words": 64, "shading": "gouraud"},
    "units pulled": {"words": 16, "maximum_units": 16, "sub_bits": 5},
    "one pixel": {"words": 1, "setup_interval": 3},
    "nodes": {"cards": "5x(PMC)", "order_bits": 5, "shading": "gouraud"},
    "nodes without an order": {"cards": "2x(PMT)", "order_bits": 0, "setup_interval": 7},
}


def machine(kind):
    return small_machine(**{"cards": "PM", "width": 16, "height": 16} | KINDS[kind])


def scene(configuration, seed, count):
    """Triangles of every size, slivers, some in the guard band's corners, some degenerate."""
    listed = random_triangles(seed, count, width=configuration.width, height=configuration.height,
                              sub_bits=configuration.sub_bits,
                              depth_bits=configuration.depth_bits, extreme=True)
    position = listed.position.copy()
    pick = random.Random(f"degenerate {seed}")
    for triangle in pick.sample(range(count), count // 5):
        corner, other = pick.sample(range(3), 2)
        axes = pick.choice(([0], [1], [0, 1]))  # one above the other, level, or the same
        position[triangle, corner, axes] = position[triangle, other, axes]
    return replace(listed, position=position)


@pytest.mark.parametrize("kind", chosen(
    KINDS, "flat", "two clocks a step", "one divider", "few bits", "both halved", "units pulled",
    "nodes"))
def test_equal_to_golden_under_random_stalls(kind):
    configuration = machine(kind)
    seed = f"setup {kind}"
    count = 40 if configuration.setup_interval == 1 else 16
    display_list = scene(configuration, seed, count)
    _, _, sink = run(configuration, display_list, (pauses(f"in {seed}"), pauses(f"out {seed}")))
    assert 0 < len(sink.items) < count, "some are kept and some dropped"


@pytest.mark.parametrize(("kind", "count", "wait"), [
    ("flat", 60, 250), ("a few stages", 30, 500), ("one divider", 36, 900)])
def test_a_list_that_waits_at_the_output(kind, count, wait):
    """All queues fill up, the input waits, and nothing is lost or out of order.

    As many wait as are on their way where nothing waits, one more, and one at the output.
    """
    configuration = machine(kind)
    waits = iter([wait] + [0] * count)
    dut, source, sink = run(configuration, scene(configuration, f"full {kind}", count),
                            (no_pause, lambda: next(waits)))
    assert source.taken[-1] >= wait, "the input waited"
    at_once = np.argmax(np.diff(sink.clocks) != dut.leaving)
    assert at_once == dut.depth == ceil(dut.preparation / dut.interval) + 1


def corners(count, seed, bits):
    """Vertices at, or a unit from, the ends of the guard band and the middle."""
    limit = 1 << (bits - 1)
    ends = np.array([-limit, -limit + 1, -1, 0, 1, limit - 2, limit - 1])
    return ends[np.random.default_rng(seed).integers(0, len(ends), (count, 3, 2))]


@pytest.mark.parametrize("shading", ["flat", "gouraud"])
def test_the_ends_of_all_ranges_at_512_by_512(shading):
    """The largest numbers that any triangle of the guard band gives, exact for those on the
    screen, and slivers with enormous slopes."""
    configuration = small_machine("PM", 512, 512, sub_bits=8, depth_bits=24, fraction_bits=45,
                                  shading=shading,
                                  setup_interval=1 if shading == "flat" else 28)
    source = np.random.default_rng(7)
    count = 16
    position = corners(count, 7, configuration.coordinate_bits)
    slivers = source.integers(0, 512 * 256, (count, 1, 2)) + source.integers(-300, 300,
                                                                             (count, 3, 2))
    slivers[::2, 2] = slivers[::2, 0] + [[1, 1]]
    # Corner to corner of the guard band and a unit off: the area is small, the sides are not.
    limit = 1 << (configuration.coordinate_bits - 1)
    thin = np.array([[[-limit, -limit], [limit - 1, limit - 1], [limit - 2, limit - 1]],
                     [[-limit, limit - 1], [limit - 1, -limit], [limit - 2, -limit]],
                     [[0, 0], [131071, 131070], [131070, 131070]]])
    position = np.concatenate([position, slivers, thin]).astype(np.int32)
    display_list = DisplayList(
        width=512, height=512, position=position,
        depth=source.choice([0, 1, 2**23, 2**24 - 2], (len(position), 3)),
        color=source.choice([0, 1, 128, 255], (len(position), 3, 3)).astype(np.uint8))
    _, _, sink = run(configuration, display_list)
    assert len(sink.items) > count


def test_planned_for_a_scene():
    """Words narrower than the guard band's, as ``plan`` makes them."""
    listed = random_triangles("planned", 30, width=24, height=16, sub_bits=3, depth_bits=8)
    listed = replace(listed, position=listed.position // 4)
    configuration = plan(listed, cards="PM", setup="hardware").configuration
    full = wide_machine(listed, cards="PM")
    assert configuration.edge_word_bits < full.edge_word_bits
    assert configuration.coordinate_bits < full.coordinate_bits
    run(configuration, fitted(configuration, listed))


@pytest.mark.parametrize(("interval", "slot"), [(1, 1), (2, 2), (9, 9), (256, 34)])
def test_latency_and_throughput(interval, slot):
    """A triangle every three divisions; one at a clock a step."""
    configuration = small_machine("PM", 16, 16, setup_interval=interval)
    display_list = random_triangles("speed", 40 if interval < 9 else 8, width=16, height=16)
    only = prepare(configuration, display_list).primitive
    display_list = replace(display_list, position=display_list.position[only],
                           depth=display_list.depth[only], color=display_list.color[only])
    dut, source, sink = run(configuration, display_list)
    assert sink.clocks[0] == source.taken[0] + dut.latency
    assert (dut.slot_clocks, dut.interval) == (slot, 3 * slot)
    assert sink.clocks == [sink.clocks[0] + place * dut.interval for place in range(len(only))]


def test_dropped_triangles_take_a_clock_and_cost_the_others_none():
    """Nine without pixels between two others: fast set-up takes one of them a clock."""
    configuration = small_machine("PM", 16, 16)
    shown = [[8, 8], [48, 8], [8, 48]]
    hidden = [[[8, 8], [8, 8], [8, 48]], [[3, 3], [3, 4], [4, 3]], [[-60, 8], [-9, 9], [-20, 40]]]
    position = np.array([shown, *hidden * 3] * 20, np.int32)
    count = len(position)
    display_list = DisplayList(
        width=16, height=16, sub_bits=2, depth_bits=8, position=position,
        depth=np.ones((count, 3), np.int64), color=np.zeros((count, 3, 3), np.uint8))
    _, source, sink = run(configuration, display_list)
    assert source.taken == list(range(count))
    assert sink.clocks == [sink.clocks[0] + 10 * place for place in range(20)]
