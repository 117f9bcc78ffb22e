"""A row of element gates, told by a controller in software, with queues in software behind them."""

import random

from amaranth.hdl import Module, Value
from amaranth.lib import wiring
from amaranth.lib.wiring import In, Out
from hdl_bench.bench import Agent
from object_bench.objects import object_word

from cardcage.golden.specification import commands
from cardcage.golden.specification.commands import ResponseKind
from cardcage.hdl.backplane.connectors import BroadcastLines
from cardcage.hdl.backplane.region_lines import RegionLines
from cardcage.hdl.backplane.words import Operation
from cardcage.hdl.forwarding.element_gate import ElementGate
from cardcage.hdl.forwarding.forwarding_element import connect_forwarding
from cardcage.hdl.lines_to_all import connect_broadcast, connect_regions


class GateRow(wiring.Component):
    """Gates with channels between neighbours, on the same broadcast and the same region lines."""

    def __init__(self, configuration):
        self.configuration = configuration
        self.gates = [ElementGate(configuration=configuration)
                      for _ in range(configuration.processing_elements)]
        super().__init__({
            "regions": In(RegionLines(configuration)),
            "broadcast": In(BroadcastLines(configuration)),
            "own": Out(BroadcastLines(configuration)).array(len(self.gates)),
        })

    def elaborate(self, platform):
        m = Module()
        broadcast, regions = Module(), Module()
        m.submodules.broadcast, m.submodules.regions = broadcast, regions
        connect_broadcast(broadcast, self.broadcast, [gate.broadcast for gate in self.gates])
        connect_regions(regions, self.regions, [gate.regions for gate in self.gates])
        for number, gate in enumerate(self.gates):
            m.submodules[f"gate_{number}"] = gate
            wiring.connect(m, gate.own, wiring.flipped(self.own[number]))
            m.d.comb += [gate.total.eq(self.configuration.units), gate.element.eq(number)]
        connect_forwarding(m, self.gates)
        return m


class ElementQueue(Agent):
    """Takes what an element is told, at random, and works a while; ``drawn`` are bodies of
    triangles as numbers, ``operations`` the rest."""

    def __init__(self, own, seed, slow=False):
        self._own, self._pick = own, random.Random(f"queue {seed}")
        self._slow = slow
        self._work = 0
        self.drawn, self.operations = [], []

    def drive(self, ctx):
        ctx.set(self._own.ready, self._pick.random() < (0.1 if self._slow else 0.7))
        ctx.set(self._own.done, self._work == 0)

    def sample(self, ctx):
        self._work = max(0, self._work - 1)
        if not ctx.get(self._own.strobe):
            return
        assert ctx.get(self._own.ready)
        self._work = self._pick.randrange(1, 6)
        operation = ctx.get(self._own.packet.operation)
        if operation == Operation.DRAW:
            self.drawn.append(ctx.get(Value.cast(self._own.packet.body.draw)))
        else:
            self.operations.append(operation)


class GateController(Agent):
    """Says commands one after another, each as soon as all are ready; ``None``: waits until all is
    done, and then calls the function that follows."""

    def __init__(self, row, words, seed=None):
        self._row, self._words = row, list(words)
        self._pick = random.Random(f"controller {seed}")
        self._wait, self._settle, self._steady = 0, 0, seed is None
        self.made = []

    @property
    def finished(self):
        return not self._words

    def drive(self, ctx):
        lines = self._row.broadcast
        ctx.set(lines.strobe, 0)
        ctx.set(Value.cast(lines.packet), 0)
        if self._settle or self._wait or not self._words:
            self._wait = max(0, self._wait - 1)
            return
        word = self._words[0]
        if word is None:
            if ctx.get(lines.done):
                self._words.pop(0)
                self._words.pop(0)(ctx)
            return
        if isinstance(word, Operation):
            ctx.set(lines.packet.operation, word)
        else:
            ctx.set(lines.packet.operation, Operation.MAKE)
            ctx.set(Value.cast(lines.packet.body.make), object_word(word))
        if ctx.get(lines.ready):
            ctx.set(lines.strobe, 1)
            self._words.pop(0)
            self._settle = BroadcastLines.settle_clocks + 1
            self._wait = 0 if self._steady else self._pick.choice((0, 0, 0, 1, 7))

    def sample(self, ctx):
        following = self._words and self._words[0] is not None
        self._settle = 0 if following else max(0, self._settle - 1)


def forwarded(gate, ctx):
    """Left, right."""
    fields = commands.response_fields(ResponseKind.FORWARDED, ctx.get(gate.forwarded))
    return fields["left"], fields["right"]
