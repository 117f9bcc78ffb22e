"""A processing element and its memory units as one component."""

from collections.abc import Callable
from functools import reduce
from operator import and_, or_
from typing import Any

from amaranth.hdl import Module
from amaranth.lib import wiring
from amaranth.lib.wiring import In, Out

from ...golden.organisations.organisation_of import organisation_of
from ...golden.specification.configuration import MachineConfiguration
from ...hdl.backplane.connectors import BroadcastLines, Connector, PictureLines, ScanLines
from ...hdl.memory_unit.memory_unit import MemoryUnit
from ...hdl.processing_element.processing_element import ProcessingElement

__all__ = ["Domain"]


class Domain(wiring.Component):
    """The first processing element of a cage and the memory units that it owns (figure 12).

    Only connections, as in ``hdl.machine``; what runs beyond these boards are ports.

    Members
    -------
    left: In(Connector), right: Out(Connector)
    total: In(id_bits)
        Number of memory units in the cage.
    broadcast: In(BroadcastLines)
    scan: In(ScanLines)
        For all units; ``video`` is the or of theirs.
    pictures: In(PictureLines)
        For all units; ``swept`` is the and of theirs.
    """

    def __init__(self, *, configuration: MachineConfiguration):
        self.configuration = configuration
        self.element = ProcessingElement(configuration=configuration)
        units = organisation_of(configuration).domains[0].units
        self.units = [MemoryUnit(configuration=configuration) for _ in range(units)]
        super().__init__({
            "left": In(Connector(configuration)),
            "right": Out(Connector(configuration)),
            "total": In(configuration.id_bits),
            "broadcast": In(BroadcastLines(configuration)),
            "scan": In(ScanLines(configuration)),
            "pictures": In(PictureLines(configuration)),
        })

    def elaborate(self, platform: Any) -> Module:
        m = Module()
        m.submodules.processing_element = self.element
        for number, unit in enumerate(self.units):
            m.submodules[f"memory_unit_{number}"] = unit
        left = wiring.flipped(self.left)
        cards: tuple[ProcessingElement | MemoryUnit, ...] = (self.element, *self.units)
        for card in cards:
            wiring.connect(m, left, card.left)
            m.d.comb += card.total.eq(self.total)
            left = card.right
        wiring.connect(m, left, wiring.flipped(self.right))
        wiring.connect(m, wiring.flipped(self.broadcast), self.element.broadcast)
        self._to_all_units(m, "scan", or_)
        self._to_all_units(m, "pictures", and_)
        return m

    def _to_all_units(self, m: Module, name: str, wired: Callable[[Any, Any], Any]) -> None:
        """Each unit hears what the lines ``name`` say, and their answers are ``wired``."""
        ends = [list(end.signature.flatten(end))
                for end in (getattr(card, name) for card in (self, *self.units))]
        for (_, member, line), *of_units in zip(*ends, strict=True):
            if member.flow == In:
                m.d.comb += [heard.eq(line) for _, _, heard in of_units]
            else:
                m.d.comb += line.eq(reduce(wired, (said for _, _, said in of_units)))
