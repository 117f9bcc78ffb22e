"""Processing elements without pixels of their own: each fragment goes to the unit of its pixel."""

from __future__ import annotations

from dataclasses import replace
from functools import cached_property

from .host_broadcast import HostBroadcast
from .organisation import Domain, ElementBlock


class DirectElements(HostBroadcast):
    """Each processing element is a node, draws its share of the triangles all over the screen, and
    hands each fragment to the memory unit that has the pixel: one picture, of all (Denali, in Cox
    and Hanrahan 1993, section 4; Fuchs and Johnson 1979, figure 17).  The units interlace
    diagonally."""

    name = "direct"
    merges = True

    @cached_property
    def domains(self) -> tuple[Domain, ...]:
        configuration = self.configuration
        return tuple(Domain(node, 0, configuration.units) for node in range(configuration.nodes))

    @cached_property
    def each(self) -> tuple[HostBroadcast, ...]:
        """Such a cage of one processing element."""
        cards = "PD" + "M" * self.configuration.units
        alone = DirectElements(replace(self.configuration, cards=cards))
        return (alone,) * self.nodes

    @property
    def node_units(self) -> tuple[int, ...]:
        return (self.configuration.units,) * self.configuration.nodes

    @property
    def memory_units(self) -> int:
        """All elements have the same ones."""
        return self.configuration.units

    @property
    def owned_units(self) -> int:
        return self.memory_units

    @property
    def blocks(self) -> tuple[ElementBlock, ...]:
        """The whole screen."""
        units = self.memory_units
        return tuple(ElementBlock(element, 0, 0, 0, 0, 0, 0, False, units, units > 1)
                     for element in range(self.nodes))
