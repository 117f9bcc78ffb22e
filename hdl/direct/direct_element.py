"""The processing element that keeps no pixels: its fragments go to memory units it does not own."""

from amaranth.hdl import *
from amaranth.lib import memory, stream, wiring
from amaranth.lib.wiring import In, Out

from ...golden.specification.configuration import MachineConfiguration
from ..backplane.connectors import BroadcastLines, Connector, memory_bus_bits
from ..backplane.id_increment import IdIncrement
from ..nodes.node_gate import NodeGate
from ..processing_element.drawing_element import DrawingElement
from ..rasteriser.interpolator import fragment_layout
from ..wires import wires
from .element_control import DirectElementControl

__all__ = ["DirectElement"]


class DirectElement(DrawingElement):
    """A node by itself, which draws any pixel of its share of the triangles.

    ::

        broadcast ─▶ NodeGate ─▶ queue ─▶ TriangleSpans ─▶ FIFO ─▶ FragmentStepper ─▶ Interpolator
                                   │                                                      │
                                   └─▶ control ─▶ response link            fragments to the direct
                                                                           merge, on its own lines

    A fragment has depth, round and node in its rank, so that whoever gets it knows which of two
    comes first, in whatever order they come.

    Latency: from a triangle's strobe to its first fragment ``latency`` clocks.  Throughput: a
    fragment a clock while they are taken.

    Members
    -------
    left: In(Connector), right: Out(Connector)
        The neighbouring slots; the node lines count on, the ID lines pass.
    total: In(id_bits)
        Number of memory units in the cage.
    broadcast: In(BroadcastLines)
    lists_full: Out(1)
        Some triangle found no room in the node's list; only with a list memory.
    fragments: Out(stream of fragment_layout)
        To the direct merge.
    activity: Out(4)
        What it does in this clock; only where the configuration says ``observe``.

    Denali, in Cox & Hanrahan 1993, section 4.
    """

    latency = DrawingElement.drawing_latency

    def __init__(self, *, configuration: MachineConfiguration):
        self.gate = NodeGate(configuration=configuration)
        self._control = DirectElementControl(id_bits=configuration.id_bits,
                                             node_bits=configuration.node_bits)
        super().__init__({
            "left": In(Connector(configuration)),
            "right": Out(Connector(configuration)),
            "total": In(configuration.id_bits),
            "broadcast": In(BroadcastLines(configuration)),
            **({"lists_full": Out(1)} if configuration.list_words else {}),
            "fragments": Out(stream.Signature(
                fragment_layout(**memory_bus_bits(configuration)))),
        }, configuration=configuration)

    @property
    def storages(self) -> list[memory.Memory]:
        """The RAM of the node's list, if there is one."""
        return self.gate.storages

    def elaborate(self, platform):
        m = Module()
        m.submodules.gate = self.gate
        self._add_pipeline(m)
        m.submodules.link = self._link
        m.submodules.picture = self._picture
        self._connect_gate(wires(m, "gate_wires"))
        self._connect_broadcast(wires(m, "operation_wires"), self.gate.own)
        drawing = wires(m, "drawing_wires")
        self._connect_drawing(m, drawing)
        wiring.connect(drawing, self._interpolator.fragments, wiring.flipped(self.fragments))
        self._connect_domain(m, wires(m, "domain_wires"))
        self._count(m, self.fragments, self._control.drawing)
        if self.configuration.observe:
            self._observe(m, self.fragments, C(0))
        self._connect_responses(wires(m, "response_wires"), self.gate.own)
        return m

    def _connect_gate(self, m):
        wiring.connect(m, wiring.flipped(self.broadcast), self.gate.broadcast)
        m.d.comb += self.gate.number.eq(self.left.node)
        if self.configuration.list_words:
            m.d.comb += self.lists_full.eq(self.gate.lists_full)

    def _connect_domain(self, m, part):
        """All units, and so all pixels."""
        m.submodules.increment = increment = IdIncrement(bits=self.configuration.node_bits)
        rasteriser, interpolator, picture = self._rasteriser, self._interpolator, self._picture
        control, number, total = self._control, self.left.node, self.total
        m.d.comb += [increment.left.eq(number), self.right.node.eq(increment.right),
                     self.right.id.eq(self.left.id)]
        part.d.comb += [
            rasteriser.end.eq(total),
            rasteriser.width.eq(picture.width),
            control.node.eq(number),
            *(each.total.eq(total) for each in (rasteriser, interpolator, picture, control)),
        ]
        if "node" in interpolator.signature.members:
            part.d.comb += interpolator.node.eq(number)
