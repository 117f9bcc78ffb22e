"""What of the broadcast is for a node that makes triangles of objects."""

from amaranth.hdl import *
from amaranth.lib.wiring import In, Out

from ...golden.specification.commands import RESPONSE_VALUE_BITS
from ...golden.specification.configuration import MachineConfiguration
from ..backplane.connectors import BroadcastLines
from ..backplane.words import ObjectOperation, Operation
from ..objects.object_setup import ObjectSetup
from .node_gate import NodeGate

__all__ = ["ObjectGate", "node_gate"]


class ObjectGate(NodeGate):
    """A ``NodeGate`` that keeps meshes and has a set-up of its own, behind the share filter.

    Objects and vertices say which node draws them; they wait in this one's queue, and hold up the
    broadcast only when that is full.  What is for other nodes passes in any case.  Meshes are for
    all nodes.  Everything else waits until all that was to be made is made and has gone on.

    Latency: ``ObjectSetup.latency`` from the strobe of an object to that of its first triangle.
    Throughput: that of ``TriangleSetup``.

    Members
    -------
    number, broadcast, own
        As of ``NodeGate``.
    total: In(id_bits)
        Memory units of the node.
    lists_full: Out(1)
        A mesh found no room since all were cleared.
    made, dropped: Out(RESPONSE_VALUE_BITS)
        Counts of ``ObjectSetup`` since the frame's start.

    Blazek 1991, chapter V, node initiated decomposition.
    """

    def __init__(self, *, configuration: MachineConfiguration):
        self.setup = ObjectSetup(configuration=configuration)
        super().__init__(configuration=configuration)

    @property
    def members(self):
        return {"total": In(self.configuration.id_bits), "lists_full": Out(1),
                **{name: Out(RESPONSE_VALUE_BITS) for name in ("made", "dropped")}}

    @property
    def storages(self):
        """The RAMs of the meshes."""
        return self.setup.storages

    def elaborate(self, platform):
        m = Module()
        m.submodules.setup = setup = self.setup
        broadcast, own, packet = self.broadcast, self.own, self.broadcast.packet
        makes, elsewhere = Signal(), Signal()
        settle = Signal(range(BroadcastLines.settle_clocks + 1))
        m.d.comb += [
            makes.eq(packet.operation == Operation.MAKE),
            elsewhere.eq(self._is_elsewhere(makes)),
            setup.total.eq(self.total),
            setup.words.valid.eq(broadcast.strobe & makes & ~elsewhere),
            setup.words.payload.eq(packet.body.make),
            setup.triangles.ready.eq(own.ready),
            setup.start.eq(broadcast.strobe & (packet.operation == Operation.FRAME_START)),
            own.packet.eq(packet),
            own.strobe.eq(broadcast.strobe & ~makes & ~elsewhere & self._reads),
            broadcast.ready.eq(elsewhere | Mux(makes, setup.words.ready, own.ready & ~setup.busy)),
            broadcast.done.eq(own.done & ~setup.busy & (settle == 0)),
            self.lists_full.eq(setup.full),
            self.made.eq(setup.made),
            self.dropped.eq(setup.dropped),
        ]
        with m.If(setup.triangles.valid):
            m.d.comb += [
                own.strobe.eq(own.ready),
                own.packet.operation.eq(Operation.DRAW),
                own.packet.body.draw.eq(setup.triangles.payload),
            ]
        # The last triangle is not yet known to be under way.
        with m.If(setup.busy):
            m.d.sync += settle.eq(BroadcastLines.settle_clocks)
        with m.Elif(settle != 0):
            m.d.sync += settle.eq(settle - 1)
        return m

    def _is_elsewhere(self, makes):
        """A triangle or an object is for another node."""
        packet = self.broadcast.packet
        said, found = packet.body.make, C(0)
        for operation, told in ((ObjectOperation.OBJECT, said.body.object),
                                (ObjectOperation.TRIANGLE, said.body.triangle)):
            found |= (said.operation == operation) & (told.node != self.number)
        drawn = (packet.operation == Operation.DRAW) & (packet.body.draw.node != self.number)
        return drawn | (makes & found)


def node_gate(configuration: MachineConfiguration) -> NodeGate:
    """What a merge card has."""
    gate = ObjectGate if configuration.objects == "nodes" else NodeGate
    return gate(configuration=configuration)
