"""What of the broadcast is for a node."""

from amaranth.hdl import *
from amaranth.lib import wiring
from amaranth.lib.wiring import In, Out

from ...golden.specification.commands import list_word_bits
from ...golden.specification.configuration import MachineConfiguration
from ..backplane.connectors import BroadcastLines
from ..backplane.words import Operation
from .list_memory import ListMemory

__all__ = ["NodeGate"]


class NodeGate(wiring.Component):
    """Passes on to a node's processing elements what is for this node, in the same clock.

    Triangles say which node is to draw them; the others neither see them nor hold them up.  Depths
    are read from node 0, where it has the merged picture's.  Everything else is for all nodes.

    With a list memory (``list_words``) triangles that are to be loaded go there, and the node draws
    its own list as soon as it is told to: as all nodes do so at the same time, there are as many
    triangles a clock as nodes.

    Latency: none; ``list_latency`` clocks from the strobe to draw the lists to that of the first
    triangle.  Throughput: a triangle a clock, from the broadcast or from the list.

    Members
    -------
    number: In(node_bits)
        The node's.
    broadcast: In(BroadcastLines)
        The controller's; ``done`` is low while the list is drawn.
    own: Out(BroadcastLines)
        Those of the node's processing elements.
    lists_full: Out(1)
        Some triangle found no room in the list; only with a list memory.

    Cox & Hanrahan 1993, section 1: each processor has a subset of the graphics database.
    """

    list_latency = ListMemory.latency

    def __init__(self, *, configuration: MachineConfiguration):
        self.configuration = configuration
        self._kept = list_word_bits(configuration)
        self._list = (ListMemory(words=configuration.list_words, word_bits=self._kept)
                      if configuration.list_words else None)
        super().__init__({
            "number": In(configuration.node_bits),
            "broadcast": In(BroadcastLines(configuration)),
            "own": Out(BroadcastLines(configuration)),
            **self.members,
        })

    @property
    def members(self) -> dict[str, wiring.Member]:
        """Those that not every gate has."""
        return {"lists_full": Out(1)} if self.configuration.list_words else {}

    @property
    def storages(self):
        """The RAM of the list, if there is one."""
        return [] if self._list is None else [self._list.storage]

    def elaborate(self, platform):
        m = Module()
        broadcast, own, packet = self.broadcast, self.own, self.broadcast.packet
        here = packet.body.draw.node == self.number
        elsewhere = Signal()  # a triangle for another node
        for_elements = Signal()
        m.d.comb += [
            elsewhere.eq(((packet.operation == Operation.DRAW)
                          | (packet.operation == Operation.LOAD)) & ~here),
            for_elements.eq(~elsewhere & self._reads),
            own.strobe.eq(broadcast.strobe & for_elements),
            own.packet.eq(packet),
            broadcast.ready.eq(own.ready | elsewhere),
            broadcast.done.eq(own.done),
        ]
        if self._list is not None:
            self._add_list(m, self._list, here, elsewhere, for_elements)
        return m

    @property
    def _reads(self):
        """Where depths are to be read, this node's are."""
        if self.configuration.snoops:
            return C(1)
        return (self.broadcast.packet.operation != Operation.READ_DEPTH) | (self.number == 0)

    def _add_list(self, m, list_, here, elsewhere, for_elements):
        m.submodules.list = list_
        broadcast, own, packet = self.broadcast, self.own, self.broadcast.packet
        operation = packet.operation
        for_list = Signal()
        # The list is being drawn, or its last triangle is not yet known to be under way.
        drawing = Signal()
        settle = Signal(range(BroadcastLines.settle_clocks + 1))
        m.d.comb += [
            for_list.eq((operation == Operation.LOAD) | (operation == Operation.DRAW_LISTS)
                        | (operation == Operation.CLEAR_LISTS)),
            list_.word.eq(Value.cast(packet.body.draw)[:self._kept]),
            list_.store.eq(broadcast.strobe & here & (operation == Operation.LOAD)),
            list_.start.eq(broadcast.strobe & (operation == Operation.DRAW_LISTS)),
            list_.clear.eq(broadcast.strobe & (operation == Operation.CLEAR_LISTS)),
            self.lists_full.eq(list_.full),
            list_.given.ready.eq(own.ready),
            drawing.eq(list_.giving | (settle != 0)),
            broadcast.ready.eq(elsewhere | ((own.ready | for_list) & ~drawing)),
            broadcast.done.eq(own.done & ~drawing),
        ]
        with m.If(list_.giving):
            m.d.comb += [
                own.strobe.eq(list_.given.valid & own.ready),
                own.packet.operation.eq(Operation.DRAW),
                Value.cast(own.packet.body.draw)[:self._kept].eq(list_.given.payload),
            ]
            m.d.sync += settle.eq(BroadcastLines.settle_clocks)
        with m.Else():
            m.d.comb += own.strobe.eq(broadcast.strobe & for_elements & ~for_list)
            with m.If(settle != 0):
                m.d.sync += settle.eq(settle - 1)
