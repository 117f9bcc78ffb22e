"""One step after the other, against cards that take their time."""

import pytest
from hdl_bench.bench import Agent, Drive, Service, rejects, simulate
from hdl_bench.streams import no_pause, pauses

from cardcage.golden.merging.tree import tree_pairs
from cardcage.hdl.controller.tree_steps import TreeSteps


class Cards(Agent):
    """Busy for a while from the clock after each start, their elements for longer.

    ``steps``: the number of each step that began, and its clock.
    """

    def __init__(self, dut, pause):
        self.dut, self.pause = dut, pause
        self.clock = self.busy = self.writing = 0
        self.steps = []
        self.going = False

    def drive(self, ctx):
        ctx.set(self.dut.lines.busy, self.busy > 0)
        ctx.set(self.dut.quiet, self.writing == 0)

    def sample(self, ctx):
        lines = self.dut.lines
        if self.busy or self.writing:
            assert not ctx.get(lines.start) and not ctx.get(self.dut.done)
            assert ctx.get(lines.step) == self.steps[-1][0]
        assert ctx.get(self.dut.idle) == (not self.going)
        self.going = (self.going or ctx.get(self.dut.start)) and not ctx.get(self.dut.done)
        self.busy, self.writing = max(0, self.busy - 1), max(0, self.writing - 1)
        if ctx.get(lines.start):
            self.steps.append((ctx.get(lines.step), self.clock))
            self.busy = self.pause()
            self.writing = self.busy and self.busy + self.pause()
        self.clock += 1


def run(nodes, pause):
    dut = TreeSteps(node_bits=nodes.bit_length())
    cards, service = Cards(dut, pause), Service(dut, 2, pause)
    simulate(dut, service, cards, Drive(lambda ctx, clock: ctx.set(dut.nodes, nodes)), after=3)
    return cards, service


@pytest.mark.parametrize("nodes", [1, 2, 3, 4, 5, 8, 63, 64])
@pytest.mark.parametrize("stall", [False, True])
def test_as_many_steps_as_the_tree_has(nodes, stall):
    cards, service = run(nodes, pauses(f"cards {nodes}") if stall else no_pause)
    steps = sorted({step for step, _, _ in tree_pairs(nodes)})
    assert [step for step, _ in cards.steps] == steps * 2
    if not stall:
        begun = [clock for _, clock in cards.steps]
        for start, end, own in zip(service.started, service.ended,
                                   (begun[:len(steps)], begun[len(steps):]), strict=True):
            assert own == [start + 1 + 2 * step for step in steps]
            assert end == start + 1 + 2 * len(steps)


def test_bad_bits():
    rejects(TreeSteps, "node_bits", node_bits=0)
