"""A processing element card with software memory units to its right."""

import random

import pytest
from hdl_bench.element_card import (
    FRAME_START,
    READ_COUNTERS,
    READ_DEPTH,
    SURVEY,
    Bench,
    draw,
)
from hdl_bench.pictures import (
    exact_words,
    prepare,
    prepared_values,
    random_triangles,
    small_machine,
)
from hdl_bench.streams import pauses

from cardcage.golden.cycles.element_latencies import PIPELINE
from cardcage.golden.reference.triangle_setup import scene_fraction_bits
from cardcage.golden.specification.commands import ResponseKind
from cardcage.golden.specification.queues import SPANS_WAITING
from cardcage.hdl.backplane.connectors import BroadcastLines
from cardcage.hdl.processing_element.broadcast_queue import BroadcastQueue

MACHINES = {
    "all of two, flat": ("PMM", (0, 2), "flat", {}),
    "all of four, gouraud": ("PMMMM", (0, 4), "gouraud", {}),
    "second half of four": ("PMMPMM", (2, 4), "flat", {}),
    "three of four": ("PMPMMM", (1, 4), "flat", {}),
    "three of eight, coarser": ("PMMPMMMPMMM", (2, 5), "flat", {"words": 4}),
}


@pytest.mark.parametrize("machine", MACHINES)
@pytest.mark.parametrize("seed", [1])
def test_boot_two_frames_and_their_reports(machine, seed):
    cards, (first, end), shading, changes = MACHINES[machine]
    lists = [random_triangles(f"{machine} {seed} {frame}", 14, width=8, height=8,
                              flat=shading == "flat") for frame in range(2)]
    fraction_bits = max(
        scene_fraction_bits(scene, x_shift=x_shift, y_shift=y_shift)
        for scene in lists for x_shift, y_shift in ((0, 0), (0, 1), (1, 1)))
    configuration = small_machine(cards, shading=shading, fraction_bits=fraction_bits, **changes)
    interlace = configuration.interlace
    packets = [SURVEY, None]
    expected = [(ResponseKind.DOMAIN, first << 16 | end - first)]
    words = range(interlace.words)
    for scene in lists:
        packets += [FRAME_START]
        packets += [draw(values) for values in
                    prepared_values(configuration, prepare(configuration, scene))]
        packets += [None, READ_DEPTH, None, READ_COUNTERS, None]
        drawn, fragments = exact_words(scene, interlace, flat=shading == "flat")
        own = [pixel for pixel in fragments if first <= interlace.unit(*pixel) < end]
        background = (1 << configuration.depth_bits) - 1
        expected += [(ResponseKind.DEPTH, drawn.get(interlace.pixel(unit, address),
                                                    (background, 0))[0])
                     for unit in range(first, end) for address in words]
        expected += [(ResponseKind.FRAGMENTS, len(own)), (ResponseKind.BUSY, None)]
    bench = Bench(configuration, first, end, packets, responses=len(expected), seed=seed,
                  scan=0.3 * seed, pause=pauses(seed) if seed else lambda: 0)
    for (kind, value), (wanted, number) in zip(bench.responses, expected, strict=True):
        assert kind == wanted
        assert number is None or value == number, kind
    busy = [value for kind, value in bench.responses if kind == ResponseKind.BUSY]
    # A fragment takes a clock or more.
    counts = [value for kind, value in bench.responses if kind == ResponseKind.FRAGMENTS]
    assert all(cycles >= count for cycles, count in zip(busy, counts, strict=True))
    assert all(count > 5 for count in counts)
    back = {place: color for place, color in bench.memory.back.items() if place[1] in words}
    assert back == {(unit, address): drawn.get(interlace.pixel(unit, address), (0, None))[1]
                    for unit in range(first, end) for address in words}


@pytest.mark.parametrize("seed", range(4))
def test_operations_wait_for_those_before(seed):
    """But for a frame start nothing announced waits for done: each word read is as the operations
    before left it."""
    pick = random.Random(f"order {seed}")
    configuration = small_machine("PMM", 4, 4)
    interlace = configuration.interlace
    packets, expected = [SURVEY], [(ResponseKind.DOMAIN, 2)]
    background = (1 << configuration.depth_bits) - 1
    depth, fragments = None, 0
    for _ in range(25):
        kind = pick.choice(("start", "draw", "draw", "read", "count")) if depth else "start"
        if kind == "start":
            fragments = 0
            depth = {(x, y): background for y in range(4) for x in range(4)}
            packets += [None, FRAME_START]
        elif kind == "draw":
            left, top = pick.randrange(4), pick.randrange(4)
            right, bottom = pick.randrange(left + 1, 5), pick.randrange(top + 1, 5)
            values = rectangle(configuration, left, top, right, bottom)
            value = pick.randrange(background)
            values["planes"]["depth"]["start"] = value << configuration.fraction_bits
            packets.append(draw(values))
            for y in range(top, bottom):
                for x in range(left, right):
                    fragments += 1
                    depth[x, y] = min(depth[x, y], value)
        elif kind == "read":
            packets.append(READ_DEPTH)
            expected += [(ResponseKind.DEPTH, depth[interlace.pixel(unit, address)])
                         for unit in range(2) for address in range(interlace.words)]
        else:
            packets.append(READ_COUNTERS)
            expected += [(ResponseKind.FRAGMENTS, fragments), (ResponseKind.BUSY, None)]
    bench = Bench(configuration, 0, 2, packets, responses=len(expected), seed=seed,
                  scan=0.25 * seed)
    for (kind, value), (wanted, number) in zip(bench.responses, expected, strict=True):
        assert kind == wanted
        assert number is None or value == number


@pytest.mark.parametrize("ports", [1, 2])
def test_busy_are_the_clocks_from_leaving_the_queue_to_the_last_write(ports):
    """Of each frame for itself; a triangle of one pixel is in one place of the pipeline at a
    time."""
    configuration = small_machine("PM", memory_ports=ports)
    packets = [SURVEY, None]
    for size in (1, 3, 1):
        packets += [FRAME_START, draw(rectangle(configuration, 2, 3, 2 + size, 3 + size)), None,
                    READ_COUNTERS, None]
    bench = Bench(configuration, 0, 1, packets, responses=1 + 2 * 3)
    for frame, strobe in enumerate(bench.announcer.strobes[2::3]):
        ended = bench.announcer.dones[1 + 2 * frame]
        written = max(write[0] for write in bench.memory.writes if write[0] < ended)
        assert bench.responses[2 + 2 * frame] == (
            ResponseKind.BUSY, written + 1 - (strobe + BroadcastQueue.latency))


def test_an_empty_domain_reports_none_and_is_done():
    configuration = small_machine("PPM")
    scene = random_triangles(3, 10, width=8, height=8, flat=True)
    packets = [SURVEY, None, FRAME_START,
               *(draw(values) for values in
                 prepared_values(configuration, prepare(configuration, scene))),
               None, READ_DEPTH, None, READ_COUNTERS, None]
    bench = Bench(configuration, 0, 0, packets, responses=3)
    assert bench.responses[:2] == [(ResponseKind.DOMAIN, 0), (ResponseKind.FRAGMENTS, 0)]
    assert len(bench.responses) == 3


def test_own_responses_first_then_those_from_the_right():
    configuration = small_machine("PMPM", 4, 4)
    right = [{"kind": 7, "value": value} for value in range(12)]
    bench = Bench(configuration, 0, 1, [SURVEY, None], responses=1, right=right,
                  pause=pauses("right"))
    passed = [(ResponseKind.DEPTH, value) for value in range(12)]
    kinds = [kind for kind, _ in bench.responses]
    # Words that came before it had anything to say may have passed; then its own, then the rest.
    assert [answer for answer in bench.responses if answer[0] == ResponseKind.DEPTH] == passed
    assert bench.responses[kinds.index(ResponseKind.DOMAIN)] == (ResponseKind.DOMAIN, 1)


def rectangle(configuration, left, top, right, bottom):
    """A prepared triangle that covers every pixel of a rectangle: vertical edges."""
    def edge(column):
        # Half a slot of the denominator 1: well inside the column.
        return {"start": (2 * column + 1) << configuration.edge_fraction_bits - 1, "step": 0}

    return {"top": top, "middle": bottom, "bottom": bottom, "left": left, "right": right,
            "long_edge_left": 1, "long": edge(left), "upper": edge(right), "lower": edge(right),
            "planes": {"depth": {"start": 0, "step_x": 0, "step_y": 0},
                       "red": 1, "green": 2, "blue": 3}}


@pytest.mark.parametrize(("cards", "ports", "first", "end", "latency"), [
    ("PM", 1, 0, 1, 20), ("PMPM", 1, 0, 1, 20), ("PMPMMM", 1, 0, 1, 20),
    ("PMPMMMMMMM", 1, 0, 1, 20), ("PM", 2, 0, 1, 18), ("PMPMMM", 2, 0, 1, 18)])
def test_latency(cards, ports, first, end, latency):
    """From a triangle's strobe to the read of its first fragment."""
    configuration = small_machine(cards, memory_ports=ports)
    packets = [SURVEY, None, draw(rectangle(configuration, 0, 0, 8, 8)), None]
    bench = Bench(configuration, first, end, packets, responses=1)
    # The survey reads each unit twice, and once more where one is silent.
    surveyed = 2 * (end - first) + (end < configuration.units)
    reads = bench.memory.reads[surveyed:]
    assert reads[0][0] - bench.announcer.strobes[1] == bench.dut.latency == latency


def test_throughput_is_a_fragment_a_clock_in_long_rows():
    """Hidden fragments need one access each; rows and triangles hide behind one another."""
    configuration = small_machine("PM", 16, 8)
    hidden = rectangle(configuration, 0, 0, 16, 8)
    hidden["planes"]["depth"]["start"] = 255 << configuration.fraction_bits
    near = rectangle(configuration, 0, 0, 16, 8)
    packets = [SURVEY, None, FRAME_START, None, draw(near), None, *[draw(hidden)] * 4, None]
    bench = Bench(configuration, 0, 1, packets, responses=1)
    reads = [read[0] for read in bench.memory.reads[2 + 128:]]
    assert len(reads) == 4 * 128
    assert reads == list(range(reads[0], reads[0] + 4 * 128))


@pytest.mark.parametrize("empty", [5, 12, 13, 40])
def test_rows_without_pixels_hide_behind_the_spans_that_wait(empty):
    """A long row lets spans of a pixel each wait; so many rows without one behind them cost no
    clock, and each further one does."""
    configuration = small_machine("PM", 64, 64, memory_ports=2)
    behind = rectangle(configuration, 0, 0, 1, empty + 1)
    behind |= {"middle": empty, "upper": behind["long"]}  # down to there it has no width
    triangles = [rectangle(configuration, 0, 0, 64, 1), rectangle(configuration, 0, 0, 1, 40),
                 behind]
    bench = Bench(configuration, 0, 1, [SURVEY, None, FRAME_START, *map(draw, triangles), None],
                  responses=1)
    reads = [read[0] for read in bench.memory.reads if read[0] > bench.announcer.strobes[2]]
    assert len(reads) == 64 + 40 + 1
    assert reads[:-1] == list(range(reads[0], reads[0] + 64 + 40))
    hidden = SPANS_WAITING - PIPELINE.lead
    assert hidden == 11
    assert reads[-1] - reads[-2] == max(1, empty - hidden)


def test_the_fifo_holds_what_it_says():
    """While a long triangle is drawn, ``fifo_depth`` packets and no more are taken."""
    for depth in (2, 5):
        configuration = small_machine("PM", 16, 8, fifo_depth=depth)
        packets = [SURVEY, None, FRAME_START, None,
                   *[draw(rectangle(configuration, 0, 0, 16, 8))] * (depth + 3), None]
        bench = Bench(configuration, 0, 1, packets, responses=1)
        strobes = bench.announcer.strobes[2:]
        # The triangle being drawn is still in the FIFO, at its output.
        early = [clock for clock in strobes if clock < strobes[0] + 100]
        assert len(early) == depth


def test_the_controller_looks_at_done_once_a_word_is_through_the_queue():
    """The clocks that the backplane states are those that the queue takes; see ``Announcer``."""
    assert BroadcastLines.settle_clocks == max(BroadcastQueue.latency,
                                               BroadcastQueue.operation_latency)


@pytest.mark.parametrize("seed", range(3))
def test_done_is_low_until_everything_is_written_and_sent(seed):
    pick = random.Random(f"done {seed}")
    configuration = small_machine("PMM")
    packets = [SURVEY, None, FRAME_START, None]
    for _ in range(6):
        corner = pick.randrange(7), pick.randrange(7)
        packets += [draw(rectangle(configuration, *corner, corner[0] + 1, corner[1] + 1)), None]
    bench = Bench(configuration, 0, 2, packets, responses=1, seed=seed, scan=0.6)
    for strobe, done in zip(bench.announcer.strobes, bench.announcer.dones, strict=True):
        later = [write[0] for write in bench.memory.writes if strobe < write[0]]
        following = [clock for clock in bench.announcer.strobes if clock > strobe]
        for write in later:
            if not following or write < following[0]:
                assert write < done
    assert bench.sink.clocks[0] < bench.announcer.dones[0]


@pytest.mark.parametrize(("cards", "end", "skew", "width", "clocks"), [
    ("PM", 1, False, 16, 2),  # one port: a read and a write each
    ("PMM", 2, False, 16, 1),  # the units alternate from row to row; a row can wait
    ("PMM", 2, True, 64, 1),  # along each row
    ("PMMMM", 4, False, 64, 1),  # two units in turn along a row
    ("PMMMMMMMM", 8, False, 64, 1),
])
def test_throughput_of_visible_fragments(cards, end, skew, width, clocks):
    """Every fragment visible, as in the worst case for writes: clocks for each."""
    configuration = small_machine(cards, width, 8, skew=skew)
    packets = [SURVEY, None, FRAME_START, None,
               draw(rectangle(configuration, 0, 0, width, 8)), None]
    bench = Bench(configuration, 0, end, packets, responses=1)
    reads = [read[0] for read in bench.memory.reads if read[0] > bench.announcer.dones[1]]
    assert len(reads) == width * 8
    print(reads[-1] - reads[0] + 1)
    # The first row begins alone, the last one ends alone.
    alone = 16 if width == 16 else 2
    assert clocks * width * 8 - 8 <= reads[-1] - reads[0] + 1 <= clocks * width * 8 + 2 + alone


def test_rows_longer_than_what_waits_take_two_clocks_a_fragment_in_one_unit():
    configuration = small_machine("PMM", 128, 4)
    packets = [SURVEY, None, FRAME_START, None,
               draw(rectangle(configuration, 0, 0, 128, 4)), None]
    bench = Bench(configuration, 0, 2, packets, responses=1)
    reads = [read[0] for read in bench.memory.reads if read[0] > bench.announcer.dones[1]]
    assert 1.7 * 512 < reads[-1] - reads[0] + 1 < 2 * 512
