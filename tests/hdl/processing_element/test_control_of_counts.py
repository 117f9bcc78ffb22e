"""The counts of slots as a third service of the control, among other operations."""

import random

import pytest
from hdl_bench.bench import Agent, Drive, simulate
from hdl_bench.streams import Sink, Source, no_pause, pauses

from cardcage.golden.specification.commands import ResponseKind
from cardcage.hdl.backplane.words import Operation
from cardcage.hdl.processing_element.control import ProcessingElementControl

COUNTS = [3, 0, 0xFFFF_FFFF, 12]
FRAGMENTS, BUSY = 7, 9
OPERATIONS = [Operation.FRAME_START, Operation.READ_COUNTERS, Operation.READ_REGIONS]


class Counts(Agent):
    """Sends them when it is told, as ``RegionCounts`` does: done as the last one is taken."""

    def __init__(self, dut, pause):
        self.dut, self.pause = dut, pause
        self.unsent, self.wait, self.started, self.clock = [], 0, [], 0

    def drive(self, ctx):
        self.sending = bool(self.unsent) and not self.wait
        self.wait = max(0, self.wait - 1)
        ctx.set(self.dut.counts.valid, self.sending)
        ctx.set(self.dut.counts.payload, self.unsent[0] if self.sending else 0)
        # The sink before has said whether it is ready.
        self.taken = self.sending and ctx.get(self.dut.counts.ready)
        ctx.set(self.dut.counts_done, self.taken and len(self.unsent) == 1)

    def sample(self, ctx):
        if ctx.get(self.dut.counts_start):
            assert not self.unsent
            self.started.append(self.clock)
            self.unsent, self.wait = list(COUNTS), self.pause()
        elif self.taken:
            self.unsent.pop(0)
            self.wait = self.pause()
        self.clock += 1


def run(kinds, *, drawing=(), pause=(no_pause,) * 3):
    """``drawing``: clocks in which the datapath draws."""
    dut = ProcessingElementControl(id_bits=3, depth_bits=8, counts_regions=True)
    answers = {Operation.READ_REGIONS: [(ResponseKind.REGION_COUNT, count) for count in COUNTS],
               Operation.READ_COUNTERS: [(ResponseKind.FRAGMENTS, FRAGMENTS),
                                         (ResponseKind.BUSY, BUSY)]}
    expected = [answer for kind in kinds for answer in answers.get(kind, ())]
    source = Source(dut.operations, [kind.value for kind in kinds], pause[0])
    sink = Sink(dut.responses, len(expected), pause[1], zero=True)
    counts = Counts(dut, pause[2])

    def lines(ctx, clock):
        for name, value in (("fragments", FRAGMENTS), ("busy_cycles", BUSY),
                            ("drawing", clock in drawing)):
            ctx.set(getattr(dut, name), value)

    simulate(dut, Drive(lines), source, sink, counts, after=6)
    assert [(item.kind, item.value) for item in sink.items] == expected
    assert len(counts.started) == kinds.count(Operation.READ_REGIONS)
    return source, sink, counts


@pytest.mark.parametrize("seed", range(4))
def test_random_operations(seed):
    pick = random.Random(f"counts {seed}")
    print(f"seed {seed}")
    run([pick.choice(OPERATIONS) for _ in range(30)],
        pause=[pauses(f"{part} {seed}") for part in range(3)])


def test_counts_follow_when_the_datapath_is_empty():
    source, sink, counts = run([Operation.READ_REGIONS], drawing=range(6))
    assert counts.started == [6]
    assert sink.clocks == [7, 8, 9, 10]
    assert source.taken == [10]
