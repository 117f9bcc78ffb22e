"""What is counted of the regions of a picture, beside what the golden model says."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ...golden.balancing.region_counts import loads, region_counts, utilisation
from ...golden.balancing.region_grid import RegionGrid
from ...golden.balancing.table_policy import UNCOUNTED_POLICIES, Policy, boot_table
from ...golden.planning.scene_needs import fitted
from ...golden.specification.configuration import MachineConfiguration
from ...golden.specification.display_list import DisplayList
from ...golden.specification.regions import Balance
from .region_host import RegionHost, of_slots
from .responses import Simulation

Int64 = NDArray[np.int64]

#: What is told of machines that count nothing.
UNCOUNTED: Balance = "clocks"


def golden_counts(configuration: MachineConfiguration, display_list: DisplayList) -> Int64:
    """int64 (regions,): what the machine counts of each; of one that counts nothing, what it would
    of ``UNCOUNTED``."""
    grid = RegionGrid.of(configuration.dealt_regions)
    counts = region_counts(fitted(configuration, display_list), grid)
    return counts.of(UNCOUNTED if configuration.balance == "static" else configuration.balance)


class RegionTables:
    """The tables of pictures that are drawn one after another: the first one is that with which
    every machine begins, or has runs, each other one is made of the golden counts of the pictures
    before.

    Each is made when it is asked for; ``lists`` are the pictures' display lists, ``policy`` is as
    ``RegionHost`` has it.
    """

    def __init__(self, configuration: MachineConfiguration, lists: Sequence[DisplayList], *,
                 policy: Policy | None = None) -> None:
        self._configuration = configuration
        self._lists = lists
        self._host = RegionHost(configuration, policy=policy)
        self._tables = [self._host.table]
        self._counts: dict[int, Int64] = {}

    def counts(self, number: int) -> Int64:
        """int64 (regions,): of one picture, by the golden model."""
        if number not in self._counts:
            self._counts[number] = golden_counts(self._configuration, self._lists[number])
        return self._counts[number]

    def table(self, number: int) -> Int64:
        """int64 (regions,): by which that picture is drawn, or would be after the last one."""
        while len(self._tables) <= number:
            if self._host.policy not in UNCOUNTED_POLICIES:
                self._host.pack(self.counts(len(self._tables) - 1))
            self._tables.append(self._host.table)
        return self._tables[number]

    def sent(self, number: int) -> Int64 | None:
        """The same, where the host sends it before that picture: the machine makes none itself, and
        it is another than that of the picture before."""
        table = self.table(number)
        before = self.table(number - 1) if number else boot_table(self._configuration)
        if self._configuration.balancer == "hardware" or np.array_equal(table, before):
            return None
        return table

    def figures(self, number: int, simulation: Simulation) -> RegionFigures:
        """Of a picture as it left the machine."""
        return RegionFigures(
            self._configuration, self._host.policy, self.table(number), self.counts(number),
            self.table(number + 1), simulation.slot_counts, simulation.next_table)


@dataclass(frozen=True, eq=False)
class RegionFigures:
    """What the regions of a picture cost, and who drew them.

    ``policy``      of what tables are made
    ``table``       int64 (regions,): by which the picture was drawn
    ``counts``      int64 (regions,): what is counted of each, by the golden model
    ``next_table``  int64 (regions,): made of these, and of earlier ones
    ``slot_counts`` int64 (elements, slots): in the machine's own count; None where it was not read
    ``read_table``  int64 (regions,): the next table that the machine made; None likewise
    """

    configuration: MachineConfiguration
    policy: Policy
    table: Int64
    counts: Int64
    next_table: Int64
    slot_counts: Int64 | None
    read_table: Int64 | None

    @property
    def counted(self) -> Balance:
        """What ``counts`` are of."""
        balance = self.configuration.balance
        return UNCOUNTED if balance == "static" else balance

    @property
    def loads(self) -> Int64:
        """int64 (elements,): counts of all regions of each processing element."""
        return loads(self.counts, self.table, self.configuration.processing_elements)

    @property
    def busiest(self) -> int:
        """The processing element with most of that."""
        return int(self.loads.argmax())

    @property
    def utilisation(self) -> float:
        """All counts, as a part of what they would be were all elements as busy as the busiest."""
        return utilisation(self.counts, self.table, self.configuration.processing_elements)

    @property
    def differences(self) -> list[str]:
        """A line for each count, and for each entry of the next table, that is not golden's."""
        found = []
        if self.slot_counts is not None:
            wanted = of_slots(self.configuration, self.table, self.counts)
            found = [f"processing element {element} counted {self.slot_counts[element, slot]:,} "
                     f"{self.counted} in slot {slot}, golden {wanted[element, slot]:,}"
                     for element, slot in np.argwhere(self.slot_counts != wanted).tolist()]
        if self.read_table is not None:
            found += [f"region {region} goes to processing element {self.read_table[region]} next, "
                      f"golden {self.next_table[region]}"
                      for region in np.flatnonzero(self.read_table != self.next_table).tolist()]
        return found


def sent_table(configuration: MachineConfiguration, policy: Policy | None = None) -> Int64 | None:
    """int64 (regions,): what a host has to say of the regions before the first picture; None where
    nothing is to be said, or there are none."""
    if configuration.regions is None:
        return None
    return RegionTables(configuration, [], policy=policy).sent(0)


def region_figures(configuration: MachineConfiguration, display_list: DisplayList,
                   simulation: Simulation, *,
                   policy: Policy | None = None) -> RegionFigures | None:
    """Of the first picture after the boot; None where there are no regions."""
    if configuration.regions is None:
        return None
    return RegionTables(configuration, [display_list], policy=policy).figures(0, simulation)
