"""Operations in their order, each when nothing is drawn."""

import random

import pytest
from hdl_bench.bench import Agent, rejects, simulate
from hdl_bench.streams import Sink, Source, no_pause, pauses

from cardcage.golden.specification.commands import ResponseKind, response_value
from cardcage.hdl.backplane.words import Operation
from cardcage.hdl.direct.element_control import DirectElementControl

NODE, TOTAL, FRAGMENTS, BUSY = 5, 8, 0x89ABCDEF, 0x01234567
OPERATIONS = [Operation.SURVEY, Operation.FRAME_START, Operation.READ_DEPTH,
              Operation.READ_COUNTERS]
ANSWERS = {
    Operation.SURVEY: [(ResponseKind.NODE, response_value(ResponseKind.NODE, node=NODE,
                                                          units=TOTAL))],
    Operation.READ_COUNTERS: [(ResponseKind.FRAGMENTS, FRAGMENTS), (ResponseKind.BUSY, BUSY)],
}


class Drawing(Agent):
    """Draws for ``hold()`` clocks at first, and anew behind each operation; looks at the rest."""

    def __init__(self, dut, source, hold):
        self.dut, self.source, self.hold = dut, source, hold
        self.left, self.seen, self.clock = hold(), 0, 0
        self.frame_starts, self.idle = [], []

    @property
    def finished(self):
        return self.left == 0

    def drive(self, ctx):
        dut = self.dut
        for line, value in ((dut.node, NODE), (dut.total, TOTAL), (dut.fragments, FRAGMENTS),
                            (dut.busy_cycles, BUSY)):
            ctx.set(line, value)
        if len(self.source.taken) > self.seen:
            self.seen, self.left = len(self.source.taken), self.hold()
        self.draws = self.left > 0
        ctx.set(dut.drawing, self.draws)
        self.left = max(0, self.left - 1)

    def sample(self, ctx):
        self.idle.append(ctx.get(self.dut.idle))
        assert not (self.idle[-1] and (self.draws or ctx.get(self.dut.operations.valid)))
        if ctx.get(self.dut.frame_start):
            assert not self.draws
            self.frame_starts.append(self.clock)
        self.clock += 1


def run(operations, hold, pause):
    dut = DirectElementControl(id_bits=4, node_bits=3)
    source = Source(dut.operations, [operation.value for operation in operations], pause)
    expected = [word for operation in operations for word in ANSWERS.get(operation, [])]
    sink = Sink(dut.responses, len(expected), pause, zero=True)
    drawing = Drawing(dut, source, hold)
    simulate(dut, source, sink, drawing, after=4)
    assert [(item.kind, item.value) for item in sink.items] == expected
    assert drawing.frame_starts == [clock for clock, operation in zip(
        source.taken, operations, strict=True) if operation == Operation.FRAME_START]
    assert drawing.idle[-1]
    return source, sink


@pytest.mark.parametrize("seed", range(3))
def test_random_operations(seed):
    pick = random.Random(f"element control {seed}")
    run([pick.choice(OPERATIONS) for _ in range(30)], lambda: pick.choice((0, 0, 1, 5)),
        pauses(seed))


def test_latency():
    """A clock to the first word, and then a word a clock."""
    source, sink = run([Operation.SURVEY, Operation.READ_COUNTERS, Operation.READ_DEPTH],
                       lambda: 0, no_pause)
    assert (sink.clocks, source.taken) == ([1, 3, 4], [1, 4, 5])


@pytest.mark.parametrize("name", ["id_bits", "node_bits"])
def test_bad_sizes(name):
    rejects(DirectElementControl, name, **{"id_bits": 3, "node_bits": 2} | {name: 0})
