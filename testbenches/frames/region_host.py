"""What a host does where regions of the screen are dealt out: it sends tables, and makes the next
one of what was counted."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

import numpy as np
from numpy.typing import NDArray

from ...golden.balancing.learnt_counts import LEARNT_FROM, learnt_counts
from ...golden.balancing.table_policy import (
    UNCOUNTED_POLICIES,
    Policy,
    boot_table,
    check_policy,
    default_policy,
    first_table,
)
from ...golden.organisations.region_table import packed_table, slots_of
from ...golden.specification import commands
from ...golden.specification.commands import Opcode
from ...golden.specification.configuration import MachineConfiguration
from ...golden.specification.errors import InputError

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
               picture; at first that with which every machine begins, but for ``"runs"``
    ``policy``  of what it makes tables: ``"learnt"`` of the clocks that it foretells from the last
               three pictures (until there are three, of the last one's), ``"triangles"`` or
               ``"clocks"`` of the last picture's counts, ``"static"`` and ``"runs"`` of none: the
               first one stays.  Learnt where nothing is said, the machine counts clocks and makes
               no tables itself; else what it counts.  ``InputError`` for what the machine does
               not count for

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

    def __init__(self, configuration: MachineConfiguration, *,
                 policy: Policy | None = None) -> None:
        if configuration.regions is None:
            raise InputError("regions: the machine deals none out; give regions, such as (8, 8)")
        self._configuration = configuration
        self.policy = policy or default_policy(configuration)
        check_policy(configuration, self.policy)
        self._seen: list[Int64] = []  # the counts of the last pictures, the last one first
        self.table = first_table(configuration, self.policy)
        self._sent = boot_table(configuration)

    def commands(self) -> list[int]:
        """What tells the machine of ``table``; nothing where it knows, or makes it itself."""
        self._check_table()
        known = np.array_equal(self.table, self._sent)
        self._sent = np.array(self.table)
        if known or self._configuration.balancer == "hardware":
            return []
        return table_commands(self._configuration, self.table)

    def _check_table(self) -> None:
        """A host may give itself another table: ``InputError`` where a machine would refuse it."""
        configuration = self._configuration
        elements, count = configuration.processing_elements, configuration.dealt_regions.count
        if np.shape(self.table) != (count,):
            raise InputError(f"table: has the shape {np.shape(self.table)}, needs {(count,)}: the "
                             "processing element of each region")
        if not np.isin(self.table, np.arange(elements)).all():
            raise InputError(f"table: names none of the processing elements 0 to {elements - 1}")
        if np.bincount(self.table).max() > configuration.slots:
            raise InputError(f"table: gives one processing element more than its "
                             f"{configuration.slots} slots; take fewer, or more slots")

    def counted(self, answers: Sequence[int] | Int64) -> None:
        """``answers``: the values of ``REGION_COUNT`` after a picture that was drawn by ``table``:
        processing element by processing element, of each its slots.  ``InputError`` where there
        are not as many."""
        if self._configuration.balance == "static":
            return  # it counts nothing
        self.pack(of_regions(self._configuration, self.table, answers))

    def pack(self, counts: Int64) -> None:
        """``counts``: int64 (regions,), row by row, after each picture; where the machine counts
        nothing, they are not looked at."""
        if self.policy in UNCOUNTED_POLICIES:
            return
        if self.policy == "learnt":
            self._seen = [np.asarray(counts, np.int64), *self._seen][:LEARNT_FROM]
            if len(self._seen) == LEARNT_FROM:
                counts = learnt_counts(self._seen, self._configuration.dealt_regions.columns)
        self.table = packed_table(counts, self._configuration.processing_elements,
                                  self._configuration.slots)


def of_regions(configuration: MachineConfiguration, table: Int64,
               answers: Sequence[int] | Int64) -> Int64:
    """int64 (regions,): what was counted of each, from the answers to ``READ_REGIONS``."""
    owed = configuration.processing_elements * configuration.slots
    if len(answers) != owed:
        raise InputError(f"counts: {len(answers)} answers to READ_REGIONS, the machine gives "
                         f"{owed}: {configuration.slots} slots of each processing element")
    slots = np.reshape(np.asarray(answers, np.int64), (-1, configuration.slots))
    counts: Int64 = slots[table, slots_of(table)]
    return counts


def of_slots(configuration: MachineConfiguration, table: Int64, counts: Int64) -> Int64:
    """int64 (elements, slots): the answers, from what was counted of each region; 0 where a slot
    has none."""
    slots = np.zeros((configuration.processing_elements, configuration.slots), np.int64)
    slots[table, slots_of(table)] = counts
    return slots
