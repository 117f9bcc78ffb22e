"""What a host does where regions of the screen are dealt out: it sends tables, and packs the next
one of what was counted."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

import numpy as np
from numpy.typing import NDArray

from ...golden.organisations.region_table import packed_table, slots_of, static_table
from ...golden.specification import commands
from ...golden.specification.commands import Opcode
from ...golden.specification.configuration import MachineConfiguration

Int64 = NDArray[np.int64]


def table_commands(configuration: MachineConfiguration, table: Iterable[int]) -> list[int]:
    """``REGION`` for each region, row by row; the next ``FRAME_START`` begins a picture that is
    drawn by this table.

    ``table``  the processing element of each region
    """
    layout = commands.region_layout(configuration)
    columns = configuration.dealt_regions.columns
    return [commands.command(Opcode.REGION, commands.pack(layout, {
                "column": region % columns, "row": region // columns, "element": int(element)}))
            for region, element in enumerate(table)]


def region_readings(configuration: MachineConfiguration) -> list[int]:
    """The commands that read what a machine tells of the regions of the picture last drawn: its
    counts, if it has any, and the next table, if it makes that itself."""
    if configuration.regions is None:
        return []
    asked = {Opcode.READ_REGIONS: configuration.balance != "static",
             Opcode.READ_TABLE: configuration.balancer == "hardware"}
    return [commands.command(opcode) for opcode, has in asked.items() if has]


class RegionHost:
    """The host's part of a machine whose regions are dealt out anew for each picture.

    ``table``  int64 (regions,): the processing element of each region, row by row, in the next
               picture; at first that with which every machine begins

    Before a picture send ``commands()``, after it give the answers to ``READ_REGIONS`` to
    ``counted``.

    >>> import cardcage
    >>> machine = cardcage.MachineConfiguration(cards="2x(PM)", width=16, height=16, regions=(2, 2))
    >>> host = cardcage.RegionHost(machine)
    >>> host.table.tolist(), host.commands()
    ([0, 1, 0, 1], [])
    >>> host.counted([7, 40, 0, 1, 2, 0])  # of each element's slots, here three
    >>> host.table.tolist(), len(host.commands()), host.commands()
    ([1, 1, 0, 1], 4, [])
    """

    def __init__(self, configuration: MachineConfiguration) -> None:
        self._configuration = configuration
        self.table = static_table(configuration.dealt_regions.count,
                                  configuration.processing_elements)
        self._sent = self.table

    def commands(self) -> list[int]:
        """What tells the machine of ``table``; nothing where it knows, or makes it itself."""
        known = np.array_equal(self.table, self._sent)
        self._sent = self.table
        if known or self._configuration.balancer == "hardware":
            return []
        return table_commands(self._configuration, self.table)

    def counted(self, answers: Sequence[int] | Int64) -> None:
        """``answers``: the values of ``REGION_COUNT`` after a picture that was drawn by ``table``:
        processing element by processing element, of each its slots."""
        self.pack(of_regions(self._configuration, self.table, answers))

    def pack(self, counts: Int64) -> None:
        """``counts``: int64 (regions,), row by row; where the machine counts nothing, they are not
        looked at."""
        if self._configuration.balance != "static":
            self.table = packed_table(counts, self._configuration.processing_elements,
                                      self._configuration.slots)


def of_regions(configuration: MachineConfiguration, table: Int64,
               answers: Sequence[int] | Int64) -> Int64:
    """int64 (regions,): what was counted of each, from the answers to ``READ_REGIONS``."""
    slots = np.reshape(np.asarray(answers, np.int64), (-1, configuration.slots))
    counts: Int64 = slots[table, slots_of(table)]
    return counts


def of_slots(configuration: MachineConfiguration, table: Int64, counts: Int64) -> Int64:
    """int64 (elements, slots): the answers, from what was counted of each region; 0 where a slot
    has none."""
    slots = np.zeros((configuration.processing_elements, configuration.slots), np.int64)
    slots[table, slots_of(table)] = counts
    return slots
