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
from ..frames.conversation import owed_at_boot, owed_to_each
from .violation import ProtocolError

#: What a cage of nodes says of a picture while it takes commands again.
PRESENTED = (ResponseKind.MERGED, ResponseKind.FRAME_SHOWN)

#: Values that no run has had enough clocks for.
_CLOCKS = (ResponseKind.BOOTED, ResponseKind.FRAME_DRAWN, ResponseKind.MERGED, ResponseKind.BUSY,
           ResponseKind.FRAGMENTS, ResponseKind.SENT, ResponseKind.TAKEN, ResponseKind.FOLLOWED,
           ResponseKind.REGION_COUNT)


class Expected(NamedTuple):
    """A response, with its value where the documents fix it, and the number of the command it
    answers; boot answers number -1.  ``after``: so many answers come before what is presented."""

    kind: ResponseKind
    value: int | None
    command: int
    after: int = 0


class ConversationCheck:
    """Call ``command`` and ``response`` when a word passes; where both do in one clock, the command
    first.

    Raises ``ProtocolError`` where a response is not the next one due, comes before its
    command, or has a value that cannot be; and where a command is taken before the boot is
    reported, or before ``FRAME_SHOWN`` of the frame before has been taken.  In a cage of nodes
    commands for lists need only wait until that is drawn; and where it merges while the next one
    is drawn, all but read-backs only for ``FRAME_SHOWN`` of the one before that: what is presented
    may then come before or after other answers.
    """

    def __init__(self, configuration: MachineConfiguration, commands: Sequence[int]) -> None:
        self._configuration = configuration
        organisation = organisation_of(configuration)
        self._apart = PRESENTED if organisation.merges else ()
        self._answers = [Expected(*owed, -1) for owed in owed_at_boot(organisation)]
        self._presented: list[Expected] = []
        # How many of both are due before each command, and at the end of each frame.
        self._due_before: list[tuple[int, int]] = []
        ends = [(len(self._answers), 0)]
        for number, (word, answers) in enumerate(zip(
                commands, owed_to_each(organisation, commands), strict=True)):
            self._due_before.append((ends[-1][0], self._presented_before(word, ends)))
            for owed in answers:
                if owed.kind in self._apart:
                    self._presented.append(Expected(*owed, number, len(self._answers)))
                else:
                    self._answers.append(Expected(*owed, number))
            if opcode_of(word) == Opcode.FRAME_END:
                ends.append((len(self._answers), len(self._presented)))
        self._sent = self._answered = self._shown = 0

    def _presented_before(self, word: int, ends: Sequence[tuple[int, int]]) -> int:
        """How much of what is presented is due before a command after these ends of frames."""
        opcode = opcode_of(word)
        if self._configuration.list_words and opcode in (Opcode.LOAD, Opcode.CLEAR_LISTS):
            return 0
        reads = opcode in (Opcode.READ_DEPTH, Opcode.READ_COUNTERS)
        return ends[-2 if self._configuration.snoops and not reads and len(ends) > 1 else -1][1]

    @property
    def complete(self) -> bool:
        """Everything has been sent and answered."""
        return (self._sent == len(self._due_before) and self._answered == len(self._answers)
                and self._shown == len(self._presented))

    def command(self, cycle: int) -> None:
        answers, presented = self._due_before[self._sent]
        if self._answered < answers or self._shown < presented:
            owed = (self._answers[self._answered] if self._answered < answers
                    else self._presented[self._shown])
            raise ProtocolError(f"cycle {cycle}: command {self._sent} is taken while "
                                f"{owed.kind.name} is still due")
        self._sent += 1

    def response(self, cycle: int, kind: int, value: int) -> None:
        number = self._answered + self._shown
        got = f"cycle {cycle}: response {number} is kind {kind}, value {value:#x}"
        presents = kind in self._apart
        expected = self._next(got, presents)
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
        self._shown += presents
        self._answered += not presents

    def _next(self, got: str, presents: bool) -> Expected:
        """What is due of the answers, or of what is presented; there, the answer before it."""
        due, done = ((self._presented, self._shown) if presents else
                     (self._answers, self._answered))
        if done == len(due):
            raise ProtocolError(f"{got}, and none is due")
        return due[done] if due[done].after <= self._answered else self._answers[self._answered]

    def _limit(self, kind: ResponseKind, cycle: int) -> int:
        """The largest value: what a word holds, or the clocks and scans there have been."""
        if kind == ResponseKind.DEPTH:
            return self._configuration.depth_background
        if kind in _CLOCKS:
            return cycle
        if kind == ResponseKind.TABLE_ENTRY:
            return self._configuration.processing_elements - 1
        if kind == ResponseKind.FRAME_SHOWN:
            return cycle // self._configuration.cycles_per_scan + 1
        return (1 << RESPONSE_VALUE_BITS) - 1
