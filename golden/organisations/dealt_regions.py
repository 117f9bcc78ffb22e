"""A cage whose processing elements draw the regions of the screen that a table gives them."""

from __future__ import annotations

from collections.abc import Sequence
from functools import cached_property
from typing import Any

import numpy as np

from ..specification.commands import Fault
from ..specification.configuration import MachineConfiguration
from ..specification.interlace import Interlace
from .host_broadcast import HostBroadcast
from .organisation import Bool, Coordinate, ElementBlock, Int64, Resolution
from .region_table import runs_table, slots_of, static_table


class DealtRegions(HostBroadcast):
    """One node; a region lies in one processing element's units, interlaced there pixel by pixel,
    in one of its slots (Ellsworth 1994; with a region each, Blazek's strips and grid, 1991).

    ``table``  int64 (regions,): the processing element of each region, row by row
    ``slot``   int64 (regions,): its slot there
    """

    name = "regions"

    def __init__(self, configuration: MachineConfiguration, table: Int64 | None = None) -> None:
        super().__init__(configuration)
        self.regions = configuration.dealt_regions
        self.elements = configuration.processing_elements
        # What a machine begins with: where elements pass objects on each has a run.
        begin = runs_table if configuration.forwards_objects else static_table
        self.table = (begin(self.regions.count, self.elements) if table is None
                      else np.asarray(table, np.int64))
        self.slot = slots_of(self.table)

    def dealt(self, table: Sequence[int] | Int64 | None) -> DealtRegions:
        return DealtRegions(self.configuration, None if table is None else np.asarray(table))

    @property
    def resolution(self) -> Resolution:
        return Resolution(self.configuration.width, self.configuration.height, 0, 0)

    @property
    def fault(self) -> Fault | None:
        share = 1 << self.configuration.share_bits
        wrong = (any(domain.units != share for domain in self.domains)
                 or self.memory_units != self.elements * share
                 or self.elements * self.configuration.slots < self.regions.count)
        return Fault.UNITS_UNSUPPORTED if wrong else None

    @property
    def words(self) -> int:
        return self.configuration.words

    @property
    def inside(self) -> Interlace:
        """Of each region's pixels over the units of its processing element."""
        return self._interlace

    def _inside(self, x: Coordinate, y: Coordinate) -> tuple[Coordinate, Coordinate]:
        """The pixel's place in its region."""
        return x & ((1 << self.regions.x_bits) - 1), y & ((1 << self.regions.y_bits) - 1)

    def unit(self, x: Coordinate, y: Coordinate) -> Coordinate:
        element = self.table[self.regions.region(x, y)]
        unit: Coordinate = ((element << self.configuration.share_bits)
                            | self._interlace.unit(*self._inside(x, y)))
        return unit

    def word(self, x: Coordinate, y: Coordinate) -> Coordinate:
        slot = self.slot[self.regions.region(x, y)]
        word: Coordinate = ((slot << self.configuration.slot_bits)
                            | self._interlace.address(*self._inside(x, y)))
        return word

    @cached_property
    def region_at(self) -> Int64:
        """int64 (elements, slots): the region that lies there, or -1."""
        regions = np.full((self.elements, self.configuration.slots), -1)
        regions[self.table, self.slot] = np.arange(self.regions.count)
        return regions

    def pixel(self, unit: Coordinate, word: Coordinate) -> tuple[Coordinate, Coordinate]:
        configuration, regions = self.configuration, self.regions
        region = self.region_at[unit >> configuration.share_bits, word >> configuration.slot_bits]
        inside = self._interlace.pixel(unit & ((1 << configuration.share_bits) - 1),
                                       word & ((1 << configuration.slot_bits) - 1))
        # A slot without a region lies below the picture.
        place: Any = np.where(region < 0, regions.count, region)
        return (place % regions.columns << regions.x_bits | inside[0],
                place // regions.columns << regions.y_bits | inside[1])

    @property
    def owned_pixels(self) -> Bool:
        return np.ones((self.resolution.height, self.resolution.width), bool)

    @property
    def blocks(self) -> tuple[ElementBlock, ...]:
        raise NotImplementedError("regions are walked one by one, not as lattices")

    @property
    def scan_tile(self) -> Int64:
        y, x = np.mgrid[:self.resolution.height, :self.resolution.width]
        return np.asarray(self.unit(x, y))

    @property
    def scan_reads_per_line(self) -> int:
        """Where all regions of a row are one processing element's, or as many as it holds."""
        across = min(self.regions.columns, self.configuration.slots)
        return across * self._interlace.scan_reads
