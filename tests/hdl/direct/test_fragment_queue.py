"""First come, first given, against a list."""

import random

import pytest
from amaranth.lib import data
from hdl_bench.bench import Agent, rejects, simulate
from hdl_bench.streams import Source, no_pause, pauses

from cardcage.hdl.direct.fragment_queue import FragmentQueue

SHAPE = data.StructLayout({"address": 7, "color": 9})


class Granter(Agent):
    """Grants and takes when ``grants`` and ``takes`` say so, and it may."""

    def __init__(self, dut, count, grants, takes):
        self.dut, self.count, self.grants, self.takes = dut, count, grants, takes
        self.given = False  # one is given and not taken
        self.items, self.waiting, self.clocks = [], [], []
        self.clock = 0

    @property
    def finished(self):
        return len(self.items) == self.count

    def drive(self, ctx):
        dut = self.dut
        self.taken = self.given and self.takes()
        self.granted = bool(ctx.get(dut.waiting)) and (
            not self.given or self.taken) and self.grants()
        ctx.set(dut.taken, self.taken)
        ctx.set(dut.grant, self.granted)

    def sample(self, ctx):
        self.waiting.append(ctx.get(self.dut.waiting))
        if self.taken:
            self.items.append({name: ctx.get(self.dut.given[name]) for name, _ in SHAPE})
            self.clocks.append(self.clock)
        self.given = self.granted or (self.given and not self.taken)
        self.clock += 1


def run(depth, count, pause, grants, takes):
    pick = random.Random(f"queue {depth}")
    items = [{"address": pick.getrandbits(7), "color": pick.getrandbits(9)} for _ in range(count)]
    dut = FragmentQueue(depth=depth, shape=SHAPE)
    source, granter = Source(dut.fragments, items, pause), Granter(dut, count, grants, takes)
    simulate(dut, source, granter, after=2)
    assert granter.items == items
    return source, granter


def likely(seed, chance):
    pick = random.Random(seed)
    return lambda: pick.random() < chance


@pytest.mark.parametrize("depth", [1, 2, 3, 4, 7])
@pytest.mark.parametrize("seed", range(3))
def test_random_traffic(depth, seed):
    run(depth, 80, pauses(seed), likely(f"grants {seed}", 0.4 + 0.3 * seed),
        likely(f"takes {seed}", 0.9 - 0.3 * seed))


@pytest.mark.parametrize("depth", [2, 3, 4])
def test_latency_and_throughput(depth):
    source, granter = run(depth, 30, no_pause, lambda: True, lambda: True)
    assert source.taken == list(range(30))
    assert granter.clocks == [clock + FragmentQueue.latency for clock in source.taken]


def test_bad_sizes():
    rejects(FragmentQueue, "depth", depth=0, shape=SHAPE)
