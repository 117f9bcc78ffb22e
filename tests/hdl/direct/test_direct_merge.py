"""The card D between elements and units in software: what it hands on, asks, counts and reports."""

import random

import pytest
from hdl_bench.bench import Agent, Drive, simulate
from hdl_bench.memory import MemoryBusModel
from hdl_bench.pictures import small_machine
from hdl_bench.streams import Sink, Source, no_pause, pauses

from cardcage.golden.specification.commands import ResponseKind, response_value
from cardcage.hdl.backplane.connectors import BroadcastLines
from cardcage.hdl.backplane.words import Operation
from cardcage.hdl.direct.direct_merge import DirectMerge

ELEMENTS = 3
FURTHER = (ResponseKind.NODE, 77)


class Teller(Agent):
    """Tells the card one operation after another, each when all before it is done; fragments come
    behind a ``FRAME_START``.  ``told`` lists the clocks."""

    def __init__(self, dut, operations, sources):
        self.dut, self.operations, self.sources = dut, list(operations), sources
        self.told, self.clock, self.draws = [], 0, False

    @property
    def finished(self):
        return not self.operations

    def drive(self, ctx):
        lines = self.dut.broadcast
        settled = not self.told or self.clock > self.told[-1] + BroadcastLines.settle_clocks
        drawn = all(source.finished for source in self.sources) or not self.draws
        tell = bool(self.operations) and settled and drawn and bool(ctx.get(lines.done))
        ctx.set(lines.strobe, tell)
        assert ctx.get(lines.ready)
        if tell:
            operation = self.operations.pop(0)
            ctx.set(lines.packet.operation, operation)
            self.draws |= operation == Operation.FRAME_START
            self.told.append(self.clock)
        for source in self.sources:
            source.open = self.draws

    def sample(self, ctx):
        self.clock += 1


class Fragments(Source):
    """An element, which begins when the frame does."""

    open = False

    def drive(self, ctx):
        if self.open:
            super().drive(ctx)


class Unit(Agent):
    """Takes fragments, is busy for some clocks after each, and says now and then that one
    followed."""

    def __init__(self, lines, count, pause, seed):
        self.lines, self.sink = lines, Sink(lines.fragments, count, pause)
        self.pick = random.Random(f"unit {seed}")
        self.busy = self.followed = self.clock = 0
        self.worked = -1  # the last clock in which it was busy

    @property
    def finished(self):
        return self.sink.finished and not self.busy

    def drive(self, ctx):
        self.sink.drive(ctx)
        self.follows = self.busy > 0 and self.pick.random() < 0.4
        self.followed += self.follows
        ctx.set(self.lines.busy, self.busy > 0)
        if self.busy:
            self.worked = self.clock
        ctx.set(self.lines.followed, self.follows)

    def sample(self, ctx):
        before = len(self.sink.items)
        self.sink.sample(ctx)
        self.busy = 5 if len(self.sink.items) > before else max(0, self.busy - 1)
        self.clock += 1


def run(seed, units, queue, pause=lambda name: no_pause, count=40):
    """A boot, a frame, and what it says afterwards."""
    pick = random.Random(f"card {seed}")
    configuration = small_machine("PPPD" + "M" * units, 8, 8, order_bits=3, queue=queue,
                                  memory_ports=2)
    dut = DirectMerge(configuration=configuration)
    lists = [[{"unit": pick.randrange(units), "address": place, "depth": 7,
               "color": pick.getrandbits(24)} for place in range(count)] for _ in range(ELEMENTS)]
    sources = [Fragments(stream, items, pause(f"element {number}"))
               for number, (stream, items) in enumerate(zip(dut.elements, lists, strict=True))]
    counts = [sum(item["unit"] == unit for items in lists for item in items)
              for unit in range(units)]
    cards = [Unit(lines, total, pause(f"unit {number}"), seed) for number, (lines, total) in
             enumerate(zip(dut.units, counts, strict=True))]
    memory = MemoryBusModel(dut.right.lines, first=0, end=units, words=configuration.words,
                            depth_bits=configuration.rank_bits, ports=2)
    depths = units * configuration.words
    sink = Sink(dut.left.response, 1 + depths + 2 * units + 1, pause("host"))
    right = Source(dut.right.response, [dict(zip(("kind", "value"), FURTHER, strict=True))])
    teller = Teller(dut, [Operation.SURVEY, Operation.CLEAR_LISTS, Operation.FRAME_START,
                          Operation.READ_DEPTH, Operation.READ_COUNTERS], sources)

    def lines(ctx, clock):
        ctx.set(dut.total, units)
        ctx.set(dut.left.node, ELEMENTS)
        ctx.set(dut.left.lines.write.valid, 1)  # what comes from the left is not for it
        assert (ctx.get(dut.right.node), ctx.get(dut.right.id)) == (ELEMENTS, 0)

    simulate(dut, Drive(lines), memory, teller, *cards, *sources, sink, right, after=5)
    words = [(item.kind, item.value) for item in sink.items]
    words.remove(FURTHER)  # from the right, when the card itself has nothing to say
    domain, *rest = words
    assert domain == (ResponseKind.DOMAIN, response_value(ResponseKind.DOMAIN, first=0,
                                                          units=units))
    assert rest[:depths] == [
        (ResponseKind.DEPTH, memory.depth[unit, address] >> configuration.order_bits)
        for unit in range(units) for address in range(configuration.words)]
    assert rest[depths:] == [word for unit, total in enumerate(counts) for word in (
        (ResponseKind.TAKEN, total), (ResponseKind.FOLLOWED, cards[unit].followed))]
    return teller, sources, cards, lists


@pytest.mark.parametrize("queue", [2, "element"])
@pytest.mark.parametrize("units", [1, 4])
@pytest.mark.parametrize("seed", range(2))
def test_a_frame(seed, units, queue):
    """What is told after drawing is told when all units have done with their fragments."""
    teller, _, cards, _ = run(f"{seed} {units} {queue}", units, queue,
                              lambda name: pauses(f"{seed} {name}"))
    assert all(unit.worked < teller.told[3] for unit in cards)


def test_latency():
    """Nothing is in the way of the first fragments but one another."""
    _, sources, cards, lists = run("fast", 4, 4, count=1)
    for unit, card in enumerate(cards):
        wanted = [items[0]["color"] for items in lists if items[0]["unit"] == unit]
        assert [item.color for item in card.sink.items] == wanted
        assert card.sink.clocks == [sources[0].taken[0] + DirectMerge.latency + place
                                    for place in range(len(wanted))]
