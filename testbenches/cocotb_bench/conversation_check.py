"""What the machine answers to which command, in which order (docs/command-words.md)."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

from ...golden.organisations.organisation_of import organisation_of
from ...golden.specification.commands import (
    RESPONSE_VALUE_BITS,
    Opcode,
    ResponseKind,
    fault_text,
    opcode_of,
)
from ...golden.specification.configuration import MachineConfiguration
from ..frames.conversation import owed_at_boot, owed_to
from .violation import ProtocolError


class Expected(NamedTuple):
    """A response, with its value where the documents fix it, and the number of the command it
    answers; boot answers number -1."""

    kind: ResponseKind
    value: int | None
    command: int


class ConversationCheck:
    """Call ``command`` and ``response`` when a word passes; where both do in one clock, the command
    first.

    Raises ``ProtocolError`` where a response is not the next one due, comes before its
    command, or has a value that cannot be; and where a command is taken before the boot is
    reported, or before ``FRAME_SHOWN`` of the frame before has been taken.
    """

    def __init__(self, configuration: MachineConfiguration, commands: Sequence[int]) -> None:
        self._configuration = configuration
        organisation = organisation_of(configuration)
        self._expected = [Expected(*owed, -1) for owed in owed_at_boot(organisation)]
        due = len(self._expected)
        self._due_before = [due]
        for number, word in enumerate(commands):
            self._expected += [Expected(*owed, number) for owed in owed_to(organisation, word)]
            if opcode_of(word) == Opcode.FRAME_END:
                due = len(self._expected)
            self._due_before.append(due)
        self._sent = self._received = 0

    @property
    def complete(self) -> bool:
        """Everything has been sent and answered."""
        return (self._sent == len(self._due_before) - 1
                and self._received == len(self._expected))

    def command(self, cycle: int) -> None:
        if self._received < self._due_before[self._sent]:
            owed = self._expected[self._received].kind.name
            raise ProtocolError(f"cycle {cycle}: command {self._sent} is taken while {owed} "
                                    "is still due")
        self._sent += 1

    def response(self, cycle: int, kind: int, value: int) -> None:
        got = f"cycle {cycle}: response {self._received} is kind {kind}, value {value:#x}"
        if self._received == len(self._expected):
            raise ProtocolError(f"{got}, and none is due")
        expected = self._expected[self._received]
        if kind != expected.kind:
            if kind == ResponseKind.ERROR:
                got += f": the machine reports fault {fault_text(value)}"
            raise ProtocolError(f"{got}; {expected.kind.name} is due")
        if expected.command >= self._sent:
            raise ProtocolError(f"{got}, before its command {expected.command} was taken")
        if expected.value is not None and value != expected.value:
            raise ProtocolError(f"{got}; {expected.kind.name} must be {expected.value:#x}")
        if value > self._limit(expected.kind, cycle):
            raise ProtocolError(f"{got}; {expected.kind.name} cannot be that large")
        self._received += 1

    def _limit(self, kind: ResponseKind, cycle: int) -> int:
        """The largest value: what a word holds, or the clocks and scans there have been."""
        if kind == ResponseKind.DEPTH:
            return self._configuration.depth_background
        if kind in (ResponseKind.BOOTED, ResponseKind.FRAME_DRAWN, ResponseKind.BUSY,
                    ResponseKind.FRAGMENTS):
            return cycle
        if kind == ResponseKind.FRAME_SHOWN:
            return cycle // self._configuration.cycles_per_scan + 1
        return (1 << RESPONSE_VALUE_BITS) - 1
