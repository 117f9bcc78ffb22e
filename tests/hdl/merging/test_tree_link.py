"""Nodes in a row that send, receive and pass on, step after step, against Blazek's tree."""

import random
from itertools import pairwise

import pytest
from amaranth.hdl import Module
from amaranth.lib import wiring
from hdl_bench.bench import Agent, Drive, rejects, simulate
from hdl_bench.streams import Sink, Source, no_pause, pauses

from cardcage.golden.merging.tree import tree_pairs
from cardcage.hdl.merging.tree_link import TreeLink

BITS = {"id_bits": 2, "address_bits": 5, "depth_bits": 9}
NODE_BITS = 6


def row_of(nodes):
    """Links from left to right, and a module that has them side by side."""
    m = Module()
    links = [TreeLink(**BITS, node_bits=NODE_BITS) for _ in range(nodes)]
    for number, link in enumerate(links):
        m.submodules[f"link_{number}"] = link
        m.d.comb += [link.number.eq(number), link.nodes.eq(nodes)]
    for left, right in pairwise(links):
        wiring.connect(m, right.left, left.right)
    return m, links


class Words(Source):
    """A node's list, which begins when the node sends; as one that has nothing before."""

    def __init__(self, link, items, pause):
        super().__init__(link.own, items, pause)
        self.link = link
        self.begun = None

    def drive(self, ctx):
        if self.begun is None and ctx.get(self.link.sends) and ctx.get(self.link.lines.start):
            self.begun = self._clock + 1
        if self.begun is not None and self._clock >= self.begun:
            super().drive(ctx)

    @property
    def finished(self):
        return self.begun is None or super().finished


class Step(Agent):
    """One step: starts it, and waits until nobody is busy; ``clocks`` later."""

    START = 2

    def __init__(self, links, step):
        self.links, self.step = links, step
        self.clock = 0
        self.finished = False

    def drive(self, ctx):
        for link in self.links:
            ctx.set(link.lines.step, self.step)
            ctx.set(link.lines.start, self.clock == self.START)

    def sample(self, ctx):
        busy = [ctx.get(link.lines.busy) for link in self.links]
        assert not any(busy) or self.clock > self.START
        if self.clock == self.START + 1:
            self.busy = busy
        if self.clock > self.START + 1 and not any(busy) and not self.finished:
            self.finished = True
            self.clocks = self.clock - self.START
        self.clock += 1


def words(pixels):
    return [*({"pixel": pixel, "last": 0} for pixel in pixels),
            {"pixel": dict.fromkeys(("unit", "address", "depth", "color"), 0), "last": 1}]


def run(nodes, step, lists, pause=lambda name: no_pause):
    """Everything each node receives, the sinks, and the clocks from ``start`` to the end."""
    m, links = row_of(nodes)
    sources = [Words(link, words(pixels), pause(f"from {number}"))
               for number, (link, pixels) in enumerate(zip(links, lists, strict=True))]
    sinks = [Sink(link.received, 0, pause(f"to {number}")) for number, link in enumerate(links)]
    agent = Step(links, step)

    def ends(ctx, clock):
        """Nobody takes what the leftmost one passes on, and nothing comes from the right."""
        assert not ctx.get(links[0].left.valid)
        ctx.set(links[0].left.ready, clock % 2)

    simulate(m, agent, *sources, *sinks, Drive(ends), after=3)
    pairs = [(sender, receiver) for at, sender, receiver in tree_pairs(nodes) if at == step]
    assert agent.busy == [number in [receiver for _, receiver in pairs] for number in range(nodes)]
    expected = [[] for _ in range(nodes)]
    for sender, receiver in pairs:
        expected[receiver] = lists[sender]
    for sink, pixels in zip(sinks, expected, strict=True):
        assert [{name: getattr(item, name) for name in ("unit", "address", "depth", "color")}
                for item in sink.items] == pixels
    return sinks, agent.clocks, pairs


def random_lists(pick, nodes, count):
    return [[{"unit": pick.getrandbits(2), "address": pick.getrandbits(5),
              "depth": pick.getrandbits(9), "color": pick.getrandbits(24)}
             for _ in range(count())] for _ in range(nodes)]


@pytest.mark.parametrize("nodes", [1, 2, 3, 5, 8, 13])
def test_every_step_with_pauses(nodes):
    pick = random.Random(f"tree {nodes}")
    for step in range(max(1, (nodes - 1).bit_length())):
        lists = random_lists(pick, nodes, lambda: pick.choice((0, 1, 2, 30)))
        run(nodes, step, lists, lambda name, step=step: pauses(f"{nodes} {step} {name}"))


@pytest.mark.parametrize("nodes", [2, 5, 32])
def test_a_word_a_clock_and_a_clock_a_node(nodes):
    pick = random.Random(f"quick {nodes}")
    for step in range((nodes - 1).bit_length()):
        sinks, clocks, pairs = run(nodes, step, random_lists(pick, nodes, lambda: 20))
        for sender, receiver in pairs:
            arrived = sinks[receiver].clocks
            # The sender offers its first word in the clock after start.
            assert arrived[0] == Step.START + 1 + (sender - receiver + 1) * TreeLink.latency
            assert arrived[-1] - arrived[0] == 19
        # One for the last word, which is no pixel, and one until nobody is busy.
        assert clocks == 1 + ((1 << step) + 1) * TreeLink.latency + 20 + 1


@pytest.mark.parametrize("name", ["depth_bits", "id_bits", "address_bits", "node_bits"])
def test_bad_sizes(name):
    rejects(TreeLink, name, **BITS | {"node_bits": 3} | {name: 0})
