"""What a machine owes its host: the responses at boot and to each command, in order."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Sequence
from typing import NamedTuple

from ...golden.organisations.organisation import Organisation
from ...golden.specification.commands import (
    Fault,
    Opcode,
    ResponseKind,
    opcode_of,
    response_value,
)


class Owed(NamedTuple):
    """A response, with its value where docs/command-words.md fixes it."""

    kind: ResponseKind
    value: int | None = None


def owed_at_boot(organisation: Organisation) -> list[Owed]:
    """What a cage reports before it takes a command; a refused cage ends with ``ERROR``."""
    return list(_boot(organisation))


def _boot(organisation: Organisation) -> Iterator[Owed]:
    for number, node in enumerate(organisation.each):
        for domain in node.domains:
            yield _report(ResponseKind.DOMAIN, first=domain.first, units=domain.units)
        if organisation.merges:
            yield _report(ResponseKind.NODE, node=number, units=node.units)
    yield _report(ResponseKind.UNITS, owned=organisation.owned_units,
                  total=sum(organisation.node_units))
    if organisation.merges:
        yield _report(ResponseKind.NODES, nodes=organisation.nodes)
    if organisation.fault is not None:
        yield Owed(ResponseKind.ERROR, organisation.fault)
        return
    width, height, *_ = organisation.resolution
    yield _report(ResponseKind.PICTURE, width=width, height=height)
    yield Owed(ResponseKind.BOOTED)


def _report(kind: ResponseKind, **fields: int) -> Owed:
    return Owed(kind, response_value(kind, **fields))


def owed_to(organisation: Organisation, word: int) -> list[Owed]:
    """What answers one command."""
    if organisation.fault is not None:
        return [Owed(ResponseKind.ERROR, organisation.fault)]
    opcode = opcode_of(word)
    if opcode in _silent(organisation):
        return []
    if opcode == Opcode.FRAME_END:
        merged = [Owed(ResponseKind.MERGED)] if organisation.merges else []
        return [Owed(ResponseKind.FRAME_DRAWN), *merged, Owed(ResponseKind.FRAME_SHOWN)]
    if opcode == Opcode.READ_DEPTH:
        return [Owed(ResponseKind.DEPTH)] * organisation.depths_read_back
    if opcode == Opcode.READ_COUNTERS:
        return _counters(organisation)
    return [Owed(ResponseKind.ERROR, Fault.UNKNOWN_COMMAND)]


def _silent(organisation: Organisation) -> list[Opcode]:
    """Commands that nothing answers."""
    configuration = organisation.configuration
    silent = [Opcode.FRAME_START, Opcode.PREPARED_TRIANGLE]
    if configuration.setup == "hardware":
        silent.append(Opcode.TRIANGLE)
    if configuration.list_words:
        silent += [Opcode.LOAD, Opcode.DRAW_LISTS, Opcode.CLEAR_LISTS]
    return silent


def _counters(organisation: Organisation) -> list[Owed]:
    """From left to right: of each processing element, and of each node that is merged."""
    owed = []
    for node in organisation.each:
        owed += [Owed(ResponseKind.FRAGMENTS), Owed(ResponseKind.BUSY)] * len(node.domains)
        owed += [Owed(ResponseKind.SENT)] * organisation.merges
    return owed


def responses_owed(organisation: Organisation, words: Sequence[int]) -> int:
    """How many come in all, the boot's included."""
    opcodes = Counter(opcode_of(word) for word in words)
    return len(owed_at_boot(organisation)) + sum(
        count * len(owed_to(organisation, opcode)) for opcode, count in opcodes.items())
