"""A processing element without pixels: fragments of its own triangles, all over the screen."""

import random
from collections import Counter
from dataclasses import replace

import numpy as np
import pytest
from hdl_bench.bench import Agent, Drive, simulate
from hdl_bench.pictures import (
    exact_words,
    prepare,
    prepared_values,
    random_triangles,
    small_machine,
)
from hdl_bench.streams import Sink, no_pause, pauses

from cardcage.golden.reference.triangle_setup import scene_fraction_bits
from cardcage.golden.specification.commands import ResponseKind, response_value
from cardcage.golden.specification.display_list import DisplayList
from cardcage.hdl.backplane.connectors import BroadcastLines
from cardcage.hdl.backplane.words import Operation
from cardcage.hdl.direct.direct_element import DirectElement

NUMBER = 2


class Announcer(Agent):
    """Strobes packets while the card is ready; all but triangles when it is done."""

    def __init__(self, dut, packets, pause):
        self.dut, self.packets, self.pause = dut, list(packets), pause
        self.wait, self.clock, self.strobes, self.done = 0, 0, [], False

    @property
    def finished(self):
        return not self.packets and self.done

    def drive(self, ctx):
        lines = self.dut.broadcast
        self.wait = max(0, self.wait - 1)
        settled = not self.strobes or self.clock > self.strobes[-1] + BroadcastLines.settle_clocks
        self.done = settled and bool(ctx.get(lines.done))
        strobe = False
        if self.packets and not self.wait:
            ctx.set(lines.packet, self.packets[0])
            drawn = self.packets[0]["operation"] in (Operation.DRAW, Operation.LOAD)
            strobe = bool(ctx.get(lines.ready)) and (drawn or self.done)
        ctx.set(lines.strobe, strobe)
        if strobe:
            self.packets.pop(0)
            self.strobes.append(self.clock)
            self.wait = self.pause()

    def sample(self, ctx):
        self.clock += 1


def run(seed, listed, *, retained=False, pause=no_pause, takes=no_pause):
    """Draws a list of which every third triangle is this node's."""
    pick = random.Random(f"element {seed}")
    configuration = small_machine(
        "PPPPDMMMM", 9, 7, order_bits=5, list_words=8 if retained else 0,
        fraction_bits=scene_fraction_bits(listed))
    values = prepared_values(configuration, prepare(configuration, listed))
    nodes = [NUMBER if place % 3 == 0 else pick.choice((0, 1, 3)) for place in range(len(values))]
    rounds = [pick.randrange(8) for _ in values]
    operation = Operation.LOAD if retained else Operation.DRAW
    triangles = [{"operation": operation, "body": {"draw": {
        **value, "planes": value["planes"] | {"round": turn}, "node": node}}}
        for value, node, turn in zip(values, nodes, rounds, strict=True)]
    told = [{"operation": each} for each in (
        Operation.FRAME_START, *[Operation.DRAW_LISTS] * retained, Operation.READ_DEPTH,
        Operation.READ_COUNTERS)]
    start, *rest = told
    packets = [{"operation": Operation.SURVEY},
               *([*triangles, start] if retained else [start, *triangles]), *rest]
    dut = DirectElement(configuration=configuration)
    announcer = Announcer(dut, packets, pause)
    expected = drawn(configuration, listed, nodes, rounds)
    fragments = Sink(dut.fragments, len(expected), takes)
    responses = Sink(dut.left.response, 3, pause)

    def lines(ctx, clock):
        ctx.set(dut.left.node, NUMBER)
        ctx.set(dut.left.id, 0)
        ctx.set(dut.total, configuration.units)
        assert (ctx.get(dut.right.node), ctx.get(dut.right.id)) == (NUMBER + 1, 0)

    simulate(dut, Drive(lines), announcer, fragments, responses, after=3)
    assert Counter((item.unit, item.address, item.depth) for item in fragments.items) == expected
    node, counted, busy = [(item.kind, item.value) for item in responses.items]
    assert node == (ResponseKind.NODE, response_value(ResponseKind.NODE, node=NUMBER, units=4))
    assert counted == (ResponseKind.FRAGMENTS, expected.total())
    assert busy[0] == ResponseKind.BUSY and busy[1] >= expected.total()
    return dut, announcer, fragments


def drawn(configuration, listed, nodes, rounds):
    """How often each (unit, address, rank) is to come, triangle by triangle."""
    interlace = configuration.interlace
    found = Counter()
    for place, primitive in enumerate(prepare(configuration, listed).primitive):
        if nodes[place] == NUMBER:
            here = slice(primitive, primitive + 1)
            words, _ = exact_words(replace(
                listed, position=listed.position[here], depth=listed.depth[here],
                color=listed.color[here]), interlace, flat=True)
            order = rounds[place] << configuration.node_order_bits | NUMBER
            found.update((interlace.unit(x, y), interlace.address(x, y),
                          depth << configuration.order_bits | order)
                         for (x, y), (depth, _) in words.items())
    return found


@pytest.mark.parametrize("retained", [False, True])
@pytest.mark.parametrize("seed", range(3))
def test_random_triangles(seed, retained):
    listed = random_triangles(seed, 12, width=9, height=7, flat=True)
    run(seed, listed, retained=retained, pause=pauses(seed), takes=pauses(f"takes {seed}"))


def test_latency_and_throughput():
    """Two triangles that cover the screen: a fragment a clock, ``latency`` after the strobe."""
    screen = np.array([[[-8, -8], [80, -8], [-8, 80]]] * 2, np.int32)
    listed = DisplayList(width=9, height=7, sub_bits=2, depth_bits=8, position=screen,
                         depth=np.full((2, 3), 9), color=np.zeros((2, 3, 3), np.uint8))
    dut, announcer, fragments = run(2, listed)
    strobe = announcer.strobes[2]
    count = len(fragments.clocks)
    assert count in (63, 126)
    assert fragments.clocks == list(range(strobe + dut.latency, strobe + dut.latency + count))
