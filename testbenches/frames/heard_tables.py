"""What becomes of the tables of regions that a host sends, good ones and others."""

from __future__ import annotations

from ...golden.organisations.region_table import static_table
from ...golden.specification import commands
from ...golden.specification.commands import Fault, Opcode, opcode_of
from ...golden.specification.configuration import MachineConfiguration


class HeardTables:
    """Takes command after command, and says what is answered to those that are about tables, as
    ``docs/command-words.md`` has it.

    ``used``      the table of the frame begun last: the processing element of each region
    ``elements``  processing elements in the cage, where they are not those of the configuration
    """

    def __init__(self, configuration: MachineConfiguration, elements: int | None = None) -> None:
        self.configuration = configuration
        self.regions = configuration.dealt_regions
        self.elements = configuration.processing_elements if elements is None else elements
        self.used: list[int] = static_table(self.regions.count, self.elements).tolist()
        self.coming: list[int] = []
        self.waiting: list[int] | None = None
        self.refused = self.in_frame = False

    def take(self, word: int) -> Fault | None:
        """The fault that is answered, if any."""
        opcode = opcode_of(word)
        if opcode == Opcode.FRAME_END:
            self.in_frame = False
        if opcode == Opcode.FRAME_START:
            return self._start()
        if opcode != Opcode.REGION:
            return None
        layout = commands.region_layout(self.configuration)
        fields = commands.unpack(layout, word >> commands.BODY_OFFSET)
        place, element = (fields["row"], fields["column"]), fields["element"]
        if self.refused and place != (0, 0):
            return None
        fault = self._fault(place, element)
        self.refused = fault is not None
        if place == (0, 0) or self.refused:
            self.coming, self.waiting = [], None
        if not self.refused:
            self.coming.append(element)
            if len(self.coming) == self.regions.count:
                self.waiting, self.coming = self.coming, []
        return fault

    def _start(self) -> Fault | None:
        unfinished, self.in_frame = bool(self.coming), True
        self.coming = []
        if self.waiting is not None:
            self.used, self.waiting = self.waiting, None
        if not unfinished:
            return None
        self.refused = True
        return Fault.REGION_TO_NOBODY

    def _fault(self, place: tuple[int, int], element: int) -> Fault | None:
        if self.in_frame:
            return Fault.TABLE_LATE
        before: list[int] = []
        if place != (0, 0):
            before = self.coming
            expected = divmod(len(before), self.regions.columns)
            if self.waiting is not None or place < expected:
                return Fault.REGION_TWICE
            if place > expected:
                return Fault.REGION_TO_NOBODY
        if element >= self.elements:
            return Fault.REGION_TO_NOBODY
        return Fault.NO_SLOT if before.count(element) == self.configuration.slots else None
