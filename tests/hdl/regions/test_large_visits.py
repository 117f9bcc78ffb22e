"""Regions that triangles of large boxes visit, and the clocks it takes to find them."""

from itertools import pairwise

import pytest
from hdl_bench.bench import Agent, simulate
from hdl_bench.pictures import random_triangles
from hdl_bench.regions import Deal, Dealt, random_table, region_machine
from hdl_bench.streams import Sink, no_pause, pauses

from cardcage.hdl.regions.large_visits import LargeVisits

MACHINES = ("squares", "wide", "columns", "rows")


class Outlines(Agent):
    """Holds each outline until its last visit is taken; the next one comes at once, or after a
    pause.  ``started``: the first clock of each; ``ended``: the one in which it went."""

    def __init__(self, dut, outlines, after, pause):
        self.dut, self.outlines, self.pause = dut, outlines, pause
        self.wait, self.clock = after, 0
        self.started, self.ended = [], []

    @property
    def finished(self):
        return len(self.ended) == len(self.outlines)

    def drive(self, ctx):
        offers = not self.finished and not self.wait
        ctx.set(self.dut.start, offers)
        if offers and len(self.started) == len(self.ended):
            ctx.set(self.dut.outline, self.outlines[len(self.ended)])
            self.started.append(self.clock)
        self.wait = max(0, self.wait - 1)

    def sample(self, ctx):
        visits = self.dut.visits
        if ctx.get(visits.valid) and ctx.get(visits.ready) and ctx.get(visits.payload.last):
            self.ended.append(self.clock)
            self.wait = self.pause()
        self.clock += 1


def run(machine, seed, pause, *, count=60, choose=lambda case, index: True):
    configuration = region_machine(machine)
    display_list = random_triangles(f"{machine} {seed}", count, width=configuration.width,
                                    height=configuration.height, extreme=True)
    before, table = (random_table(configuration, f"{machine} {seed} {which}") for which in range(2))
    element = len(machine) % configuration.processing_elements
    case = Dealt(configuration, table, element, display_list)
    indices = [index for index in case.kept() if case.large(index) and choose(case, index)]
    dut = LargeVisits(configuration=configuration)
    deal = Deal(dut.regions, configuration, [before, table], dut.element, element)
    outlines = Outlines(dut, [
        {name: field for name, field in case.outline(index).items()
         if name not in ("own", "large")} for index in indices], deal.clocks, pause[0])
    expected = []
    for index in indices:
        found = [(visit.column, visit.row) for visit in case.visits(index)]
        expected += [(*region, 0, region == found[-1]) for region in found] or [(None, None, 1, 1)]
    sink = Sink(dut.visits, len(expected), pause[1])
    simulate(dut, deal, outlines, sink, after=9)
    assert [(None, None, 1, 1) if item.none else (item.column, item.row, 0, item.last)
            for item in sink.items] == expected
    return case, indices, outlines, sink


@pytest.mark.parametrize("machine", MACHINES)
@pytest.mark.parametrize("seed", range(2))
def test_visits_are_those_that_the_edges_reach(machine, seed):
    case, indices, *_ = run(machine, seed, (pauses(f"in {seed}"), pauses(f"out {seed}")))
    visits = [len(case.visits(index)) for index in indices]
    assert len(indices) > 10 and max(visits) > 2


def bands(case, index):
    """Of each row of regions: probes, how many regions are looked at, and which are visited, as
    places among these.  A band that has no region of its own in the box has no probes."""
    left, right, top, bottom = case.boxes[index]
    value, bits = case.values[index], case.regions.x_bits
    visits = case.visits(index)
    for row in range(top, bottom + 1):
        own = [column for column in range(case.regions.columns) if case.own(column, row)]
        if not own or own[0] > right or own[-1] < left:
            yield 0, 0, []
            continue
        rows = case.band(index, row)
        extents = case.extents(index, row)
        least = min(first for _, first, _ in extents)
        most = max(beyond for *_, beyond in extents)
        first, count = least >> bits, (most - 1 >> bits) - (least >> bits) + 1
        yield (4 if rows[0] < value["middle"] <= rows[-1] else 2,
               count if least < most else 0,
               [visit.column - first for visit in visits if visit.row == row])


def unhindered(case, index):
    """No band waits for the one before: there, no more regions are looked at than rows are probed
    in the next."""
    probed = [band for band in bands(case, index) if band[0]]
    return all(scanned <= probes for (_, scanned, _), (probes, *_) in pairwise(probed))


def clocks(case, index):
    """From the start, of each visit, where nothing waits: known when the next one is found, or
    when none can be any more."""
    clock, found, ended = 1, [], 0
    for probes, scanned, places in bands(case, index):
        if not probes:
            clock += 1
            ended = max(ended, clock)
            continue
        clock += probes
        known = clock - 1 + 5  # the last extent
        found += [known + 2 + place for place in places]
        ended = max(ended, known + (scanned + 2 if scanned else 1))
    return [*found[1:], ended]


@pytest.mark.parametrize("machine", MACHINES)
def test_latency_and_throughput(machine):
    """A row probed in a clock, a region looked at in a clock, a band passed over in one; another
    triangle follows at once."""
    case, indices, outlines, sink = run(machine, "speed", (no_pause, no_pause), count=300,
                                        choose=unhindered)
    assert len(indices) > 10
    expected = [start + clock for start, index in zip(outlines.started, indices, strict=True)
                for clock in clocks(case, index)]
    assert sink.clocks == expected
    assert outlines.started[1:] == [clock + 1 for clock in outlines.ended[:-1]]
    assert LargeVisits.latency == 10
