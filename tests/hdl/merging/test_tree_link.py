"""Nodes in a row that send, receive and pass on, step after step, against Blazek's tree."""

import random
from itertools import pairwise

import pytest
from amaranth.hdl import Fragment, Module
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


class Steps(Agent):
    """All steps, each some clocks after nobody is busy any more.

    Of each step: in which clock it ``started``, which nodes were ``busy`` in the next one, and the
    ``clocks`` until none was.
    """

    def __init__(self, links):
        self.links = links
        self.steps = max(1, (len(links) - 1).bit_length())
        self.clock = self.wait = 0
        self.started, self.busy, self.clocks = [], [], []

    @property
    def finished(self):
        return len(self.clocks) == self.steps

    def drive(self, ctx):
        going = len(self.started) > len(self.clocks)
        begins = not going and not self.finished and self.wait == 2
        if begins:
            self.started.append(self.clock)
        self.wait = 0 if going or begins else self.wait + 1
        for link in self.links:
            ctx.set(link.lines.step, max(0, len(self.started) - 1))
            ctx.set(link.lines.start, begins)

    def sample(self, ctx):
        busy = [ctx.get(link.lines.busy) for link in self.links]
        if len(self.started) == len(self.clocks):
            assert not any(busy)
        elif self.clock > self.started[-1]:
            if len(self.busy) < len(self.started):
                self.busy.append(busy)
            if not any(busy):
                self.clocks.append(self.clock - self.started[-1])
        self.clock += 1


def words(pixels):
    return [*({"pixel": pixel, "last": 0} for pixel in pixels),
            {"pixel": dict.fromkeys(("unit", "address", "depth", "color"), 0), "last": 1}]


def run(nodes, lists, pause=lambda name: no_pause):
    """All steps, and what each node receives in them; the sinks, and the steps."""
    m, links = row_of(nodes)
    sources = [Words(link, words(pixels), pause(f"from {number}"))
               for number, (link, pixels) in enumerate(zip(links, lists, strict=True))]
    sinks = [Sink(link.received, 0, pause(f"to {number}")) for number, link in enumerate(links)]
    steps = Steps(links)

    def ends(ctx, clock):
        """Nobody takes what the leftmost one passes on, and nothing comes from the right."""
        assert not ctx.get(links[0].left.valid)
        ctx.set(links[0].left.ready, clock % 2)

    simulate(m, steps, *sources, *sinks, Drive(ends), after=3)
    pairs = list(tree_pairs(nodes))
    for step, busy in enumerate(steps.busy):
        receivers = [receiver for at, _, receiver in pairs if at == step]
        assert busy == [number in receivers for number in range(nodes)]
    expected = [[] for _ in range(nodes)]
    for _, sender, receiver in pairs:
        expected[receiver] += lists[sender]
    for sink, pixels in zip(sinks, expected, strict=True):
        assert [{name: getattr(item, name) for name in ("unit", "address", "depth", "color")}
                for item in sink.items] == pixels
    return sinks, steps


def random_lists(pick, nodes, count):
    return [[{"unit": pick.getrandbits(2), "address": pick.getrandbits(5),
              "depth": pick.getrandbits(9), "color": pick.getrandbits(24)}
             for _ in range(count())] for _ in range(nodes)]


@pytest.mark.parametrize("nodes", [1, 2, 3, 5, 8, 13])
def test_every_step_with_pauses(nodes):
    pick = random.Random(f"tree {nodes}")
    for seed in range(3):
        lists = random_lists(pick, nodes, lambda: pick.choice((0, 1, 2, 30)))
        run(nodes, lists, lambda name, seed=seed: pauses(f"{nodes} {seed} {name}"))


@pytest.mark.parametrize("count", [0, 1, 20])
@pytest.mark.parametrize("nodes", [2, 5, 32])
def test_a_word_a_clock_and_a_clock_a_node(nodes, count):
    """From the clock after the start, in which each sender offers its first word."""
    sinks, steps = run(nodes, random_lists(random.Random("quick"), nodes, lambda: count))
    clocks = [list(sink.clocks) for sink in sinks]
    for step, sender, receiver in tree_pairs(nodes):
        arrived = [clocks[receiver].pop(0) for _ in range(count)]
        first = steps.started[step] + 1 + (sender - receiver + 1) * TreeLink.latency
        assert arrived == list(range(first, first + count))
    # One for the last word, which is no pixel, and one until nobody is busy.
    assert steps.clocks == [1 + (2**step + 1) * TreeLink.latency + count + 1
                            for step in range(steps.steps)]


def test_the_least_sizes():
    Fragment.get(TreeLink(id_bits=1, address_bits=1, depth_bits=1, node_bits=1), None)


@pytest.mark.parametrize("name", ["depth_bits", "id_bits", "address_bits", "node_bits"])
def test_bad_sizes(name):
    rejects(TreeLink, name, **BITS | {"node_bits": 3} | {name: 0})
