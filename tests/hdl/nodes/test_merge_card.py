"""What a merge card reports, and in which turn; the lines that it counts and ends."""

import random

import pytest
from hdl_bench.bench import Agent, Drive, simulate
from hdl_bench.pictures import small_machine
from hdl_bench.streams import Sink, Source, no_pause, pauses

from cardcage.golden.specification.commands import ResponseKind, response_value
from cardcage.hdl.backplane.connectors import BroadcastLines
from cardcage.hdl.backplane.words import Operation
from cardcage.hdl.nodes.chain_merge import ChainMerge
from cardcage.hdl.nodes.tree_merge import TreeMerge

KINDS = {"C": ChainMerge, "T": TreeMerge}
#: A card further right speaks two clocks after it was asked, at the earliest.
NEIGHBOUR = 2
FURTHER = (ResponseKind.FRAGMENTS, 0xFFFF_FFFF)


class Questions(Agent):
    """Asks for reports, each when the last one is done.  ``asked`` lists the clocks.

    ``done`` has to be low, from when it counts, until the card's own word has been taken.
    """

    def __init__(self, dut, operations, sink):
        self.dut, self.operations, self.sink = dut, list(operations), sink
        self.neighbour = None
        self.asked, self.clock = [], 0
        self.reports = sum(operation != Operation.FRAME_START for operation in operations)

    @property
    def finished(self):
        return not self.operations

    def drive(self, ctx):
        lines = self.dut.broadcast
        ctx.set(self.dut.own.ready, 1)
        ctx.set(self.dut.own.done, 1)
        settled = not self.asked or self.clock > self.asked[-1] + BroadcastLines.settle_clocks
        ask = (bool(self.operations) and settled and self.neighbour.said_all
               and bool(ctx.get(lines.done)))
        ctx.set(lines.strobe, ask)
        if ask:
            own = [item for item in self.sink.items if (item.kind, item.value) != FURTHER]
            left = sum(operation != Operation.FRAME_START for operation in self.operations)
            assert len(own) == self.reports - left, f"clock {self.clock}: done too soon"
            ctx.set(lines.packet.operation, self.operations.pop(0))
            self.asked.append(self.clock)

    def sample(self, ctx):
        self.clock += 1


class Neighbour(Source):
    """The cards further right: so many words each time that something is asked."""

    def __init__(self, dut, questions, counts, pause):
        self.questions, self.counts = questions, counts
        questions.neighbour = self
        word = dict(zip(("kind", "value"), FURTHER, strict=True))
        super().__init__(dut.right.response, [word] * sum(counts), pause)

    @property
    def said_all(self):
        return len(self.taken) == sum(self.counts[:len(self.questions.asked)])

    def drive(self, ctx):
        asked = sum(clock + NEIGHBOUR <= self._clock for clock in self.questions.asked)
        if self._offering or len(self.taken) < sum(self.counts[:asked]):
            super().drive(ctx)
        else:
            ctx.set(self._stream.valid, 0)


def own_words(operation, node, units):
    if operation == Operation.SURVEY:
        return [(ResponseKind.NODE, response_value(ResponseKind.NODE, node=node, units=units))]
    return [(ResponseKind.SENT, 0)] if operation == Operation.READ_COUNTERS else []


def run(kind, operations, counts, *, node=3, units=4, pause=no_pause, further=no_pause):
    """Each question is answered by the card, then by ``counts`` words from its right."""
    dut = KINDS[kind](configuration=small_machine(f"5x(PMMMM{kind})", order_bits=2))
    wanted = [word for operation, count in zip(operations, counts, strict=True)
              for word in [*own_words(operation, node, units), *[FURTHER] * count]]
    sink = Sink(dut.left.response, len(wanted), pause)
    questions = Questions(dut, operations, sink)

    def lines(ctx, clock):
        ctx.set(dut.left.id, units)
        ctx.set(dut.left.node, node)
        ctx.set(dut.left.lines.write.valid, 1)
        ctx.set(dut.left.lines.read.valid, 1)
        assert (ctx.get(dut.right.node), ctx.get(dut.right.id)) == (node + 1, 0)
        # No memory bus passes.
        assert not ctx.get(dut.right.lines.write.valid) and not ctx.get(dut.right.lines.read.valid)

    neighbour = Neighbour(dut, questions, counts, further)
    simulate(dut, Drive(lines), sink, questions, neighbour, after=12)
    assert [(item.kind, item.value) for item in sink.items] == wanted
    return questions, sink


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("seed", range(4))
def test_own_report_first(kind, seed):
    """Before those from the right, whoever waits for whom; only to what asks for one."""
    pick = random.Random(f"reports {kind} {seed}")
    operations = [Operation.SURVEY, *(pick.choice(
        (Operation.READ_COUNTERS, Operation.FRAME_START)) for _ in range(12))]
    counts = [operation != Operation.FRAME_START and pick.randrange(5) for operation in operations]
    run(kind, operations, counts, node=pick.randrange(5), units=pick.randrange(1, 5),
        pause=pauses(f"takes {seed}"), further=pauses(f"further {seed}"))


@pytest.mark.parametrize("kind", KINDS)
def test_latency_and_throughput(kind):
    """Two clocks from the question to its answer, and then a word a clock."""
    questions, sink = run(kind, [Operation.SURVEY, Operation.READ_COUNTERS], [3, 3])
    assert sink.clocks == [asked + 2 + place for asked in questions.asked for place in range(4)]
