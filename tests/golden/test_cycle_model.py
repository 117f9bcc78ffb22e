"""The cycle model: its arrays against the recurrence, its parts against the picture."""

from __future__ import annotations

import random
from collections import Counter
from dataclasses import fields, replace
from functools import partial

import numpy as np
import pytest

from cardcage.golden.configuration import MachineConfiguration, configure
from cardcage.golden.coverage import Triangles
from cardcage.golden.cycle_model import SetupTiming, predict_cycles
from cardcage.golden.display_list import DisplayList
from cardcage.golden.element_walks import entries_of
from cardcage.golden.exact import draw, fragments
from cardcage.golden.grid import Grid
from cardcage.golden.lanes import (
    FRAGMENTS_WAITING,
    LANE_START,
    ElementLanes,
    depth_lanes,
    scan_shares,
)
from cardcage.golden.lattice_spans import lattice_blocks, lattice_spans
from cardcage.golden.one_port import OnePort
from cardcage.golden.pipeline import Pipeline
from cardcage.golden.port_accesses import PortAccesses
from cardcage.golden.scene_display_list import make_display_list
from cardcage.golden.two_ports import TwoPorts

CARDS = ("PM", "PMM", "2x(PM)", "PMPMMM", "4x(PMM)")


def scene(seed: int, n: int = 40, size: int = 12) -> DisplayList:
    return make_display_list(f"random:n={n},size={size},seed={seed}", width=40,
                             height=28).display_list


def spans_of(configuration: MachineConfiguration, listed: DisplayList, row_limit: int = 64):
    triangles = Triangles.of(listed, Grid.of(listed))
    return triangles, list(lattice_spans(triangles, lattice_blocks(configuration), row_limit))


def owner(configuration: MachineConfiguration, unit: int) -> int:
    """The processing element left of a unit."""
    seen = -1
    for place, card in enumerate(configuration.cards):
        seen += card == "M"
        if seen == unit:
            return configuration.cards[:place].count("P") - 1
    raise AssertionError(unit)


@pytest.mark.parametrize(("cards", "block", "skew"), [
    *((cards, 1, skew) for cards in CARDS for skew in (False, True)), ("PMM", 4, False),
    ("2x(PM)", 2, False), ("4x(PMM)", 4, False), ("8x(PM)", 8, False)])
def test_spans_hold_every_fragment_of_their_element(cards, block, skew):
    listed = scene(1)
    configuration = configure(listed, cards=cards, block=block, skew=skew)
    triangles, parts = spans_of(configuration, listed)
    assert len(parts) > 1 and [part.begin for part in parts[1:]] == [
        part.end for part in parts[:-1]]
    drawn = fragments(listed)
    owners = [owner(configuration, unit) for unit in range(configuration.units)]
    wanted: Counter[tuple[int, int, int]] = Counter()
    squares: dict[tuple[int, int, int], set[int]] = {}
    for primitive, x, y in zip(drawn.primitive.tolist(), drawn.x.tolist(), drawn.y.tolist(),
                               strict=True):
        key = primitive, owners[configuration.interlace.unit(x, y)], y
        wanted[key] += 1
        squares.setdefault(key, set()).add(x // block)
    found: Counter[tuple[int, int, int]] = Counter()
    for part in parts:
        for triangle, element, row, length, crossed, x_bits in zip(
                part.triangle, part.element, part.row, part.length, part.squares, part.x_bits,
                strict=True):
            key = int(triangles.primitive[part.begin + triangle]), int(element), int(row)
            found[key] += int(length)
            assert crossed == (len(squares[key]) if block > 1 and x_bits else 1)
    assert found == wanted


@pytest.mark.parametrize("cards", CARDS)
@pytest.mark.parametrize("skew", [False, True])
def test_rows_are_those_of_the_lattice(cards, skew):
    listed = scene(2)
    configuration = configure(listed, cards=cards, skew=skew)
    triangles, parts = spans_of(configuration, listed)
    for number, block in enumerate(lattice_blocks(configuration)):
        for part in parts:
            for place, triangle in enumerate(range(part.begin, part.end)):
                rows = [row for row in range(triangles.top[triangle], triangles.bottom[triangle])
                        if row % (1 << block.y_bits) == block.y_offset]
                columns = [column for column in range(triangles.left[triangle],
                                                      triangles.right[triangle])
                           if column % (1 << block.x_bits) in map(block.x_offset_of, range(8))]
                assert part.rows[place, number] == len(rows)
                assert part.met[place, number] == bool(rows and columns)
                here = (part.triangle == place) & (part.block == number)
                assert [rows[step] for step in part.step[here]] == part.row[here].tolist()


def test_written_fragments():
    """With one port and one unit a span takes an access for each fragment and for each write."""
    listed = scene(3, n=150)
    configuration = configure(listed, cards="PM", clocks_per_pixel=256)
    triangles, parts = spans_of(configuration, listed)
    ports = PortAccesses(configuration, listed, triangles)
    reads, writes, clocks = sum(ports.of(part).sum(axis=(0, 2)) for part in parts)
    nearest = np.full((28, 40), configuration.depth_background)
    written = 0
    drawn = fragments(listed)
    for x, y, depth in zip(drawn.x, drawn.y, drawn.depth, strict=True):
        visible = depth < nearest[y, x]
        written += visible
        nearest[y, x] = min(nearest[y, x], depth)
    np.testing.assert_array_equal(nearest, draw(listed).depth)
    assert written < len(drawn), "some fragments are hidden"
    assert (reads, writes, clocks) == (len(drawn), written, len(drawn) + written)
    assert ports.bound == pytest.approx(clocks, rel=0.01)


@pytest.mark.parametrize(("cards", "options"), [
    ("PM", {}), ("PMM", {}), ("PMM", {"skew": True}), ("2x(PMM)", {"skew": True}),
    ("4x(PM)", {"skew": True}), ("PMPMMM", {}), ("2x(PMM)", {"block": 4}), ("PMMMM", {})])
def test_share_of_the_scan(cards, options):
    """Against every pixel of the screen: a unit reads as the group of pixels begins."""
    machine = MachineConfiguration(cards, 40, 24, clocks_per_pixel=4, **options)
    interlace = machine.interlace
    group = 1 << interlace.group_bits
    taken = np.zeros((24, machine.processing_elements, 2))
    for y in range(24):
        for x in range(0, 40, group):
            units = {int(interlace.unit(x + step, y)) for step in range(group)}
            lanes = {(owner(machine, unit), unit % depth_lanes(machine)) for unit in units}
            for element, lane in lanes:
                taken[y, element, lane] += 1
    shares = scan_shares(machine)
    line = machine.timing.pixels / 24 * 4
    found = shares[np.arange(24) % len(shares)] * line
    np.testing.assert_allclose(found, taken)
    assert depth_lanes(machine) == (2 if "MM" in cards else 1)


def lanes_by_clock(spans, waiting):
    """Fragments one after the other through two lanes that hold ``waiting``, and where nothing
    waited begin late: clocks of each span, and those after the last one until all is done."""
    queue: list[list[int]] = [[], []]
    busy, clock, begin, clocks = [0, 0], 0, 0, []
    pixels = [[(lane, accesses) for lane, accesses in span] for span in spans]

    def step():
        nonlocal clock
        for lane in range(2):
            if not busy[lane] and queue[lane]:
                busy[lane] = queue[lane].pop(0)
            busy[lane] = max(0, busy[lane] - 1)
        clock += 1

    for span in pixels:
        for lane, accesses in span:
            while len(queue[lane]) >= waiting:
                step()
            if not busy[lane] and not queue[lane]:
                accesses += LANE_START
            queue[lane].append(accesses)
            step()
        clocks.append(clock - begin)
        begin = clock
    while any(queue) or any(busy):
        step()
    return clocks, clock - begin


def through_lanes(machine, reads, writes, found):
    """Clocks of each span, which may come when it is found, and then until all is done."""
    lanes, now = ElementLanes(machine, 0), 0.0
    clocks, left = [], []
    for place, earliest in enumerate(found):
        begin = max(now, earliest)
        now = lanes.take(begin, (reads[place].tolist(), writes[place].tolist(),
                                 (reads + writes)[place].tolist()))
        clocks.append(now - begin)
        left.append(max(lanes.done - now, 0))
    return np.array(clocks), np.array(left)


@pytest.mark.parametrize("seed", range(4))
def test_lanes_follow_one_another(seed):
    """Against queues of fragments, stepped clock by clock, where nothing is scanned."""
    pick = random.Random(f"lanes {seed}")
    spans = []
    for _ in range(400):
        first, length = pick.randrange(2), pick.choice((1, 1, 2, 5, 9, 30, 60))
        visible, turns = pick.choice((0.3, 0.7, 1)), pick.random() < 0.4  # along the row, or not
        spans.append([((first + turns * place) % 2, 1 + (pick.random() < visible))
                      for place in range(length)])
    machine = MachineConfiguration("PMM", 8, 1 << 12, words=1 << 14, clocks_per_pixel=256)
    reads, writes = (np.array([[sum(lane == which and accesses > least for lane, accesses in span)
                                for which in range(2)] for span in spans]) for least in (0, 1))
    clocks, left = through_lanes(machine, reads, writes, np.zeros(len(spans)))
    by_clock, after = lanes_by_clock(spans, FRAGMENTS_WAITING)
    print(f"{clocks.sum():.0f} clocks, stepped {sum(by_clock)}; then {left[-1]:.0f}, {after}")
    assert clocks.sum() == pytest.approx(sum(by_clock), rel=0.02)
    assert left[-1] == pytest.approx(after, abs=4)
    assert sum(by_clock) > 1.05 * reads.sum(), "some wait"
    assert (clocks >= reads.sum(axis=1) - 1e-6).all()


def test_lanes_catch_up_while_nothing_is_found():
    machine = MachineConfiguration("PMM", 8, 8, clocks_per_pixel=256)
    even = np.array([[40, 0]] * 3)
    close, apart = (through_lanes(machine, even, even, found)
                    for found in ((0, 0, 0), (0, 200, 400)))
    # A row of 40 goes on while the last sixteen wait, and begins anew where these are done.
    np.testing.assert_allclose(close[0], [51, 80, 80], rtol=0.02)
    np.testing.assert_allclose(apart[0], [51, 51, 51], rtol=0.02)
    np.testing.assert_allclose(apart[1], [32, 32, 32], rtol=0.02)


def walked_by_hand(configuration: MachineConfiguration, listed: DisplayList, pipeline: Pipeline):
    """For each triangle and element: None where its box misses the element, else the clocks of the
    walk and, clocks after its load, every row's pixels; None in place of pixels at an open end."""
    triangles = Triangles.of(listed, Grid.of(listed))
    drawn = fragments(listed)
    owners = np.array([owner(configuration, unit) for unit in range(configuration.units)])
    covered = Counter(zip(drawn.primitive.tolist(), configuration.interlace.unit(
        drawn.x, drawn.y).tolist(), drawn.y.tolist(), strict=True))
    blocks = lattice_blocks(configuration)
    units = configuration.interlace.unit(*np.meshgrid(np.arange(listed.width),
                                                      np.arange(listed.height)))
    by_block = [  # the units whose pixels have its offset from a multiple of its stride
        {int(unit) for unit in np.unique(units[block.y_offset::1 << block.y_bits << block.shifted,
                                               block.x_offset::1 << block.x_bits])}
        for block in blocks]
    work = []
    for place, primitive in enumerate(triangles.primitive.tolist()):
        box = units[triangles.top[place]:triangles.bottom[place],
                    triangles.left[place]:triangles.right[place]]
        of_triangle = []
        for element in range(configuration.processing_elements):
            mine = [units for block, units in zip(blocks, by_block, strict=True)
                    if block.element == element]
            if len(mine) == 1 and element not in owners[box]:
                of_triangle.append(None)
                continue
            clock = pipeline.first_row if len(mine) > 1 else 0
            rows = []
            for number, block in enumerate(mine):
                if number:
                    clock += pipeline.block
                owned = [y for y in range(triangles.top[place], triangles.bottom[place])
                         if set(units[y].tolist()) & block]
                for y in owned:
                    rows.append((clock, sum(covered[primitive, unit, y] for unit in block)))
                    clock += 1
                clock += not owned
            if not rows or rows[-1][0] < clock - 1 or not rows[-1][1]:
                rows.append((clock - 1, None))
            walk = clock + (pipeline.again if len(mine) > 1 else 0)
            of_triangle.append((walk, [row for row in rows if row[1] != 0]))
        work.append(of_triangle)
    return triangles, work


def written_out(configuration, listed, pipeline, depth, setup):
    """The same recurrence with two ports, span by span, queue by queue."""
    triangles, work = walked_by_hand(configuration, listed, pipeline)
    elements = range(configuration.processing_elements)
    clocks = []  # of each element's spans, once all of them are known
    for element in elements:
        pixels = [row[1] for kept in work if kept[element] for row in kept[element][1]]
        clocks.append([1 if count is None else count for count in pixels])
    never = -10**9
    load, free, number = ([never for _ in elements], [never for _ in elements],
                          [0 for _ in elements])
    freed, taken = [[] for _ in elements], [[] for _ in elements]
    entered, sent, finished, offered = [], [], [], -1
    for place, kept in enumerate(work):
        now = sent[-1] + 1 if sent else 0
        if setup is not None:
            before = triangles.primitive[place - 1] if place else -1
            offered += triangles.primitive[place] - before
            if place >= setup.waiting:
                offered = max(offered, entered[place - setup.waiting])
            entered.append(max(offered, entered[-1] + setup.interval if place else never,
                               sent[place - setup.inside] if place >= setup.inside else never))
            now = max(now, entered[-1] + setup.latency,
                      sent[-1] + setup.leaving if sent else never)
        while any(sum(time <= now - 2 for time in taken[element])
                  - sum(time <= now for time in freed[element]) >= depth - 1
                  for element in elements):
            now += 1
        sent.append(now)
        for element in elements:
            if kept[element] is None:
                continue
            walk, rows = kept[element]
            taken[element].append(now)
            begin = max(load[element], now + pipeline.queue)
            for clock, _ in rows:
                span = clocks[element][number[element]]
                free[element] = max(free[element], begin + pipeline.latency + clock) + span
                number[element] += 1
            done = clocks[element][:number[element]]

            def back(spans, done=done, end=free[element]):
                return end - max(spans, sum(done[-1 - spans:])) if len(done) > spans else never

            load[element] = max(begin + walk, back(pipeline.spans_ahead) - pipeline.lead)
            freed[element].append(1 + max(begin + walk + pipeline.found,
                                          free[element] - pipeline.valued))
        finished.append(max(free) + pipeline.finish)
    return finished


@pytest.mark.parametrize(("cards", "skew", "seed"), [
    *((cards, False, seed) for cards in CARDS for seed in range(3)), ("PMPMMM", True, 3),
    ("4x(PMM)", True, 4)])
def test_the_arrays_say_what_the_recurrence_says(cards, skew, seed):
    pick = random.Random(f"pipeline {cards} {seed}")
    listed = scene(10 + seed, n=60, size=pick.choice((4, 12, 25)))
    # The last triangle has a span in every element, which keeps the list in one part.
    listed.position[-1] = 256 * np.array([[0, 0], [39, 0], [0, 27]])
    pipeline = Pipeline(**{field.name: pick.randrange(1, 9) for field in fields(Pipeline)})
    configuration = configure(listed, cards=cards, memory_ports=2, skew=skew)
    setup = pick.choice((None, SetupTiming(interval=20, latency=30, inside=3),
                         SetupTiming(interval=2, latency=11, waiting=4, inside=7)))
    cycles = []
    for depth in (2, 5, 100):
        prediction = predict_cycles(replace(configuration, fifo_depth=depth), listed, pipeline,
                                    setup=setup)
        np.testing.assert_array_equal(
            prediction.finished, written_out(configuration, listed, pipeline, depth, setup))
        assert prediction.cycles >= prediction.bound
        cycles.append(prediction.cycles)
    assert cycles == sorted(cycles, reverse=True)


@pytest.mark.parametrize("seed", range(4))
@pytest.mark.parametrize("pause", [0, 60])
def test_hidden_fragments_take_one_port_a_clock_too(seed, pause, monkeypatch):
    """Where nothing is written or scanned, one port is as good as two, span by span."""
    pick = np.random.default_rng(seed)
    listed = scene(30 + seed, n=80, size=int(pick.choice((4, 12, 25))))
    configuration = configure(listed, cards="PMPMMM", clocks_per_pixel=256, memory_ports=2)
    _, (spans,) = spans_of(configuration, listed, 1 << 20)
    pipeline = Pipeline()
    entries = entries_of(lattice_blocks(configuration), 2, spans, pipeline)

    class Hidden:
        """No writes, all in one lane."""

        def of(self, spans):
            lanes = np.stack([spans.length, np.zeros(len(spans.length))], axis=1)
            return np.stack([lanes, 0 * lanes, lanes], axis=1)

    monkeypatch.setattr("cardcage.golden.lanes.scan_share", lambda _: 0.0)
    monkeypatch.setattr("cardcage.golden.lanes.scan_shares", lambda _: np.zeros((1, 2, 2)))
    one, two = OnePort(configuration, Hidden(), pipeline), TwoPorts(configuration, pipeline)
    costs = zip(one.costs(entries, spans), two.costs(entries, spans), strict=True)
    loads, held = np.zeros((2, 2)), 0
    for element, walk, cost in zip(entries.element, entries.walk, costs, strict=True):
        drawn = [model.elements[element].take(load, part) for model, load, part in zip(
            (one, two), loads[element].tolist(), cost, strict=True)]
        assert drawn[0].drawn == pytest.approx(drawn[1].drawn, abs=1e-6)
        walker = [part.walker for part in drawn]
        held += walker[0] > loads[element, 0] + walk
        loads[element] = np.maximum(loads[element] + walk, walker)
        assert loads[element, 0] == pytest.approx(loads[element, 1], abs=1e-6)
        loads[element] += pick.choice((0, 0, 0, pause))
    assert pause or held > 10


@pytest.mark.parametrize("cards", CARDS)
def test_parts_of_a_list_hang_together(cards, monkeypatch):
    """Cut into parts of a few triangles it takes as long, but for spans that lie across a cut."""
    listed = scene(20, n=300)
    configuration = configure(listed, cards=cards, memory_ports=2)
    whole = predict_cycles(configuration, listed)
    monkeypatch.setattr("cardcage.golden.cycle_model.lattice_spans",
                        partial(lattice_spans, row_limit=200))
    parts = predict_cycles(configuration, listed)
    assert (parts.bound, parts.binding) == (pytest.approx(whole.bound, rel=0.01), whole.binding)
    assert parts.cycles == pytest.approx(whole.cycles, rel=0.01)


def test_the_binding_bound():
    listed = scene(4)
    machine = configure(listed, cards="PM")
    assert predict_cycles(machine, listed).binding == "busiest port"
    assert predict_cycles(replace(machine, memory_ports=2), listed).binding == "busiest element"
    slow = predict_cycles(machine, listed, setup=SetupTiming(interval=1000))
    assert slow.binding == "set-up"
    assert slow.cycles - 1000 < slow.bound <= slow.cycles + 1000
    pixels = scene(4, n=300, size=1)
    many = configure(pixels, cards="8x(PM)", memory_ports=2)
    assert predict_cycles(many, pixels).binding == "broadcast"


def test_an_empty_list_takes_no_time():
    listed = scene(5)
    none = DisplayList(40, 28, listed.position[:0], listed.depth[:0], listed.color[:0])
    prediction = predict_cycles(configure(listed, cards="PMM"), none)
    assert (prediction.cycles, prediction.bound) == (0, 0)
