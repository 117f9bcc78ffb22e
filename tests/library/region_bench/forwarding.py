"""A row of forwarders, as processing elements have them, and who draws what by the golden model."""

from collections import Counter
from itertools import pairwise

import numpy as np
from amaranth.hdl import Module
from amaranth.lib import stream, wiring
from amaranth.lib.wiring import In, Out
from hdl_bench.bench import Agent, Watch, simulate
from hdl_bench.streams import Sink, Source, no_pause, once, pauses

from cardcage.golden.objects.forwarded_objects import ForwardedObjects
from cardcage.golden.organisations.region_table import runs_table
from cardcage.hdl.backplane.region_lines import RegionLines
from cardcage.hdl.forwarding.object_forwarder import ObjectForwarder
from cardcage.hdl.forwarding.reach import reaching_object_layout

OBJECT_BITS = 12


class ForwarderRow(wiring.Component):
    """Neighbours connected; the host's streams, those to be drawn, and the lines of the table."""

    def __init__(self, configuration, **queues):
        self.elements = configuration.processing_elements
        self.forwarders = [ObjectForwarder(configuration=configuration, object_bits=OBJECT_BITS,
                                           **queues) for _ in range(self.elements)]
        shape = reaching_object_layout(configuration, OBJECT_BITS)
        super().__init__({
            "regions": In(RegionLines(configuration)),
            "host": In(stream.Signature(shape)).array(self.elements),
            "drawn": Out(stream.Signature(shape)).array(self.elements),
            "busy": Out(self.elements), "left": Out(self.elements), "right": Out(self.elements),
        })

    def elaborate(self, platform):
        m = Module()
        for number, forwarder in enumerate(self.forwarders):
            m.submodules[f"element_{number}"] = forwarder
            m.d.comb += [getattr(forwarder.regions, name).eq(getattr(self.regions, name))
                         for name in self.regions.signature.members]
            m.d.comb += [
                forwarder.element.eq(number),
                self.busy[number].eq(forwarder.busy),
                # With nobody there it would be taken, and counted.
                self.left[number].eq(forwarder.to_left.valid & forwarder.to_left.ready),
                self.right[number].eq(forwarder.to_right.valid & forwarder.to_right.ready),
            ]
            wiring.connect(m, wiring.flipped(self.host[number]), forwarder.host)
            wiring.connect(m, forwarder.drawn, wiring.flipped(self.drawn[number]))
        for one, other in pairwise(self.forwarders):
            wiring.connect(m, one.to_right, other.from_left)
            wiring.connect(m, other.to_left, one.from_right)
        m.d.comb += [self.forwarders[0].to_left.ready.eq(1),
                     self.forwarders[-1].to_right.ready.eq(1)]
        return m


class Deal(Agent):
    """Says the table on the lines, a region a clock, pausing."""

    def __init__(self, lines, configuration, table):
        self._lines, self._columns = lines, configuration.dealt_regions.columns
        self._left = list(enumerate(table.tolist()))

    @property
    def finished(self):
        return not self._left

    def drive(self, ctx):
        ctx.set(self._lines.valid, bool(self._left))
        if self._left:
            region, element = self._left.pop(0)
            ctx.set(self._lines.column, region % self._columns)
            ctx.set(self._lines.row, region // self._columns)
            ctx.set(self._lines.element, element)


def some_reaches(configuration, pick, count, kind):
    """Rectangles of regions: ``any``, small ones, or all the whole screen."""
    regions = configuration.dealt_regions
    found = []
    for _ in range(count):
        reach = {}
        for low, high, size in (("left", "right", regions.columns), ("top", "bottom",
                                                                     regions.rows)):
            ends = sorted(pick.randrange(size) for _ in range(2))
            if kind == "small":
                ends[1] = min(ends[0] + pick.randrange(2), size - 1)
            reach[low], reach[high] = (0, size - 1) if kind == "all" else ends
        found.append(reach)
    return found


def check_row(configuration, sources, reaches, *, seed=None, slow=None, limit=20_000,
              **queues):
    """Each object to its ``sources``' element, from the first clock after the table on; asserts
    that all is drawn and passed as golden has it, and that ``busy`` is exact.  Returns the clocks
    in which each element drew.  ``slow``: an element that draws nothing in the first clocks."""
    dut = ForwarderRow(configuration, **queues)
    elements, regions = dut.elements, configuration.dealt_regions
    table = runs_table(regions.count, elements)
    met = np.array([[reach["left"] <= column <= reach["right"]
                     and reach["top"] <= row <= reach["bottom"]
                     for row in range(regions.rows) for column in range(regions.columns)]
                    for reach in reaches]).reshape(len(reaches), regions.count)
    golden = ForwardedObjects(elements, np.array(sources, int), met, table)
    pace = (lambda _: no_pause) if seed is None else pauses
    items = [[{"object": number, "reach": reach} for number, (reach, source) in enumerate(
        zip(reaches, sources, strict=True)) if source == element] for element in range(elements)]
    hosts = [Source(dut.host[element], items[element], pace((seed, element, "host")))
             for element in range(elements)]
    sinks = [Sink(dut.drawn[element], int(golden.drawn[:, element].sum()),
                  once((slow or {}).get(element, 0), pace((seed, element, "drawn"))))
             for element in range(elements)]
    passed = {"left": [0] * elements, "right": [0] * elements}
    owed = 0

    def count(ctx, clock):
        nonlocal owed
        assert (ctx.get(dut.busy) != 0) == (owed > 0), f"clock {clock}: {owed} are still to come"
        for element, host in enumerate(hosts):
            for way, counts in passed.items():
                counts[element] += ctx.get(getattr(dut, way)) >> element & 1
            given = dut.host[element]
            if ctx.get(given.valid) and ctx.get(given.ready):
                number = items[element][len(host.taken)]["object"]
                owed += int(golden.drawn[number].sum())
            drawn = dut.drawn[element]
            owed -= ctx.get(drawn.valid) & ctx.get(drawn.ready)

    deal = Deal(dut.regions, configuration, table)
    simulate(dut, deal, Waiting(deal, [Watch(count), *hosts, *sinks]), limit=limit, after=3)
    for element, sink in enumerate(sinks):
        assert Counter(item.object for item in sink.items) == Counter(
            np.flatnonzero(golden.drawn[:, element]).tolist()), f"element {element}"
        assert all({name: int(item.reach[name]) for name in reaches[item.object]}
                   == reaches[item.object] for item in sink.items)
    assert passed == {"left": golden.left.tolist(), "right": golden.right.tolist()}
    return [sink.clocks for sink in sinks]


class Waiting(Agent):
    """``agents`` begin when ``first`` is finished and a clock has passed."""

    def __init__(self, first, agents):
        self._first, self._agents = first, agents
        self._clocks = 0

    @property
    def finished(self):
        return self._clocks > 1 and all(agent.finished for agent in self._agents)

    def drive(self, ctx):
        self._clocks += self._first.finished
        if self._clocks > 1:
            for agent in self._agents:
                agent.drive(ctx)

    def sample(self, ctx):
        if self._clocks > 1:
            for agent in self._agents:
                agent.sample(ctx)
