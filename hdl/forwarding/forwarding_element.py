"""The processing element that makes triangles of objects, and passes these on to its neighbours."""

from itertools import pairwise

from amaranth.hdl import *
from amaranth.lib import memory, stream, wiring
from amaranth.lib.wiring import In, Out

from ...golden.specification.configuration import MachineConfiguration
from ..processing_element.processing_element import ProcessingElement
from ..wires import wires
from .element_gate import ElementGate
from .reach import object_bits, reaching_object_layout

__all__ = ["ForwardingElement", "connect_forwarding"]


class ForwardingElement(ProcessingElement):
    """Draws its run of regions, of all objects that come to it: those that the host gives it, and
    those that a neighbour has passed on.

    ::

        broadcast ─▶ ElementGate ─▶ as of ProcessingElement
                      ▲ │   │ ▲
        from, to left │ ▼   ▼ │ from, to right

    Objects come in any order, so every pixel keeps its object's number below its depth, and the
    depth test compares both.

    Besides the members of ``ProcessingElement`` it has these.

    Members
    -------
    from_left, from_right: In(stream of reaching_object_layout)
    to_left, to_right: Out(stream of reaching_object_layout)
        Objects of the neighbouring processing elements (``ObjectForwarder``).
    lists_full: Out(1)
        A mesh found no room since all were cleared.

    Blazek 1991, chapter V, node initiated with object forwarding.
    """

    def __init__(self, *, configuration: MachineConfiguration):
        self.gate = ElementGate(configuration=configuration)
        self._configuration = configuration
        super().__init__(configuration=configuration)

    @property
    def members(self):
        configuration = self._configuration
        passed = stream.Signature(reaching_object_layout(configuration,
                                                         object_bits(configuration)))
        return {"from_left": In(passed), "from_right": In(passed),
                "to_left": Out(passed), "to_right": Out(passed), "lists_full": Out(1)}

    @property
    def storages(self) -> list[memory.Memory]:
        """The RAMs of the meshes."""
        return self.gate.storages

    @property
    def _heard(self):
        return self.gate.own

    def elaborate(self, platform):
        m = super().elaborate(platform)
        m.submodules.gate = gate = self.gate
        part = wires(m, "gate_wires")
        wiring.connect(part, wiring.flipped(self.broadcast), gate.broadcast)
        wiring.connect(part, wiring.flipped(self.regions), gate.regions)
        for name in ("from_left", "from_right", "to_left", "to_right"):
            wiring.connect(part, wiring.flipped(getattr(self, name)), getattr(gate, name))
        control = self._control
        part.d.comb += [
            gate.total.eq(self.total),
            gate.element.eq(self.left.id >> self.configuration.share_bits),
            self.lists_full.eq(gate.full),
            *(getattr(control, name).eq(getattr(gate, name))
              for name in ("made", "dropped", "forwarded")),
        ]
        return m


def connect_forwarding(m: Module, elements: list[ForwardingElement]) -> None:
    """The channels between neighbours; beyond the first element and the last one there is
    nobody."""
    for number, (one, other) in enumerate(pairwise(elements)):
        part = wires(m, f"channel_{number}_wires")
        wiring.connect(part, one.to_right, other.from_left)
        wiring.connect(part, other.to_left, one.from_right)
