"""What every merge card is, however it merges: the right end of a node."""

from functools import reduce
from operator import or_

from amaranth.hdl import *
from amaranth.lib import wiring
from amaranth.lib.wiring import In, Out

from ...golden.specification.commands import RESPONSE_VALUE_BITS, ResponseKind
from ...golden.specification.configuration import MachineConfiguration
from ..backplane.connectors import BroadcastLines, Connector
from ..backplane.id_increment import IdIncrement
from ..backplane.response_link import ResponseLink
from ..backplane.words import Operation, response_value
from ..wires import wires
from .object_gate import node_gate

__all__ = ["MergeCard"]


class MergeCard(wiring.Component):
    """Ends a node: the ID lines start at 0 again to its right, and the node lines count on.

    So the ID lines that reach it are the number of its node's memory units, which go back to its
    cards.  At boot it reports that number and the node's; with the counters, how many pixels it
    has sent, and how many triangles its gate has made of objects and dropped.  What is for its
    node's processing elements it passes on (``NodeGate``).

    A subclass adds ``members`` and how it merges, in ``merge``, and drives ``sent`` there.

    Members
    -------
    left: In(Connector), right: Out(Connector)
        The neighbouring slots; no memory bus passes.
    broadcast: In(BroadcastLines)
        Lines of the central broadcast controller.
    own: Out(BroadcastLines)
        To the node's processing elements.
    lists_full: Out(1)
        Some triangle found no room in the node's list, or a mesh in its mesh memory; only where
        there is one.
    """

    def __init__(self, *, configuration: MachineConfiguration):
        self.configuration = configuration
        self.gate = node_gate(configuration)
        self.sent = Signal(RESPONSE_VALUE_BITS)
        super().__init__({
            "left": In(Connector(configuration)),
            "right": Out(Connector(configuration)),
            "broadcast": In(BroadcastLines(configuration)),
            "own": Out(BroadcastLines(configuration)),
            **({"lists_full": Out(1)} if configuration.reports_full else {}),
            **self.members,
        })

    @property
    def members(self) -> dict[str, wiring.Member]:
        """Those of the kind of merging."""
        raise NotImplementedError

    def merge(self, m: Module) -> None:
        """Adds the merging to the card's module."""
        raise NotImplementedError

    @property
    def storages(self):
        return self.gate.storages

    def elaborate(self, platform):
        m = Module()
        m.submodules.gate = gate = self.gate
        m.submodules.increment = increment = IdIncrement(bits=self.configuration.node_bits)
        m.submodules.link = link = ResponseLink()
        number = self.left.node
        m.d.comb += [increment.left.eq(number), self.right.node.eq(increment.right),
                     gate.number.eq(number)]
        broadcast = wires(m, "broadcast_wires")
        wiring.connect(broadcast, wiring.flipped(self.own), gate.own)
        broadcast.d.comb += [
            gate.broadcast.strobe.eq(self.broadcast.strobe),
            gate.broadcast.packet.eq(self.broadcast.packet),
            self.broadcast.ready.eq(gate.broadcast.ready),
        ]
        if self.configuration.reports_full:
            m.d.comb += self.lists_full.eq(gate.lists_full)
        if self.configuration.objects is not None:
            m.d.comb += gate.total.eq(self.left.id)
        wiring.connect(m, wiring.flipped(self.right.response), link.right)
        wiring.connect(m, link.left, wiring.flipped(self.left.response))
        reporting = self._report(m, link, number)
        m.d.comb += self.broadcast.done.eq(gate.broadcast.done & ~reporting & ~link.left.valid)
        self.merge(m)
        return m

    def _report(self, m, link, number):
        """Says its own words in its turn; returns that it has some to say."""
        node, sent = Signal(), Signal()
        counts = self._counts_of_objects
        asked = self.broadcast.strobe
        operation, own = self.broadcast.packet.operation, link.own
        with m.If(asked & (operation == Operation.SURVEY)):
            m.d.sync += node.eq(1)
        with m.Elif(asked & (operation == Operation.READ_COUNTERS)):
            m.d.sync += [sent.eq(1), *(waits.eq(1) for waits, *_ in counts)]
        with m.Elif(own.valid & own.ready):
            m.d.sync += [node.eq(0), sent.eq(0)]
            before = node | sent
            for waits, *_ in counts:
                with m.If(~before):
                    m.d.sync += waits.eq(0)
                before |= waits
        m.d.comb += [own.valid.eq(reduce(or_, [node, sent, *(waits for waits, *_ in counts)])),
                     link.own_turn.eq(own.valid)]
        with m.If(node):
            m.d.comb += [own.payload.kind.eq(ResponseKind.NODE),
                         own.payload.value.eq(response_value(
                             ResponseKind.NODE, units=self.left.id, node=number))]
        with m.Elif(sent):
            m.d.comb += [own.payload.kind.eq(ResponseKind.SENT),
                         own.payload.value.eq(self.sent)]
        for waits, kind, count in counts:
            with m.Elif(waits):
                m.d.comb += [own.payload.kind.eq(kind), own.payload.value.eq(count)]
        return own.valid

    @property
    def _counts_of_objects(self):
        """Of each count of its gate, that it waits to be said, its kind and its value."""
        if self.configuration.objects is None:
            return []
        return [(Signal(name="made_waits"), ResponseKind.MADE, self.gate.made),
                (Signal(name="dropped_waits"), ResponseKind.DROPPED, self.gate.dropped)]
