"""One-port units in the cycle model: accesses, the scan's share, lanes, and two ports beside."""

from __future__ import annotations

import random

import numpy as np
import pytest
from cycle_lists import owner, scene, spans_of
from wide_machines import wide_machine

from cardcage.golden.cycles.element_latencies import Pipeline
from cardcage.golden.cycles.one_port.one_port_element import OnePort
from cardcage.golden.cycles.one_port.one_port_lanes import LANE_START, ElementLanes
from cardcage.golden.cycles.one_port.port_accesses import PortAccesses
from cardcage.golden.cycles.one_port.scan_reads import scan_shares
from cardcage.golden.cycles.row_clocks import entries_of
from cardcage.golden.cycles.two_port_element import TwoPorts
from cardcage.golden.organisations.organisation_of import organisation_of
from cardcage.golden.reference.exact import draw, fragments
from cardcage.golden.specification.configuration import MachineConfiguration
from cardcage.golden.specification.queues import FRAGMENTS_WAITING, depth_lanes


def test_written_fragments():
    """With one port and one unit a span takes an access for each fragment and for each write."""
    listed = scene(3, n=150)
    configuration = wide_machine(listed, cards="PM", clocks_per_pixel=256)
    triangles, parts = spans_of(configuration, listed)
    ports = PortAccesses(organisation_of(configuration), listed, triangles)
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
    ("4x(PM)", {"skew": True}), ("PMPMMM", {}), ("2x(PMM)", {"block": 4}), ("PMMMM", {}),
    ("2x(PMM)", {"lines": True}), ("4x(PM)", {"lines": True})])
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
    shares = scan_shares(organisation_of(machine))
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
    lanes, now = ElementLanes(machine, scan_shares(organisation_of(machine))[:, 0]), 0.0
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


def walked(configuration, listed):
    """The spans of a list, the elements' pipeline, and what each of two elements walks of them."""
    _, (spans,) = spans_of(configuration, listed, 1 << 20)
    pipeline = Pipeline()
    return spans, pipeline, entries_of(organisation_of(configuration).blocks, 2, spans, pipeline)


@pytest.mark.parametrize("seed", range(4))
@pytest.mark.parametrize("pause", [0, 60])
def test_hidden_fragments_take_one_port_a_clock_too(seed, pause, monkeypatch):
    """Where nothing is written or scanned, one port is as good as two, span by span."""
    pick = np.random.default_rng(seed)
    listed = scene(30 + seed, n=80, size=int(pick.choice((4, 12, 25))))
    configuration = wide_machine(listed, cards="PMPMMM", clocks_per_pixel=256, memory_ports=2)
    spans, pipeline, entries = walked(configuration, listed)

    class Hidden:
        """No writes, all in one lane."""

        def of(self, spans):
            lanes = np.stack([spans.length, np.zeros(len(spans.length))], axis=1)
            return np.stack([lanes, 0 * lanes, lanes], axis=1)

    monkeypatch.setattr("cardcage.golden.cycles.one_port.one_port_element.scan_shares",
                        lambda _: np.zeros((1, 2, 2)))
    one = OnePort(organisation_of(configuration), Hidden(), pipeline)
    two = TwoPorts(configuration.processing_elements, pipeline)
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


def test_each_row_costs_its_span_and_an_end_without_one_nothing():
    listed = scene(5, n=60, size=6)
    configuration = wide_machine(listed, cards="PMPMMM", block=1, clocks_per_pixel=256)
    spans, pipeline, entries = walked(configuration, listed)

    class Numbers:
        """Each span takes as many accesses as its number says, of every kind."""

        def of(self, spans):
            numbers = np.arange(len(spans.length)) * spans.squares
            return numbers[:, np.newaxis, np.newaxis] * np.ones((1, 3, 2))

    costs = OnePort(organisation_of(configuration), Numbers(), pipeline).costs(entries, spans)
    found = [(pair, offset, -1 if accesses is None else accesses[1][1])
             for pair, cost in enumerate(costs) for offset, accesses in cost]
    assert found == list(zip(entries.pair.tolist(), entries.offset.tolist(),
                             entries.span.tolist(), strict=True))
    assert {-1, 0} < set(entries.span.tolist())
