"""The cards of a cage in groups, for the drawing of it."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from itertools import count

from ...golden.organisations.organisation_of import organisation_of
from ...golden.specification.card_order import (
    FRAME_UNIT,
    MEMORY_UNIT,
    MERGE_CARDS,
    PROCESSING_ELEMENT,
)
from ...golden.specification.configuration import MachineConfiguration


@dataclass(frozen=True)
class CardGroup:
    """Neighbouring cards that belong together.

    ``cards``    letter and number of each, left to right
    ``caption``  what there is to say of them
    """

    cards: tuple[tuple[str, int], ...]
    caption: str

    @property
    def styles(self) -> list[str]:
        """The style of each card on the page."""
        return ["element" if letter == PROCESSING_ELEMENT else "merge" if letter in MERGE_CARDS
                else "memory" for letter, _ in self.cards]


def card_groups(configuration: MachineConfiguration) -> list[CardGroup]:
    """The cage from left to right."""
    if configuration.merges_directly:
        return list(_direct(configuration))
    return list(_nodes(configuration))


def _nodes(configuration: MachineConfiguration) -> Iterator[CardGroup]:
    organisation = organisation_of(configuration)
    elements = count()
    for number, node in enumerate(organisation.each):
        orphans = node.domains[0].first if node.domains else node.units
        if orphans:
            yield CardGroup(_numbered(MEMORY_UNIT, range(orphans)), "owned by nobody")
        for domain in node.domains:
            units = range(domain.first, domain.first + domain.units)
            yield CardGroup(((PROCESSING_ELEMENT, next(elements)),
                             *_numbered(MEMORY_UNIT, units)), f"owns {_called(units)}")
        if configuration.merge is not None:
            yield CardGroup(((configuration.merge, number),), f"ends node {number}")
    if configuration.snoops:
        yield CardGroup(_numbered(FRAME_UNIT, range(configuration.frame_units)),
                        "keep the merged picture")


def _direct(configuration: MachineConfiguration) -> Iterator[CardGroup]:
    assert configuration.merge is not None
    for number in range(configuration.nodes):
        yield CardGroup(((PROCESSING_ELEMENT, number),), f"node {number}")
    yield CardGroup(((configuration.merge, 0),
                     *_numbered(MEMORY_UNIT, range(configuration.units))), "of all elements")


def _numbered(letter: str, numbers: Iterable[int]) -> tuple[tuple[str, int], ...]:
    return tuple((letter, number) for number in numbers)


def _called(units: range) -> str:
    if not units:
        return "none"
    return str(units[0]) if len(units) == 1 else f"{units[0]} to {units[-1]}"
