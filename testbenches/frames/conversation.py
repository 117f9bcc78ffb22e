"""What a machine owes its host: the responses at boot and to each command, in order."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Iterator, Sequence
from typing import NamedTuple

from ...golden.organisations.organisation import Domain, Organisation
from ...golden.specification.commands import (
    Fault,
    Opcode,
    ResponseKind,
    opcode_of,
    response_value,
)
from .heard_meshes import HeardMeshes
from .heard_tables import HeardTables


class Owed(NamedTuple):
    """A response, with its value where docs/command-words.md fixes it."""

    kind: ResponseKind
    value: int | None = None


def owed_at_boot(organisation: Organisation) -> list[Owed]:
    """What a cage reports before it takes a command; a refused cage ends with ``ERROR``."""
    return list(_boot(organisation))


def _boot(organisation: Organisation) -> Iterator[Owed]:
    yield from _cards(organisation)
    yield _report(ResponseKind.UNITS, owned=organisation.owned_units,
                  total=organisation.memory_units)
    if organisation.merges:
        yield _report(ResponseKind.NODES, nodes=organisation.nodes)
    if organisation.configuration.snoops:
        yield _report(ResponseKind.FRAME_UNITS, units=organisation.configuration.frame_units)
    if organisation.fault is not None:
        yield Owed(ResponseKind.ERROR, organisation.fault)
        return
    width, height, *_ = organisation.resolution
    yield _report(ResponseKind.PICTURE, width=width, height=height)
    yield Owed(ResponseKind.BOOTED)


def _cards(organisation: Organisation) -> Iterator[Owed]:
    """From left to right: each element its domain, each merge card its node; where elements have
    all units together they are nodes, and the merge card has the domain."""
    direct = organisation.configuration.merges_directly
    for number, node in enumerate(organisation.each):
        for domain in [] if direct else node.domains:
            yield _domain(domain)
        if organisation.merges:
            yield _report(ResponseKind.NODE, node=number, units=node.units)
    if direct:
        yield _domain(organisation.domains[0])


def _domain(domain: Domain) -> Owed:
    return _report(ResponseKind.DOMAIN, first=domain.first, units=domain.units)


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
    if opcode in (Opcode.READ_REGIONS, Opcode.READ_TABLE):
        return _of_regions(organisation, Opcode(opcode))
    return [Owed(ResponseKind.ERROR, Fault.UNKNOWN_COMMAND)]


def owed_to_each(organisation: Organisation, words: Iterable[int]) -> Iterator[list[Owed]]:
    """What answers each of these commands, the first of which comes right after the boot; also
    where tables of regions, or meshes and objects, are not as they should be."""
    heard: list[HeardTables | HeardMeshes] = []
    if organisation.fault is None:
        if Opcode.REGION in _silent(organisation):
            heard.append(HeardTables(organisation.configuration))
        if organisation.configuration.objects is not None:
            heard.append(HeardMeshes(organisation.configuration))
    for word in words:
        faults = [each.take(word) for each in heard]
        refused = [Owed(ResponseKind.ERROR, fault) for fault in faults if fault is not None]
        yield refused + owed_to(organisation, word)


def _silent(organisation: Organisation) -> list[Opcode]:
    """Commands that nothing answers."""
    configuration = organisation.configuration
    silent = [Opcode.FRAME_START, Opcode.PREPARED_TRIANGLE]
    if configuration.setup == "hardware":
        silent.append(Opcode.TRIANGLE)
    if configuration.list_words:
        silent += [Opcode.LOAD, Opcode.DRAW_LISTS, Opcode.CLEAR_LISTS]
    if configuration.objects is not None:  # of meshes that were loaded
        silent += [Opcode.CLEAR_LISTS, Opcode.MESH, Opcode.MESH_TRIANGLE, Opcode.OBJECT]
    if configuration.takes_tables:
        silent.append(Opcode.REGION)  # of a table as it should be
    return silent


def _of_regions(organisation: Organisation, opcode: Opcode) -> list[Owed]:
    """Of each processing element all slots; or the table that the machine makes."""
    configuration = organisation.configuration
    if configuration.regions is not None:
        if opcode == Opcode.READ_REGIONS and configuration.balance != "static":
            slots = configuration.processing_elements * configuration.slots
            return [Owed(ResponseKind.REGION_COUNT)] * slots
        if opcode == Opcode.READ_TABLE and configuration.balancer == "hardware":
            return [Owed(ResponseKind.TABLE_ENTRY)] * configuration.dealt_regions.count
    return [Owed(ResponseKind.ERROR, Fault.UNKNOWN_COMMAND)]


def _counters(organisation: Organisation) -> list[Owed]:
    """From left to right: of each processing element, of each node that sends what it drew, and of
    each memory unit that takes its fragments from all elements."""
    direct, owed = organisation.configuration.merges_directly, []
    for node in organisation.each:
        element = [ResponseKind.FRAGMENTS, ResponseKind.BUSY]
        if organisation.configuration.forwards_objects:
            element += [ResponseKind.MADE, ResponseKind.DROPPED, ResponseKind.FORWARDED]
        owed += [Owed(kind) for kind in element] * len(node.domains)
        owed += [Owed(ResponseKind.SENT)] * (organisation.merges and not direct)
        if organisation.configuration.objects == "nodes":
            owed += [Owed(ResponseKind.MADE), Owed(ResponseKind.DROPPED)]
    if organisation.configuration.objects == "controller":
        owed += [Owed(ResponseKind.MADE), Owed(ResponseKind.DROPPED)]
    units = organisation.memory_units if direct else 0
    return owed + [Owed(ResponseKind.TAKEN), Owed(ResponseKind.FOLLOWED)] * units


def responses_owed(organisation: Organisation, words: Sequence[int]) -> int:
    """How many come in all, the boot's included."""
    opcodes = Counter(opcode_of(word) for word in words)
    return len(owed_at_boot(organisation)) + sum(
        count * len(owed_to(organisation, opcode)) for opcode, count in opcodes.items())
