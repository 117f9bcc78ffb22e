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
    for domain in organisation.domains:
        yield _report(ResponseKind.DOMAIN, first=domain.first, units=domain.units)
    yield _report(ResponseKind.UNITS, owned=organisation.owned_units, total=organisation.units)
    if organisation.refused:
        yield Owed(ResponseKind.ERROR, Fault.UNITS_UNSUPPORTED)
        return
    width, height, *_ = organisation.resolution
    yield _report(ResponseKind.PICTURE, width=width, height=height)
    yield Owed(ResponseKind.BOOTED)


def _report(kind: ResponseKind, **fields: int) -> Owed:
    return Owed(kind, response_value(kind, **fields))


def owed_to(organisation: Organisation, word: int) -> list[Owed]:
    """What answers one command."""
    if organisation.refused:
        return [Owed(ResponseKind.ERROR, Fault.UNITS_UNSUPPORTED)]
    opcode = opcode_of(word)
    if opcode in (Opcode.FRAME_START, Opcode.PREPARED_TRIANGLE) or (
            opcode == Opcode.TRIANGLE and organisation.configuration.setup == "hardware"):
        return []
    if opcode == Opcode.FRAME_END:
        return [Owed(ResponseKind.FRAME_DRAWN), Owed(ResponseKind.FRAME_SHOWN)]
    if opcode == Opcode.READ_DEPTH:
        return [Owed(ResponseKind.DEPTH)] * organisation.depths_read_back
    if opcode == Opcode.READ_COUNTERS:
        return [Owed(ResponseKind.FRAGMENTS),
                Owed(ResponseKind.BUSY)] * len(organisation.domains)
    return [Owed(ResponseKind.ERROR, Fault.UNKNOWN_COMMAND)]


def responses_owed(organisation: Organisation, words: Sequence[int]) -> int:
    """How many come in all, the boot's included."""
    opcodes = Counter(opcode_of(word) for word in words)
    return len(owed_at_boot(organisation)) + sum(
        count * len(owed_to(organisation, opcode)) for opcode, count in opcodes.items())
