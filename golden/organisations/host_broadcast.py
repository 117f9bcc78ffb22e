"""The cage of 1979: every processing element sees every primitive and draws its own pixels."""

from __future__ import annotations

from collections.abc import Iterator
from functools import cached_property
from typing import Any

import numpy as np

from ..specification import card_order
from ..specification.commands import Fault
from ..specification.interlace import Interlace
from .organisation import Bool, Coordinate, Domain, ElementBlock, Int64, Organisation, Resolution


class HostBroadcast(Organisation):
    """One node; neighbouring pixels lie in different memory units (Fuchs & Johnson 1979, figures 12
    to 14; Blazek's host broadcast, 1991)."""

    name = "host broadcast"

    @cached_property
    def _interlace(self) -> Interlace:
        return self.configuration.interlace

    @property
    def resolution(self) -> Resolution:
        interlace = self._interlace
        return Resolution(interlace.width, interlace.height, interlace.x_shift, interlace.y_shift)

    @property
    def fault(self) -> Fault | None:
        wrong = self.configuration.units.bit_count() != 1 or self.shares_differ
        return Fault.UNITS_UNSUPPORTED if wrong else None

    @cached_property
    def domains(self) -> tuple[Domain, ...]:
        return tuple(Domain(0, first, units)
                     for first, units in card_order.domains(self.configuration.cards))

    @property
    def each(self) -> tuple[Organisation, ...]:
        return (self,)

    @property
    def node_units(self) -> tuple[int, ...]:
        return (self.configuration.units,)

    @property
    def words(self) -> int:
        return self._interlace.words

    def unit(self, x: Coordinate, y: Coordinate) -> Coordinate:
        return self._interlace.unit(x, y)

    def word(self, x: Coordinate, y: Coordinate) -> Coordinate:
        return self._interlace.address(x, y)

    def pixel(self, unit: Coordinate, word: Coordinate) -> tuple[Coordinate, Coordinate]:
        return self._interlace.pixel(unit, word)

    def is_scanned(self, node: int) -> bool:
        return True

    @cached_property
    def read_back(self) -> tuple[Int64, Int64]:
        """The units and the words whose depths ``READ_DEPTH`` sends: unit after unit, but for those
        of nobody, addresses ascending."""
        units = np.flatnonzero(self.owners[0] >= 0)
        return units.repeat(self.words), np.tile(np.arange(self.words), len(units))

    @property
    def depths_read_back(self) -> int:
        return len(self.read_back[0])

    def depth_image(self, depths: Any) -> Int64:
        width, height, *_ = self.resolution
        x, y = self.pixel(*self.read_back)
        inside = (x < width) & (y < height)
        image = np.full((height, width), -1, np.int64)
        image[y[inside], x[inside]] = np.asarray(depths, np.int64)[inside]
        return image

    @property
    def owned_pixels(self) -> Bool:
        y, x = np.mgrid[:self.resolution.height, :self.resolution.width]
        return np.asarray(self.owners[0, self.unit(x, y)] >= 0)

    @property
    def blocks(self) -> tuple[ElementBlock, ...]:
        return tuple(block for element, (_, first, units) in enumerate(self.domains)
                     for block in self._blocks(element, first, first + units))

    def _blocks(self, element: int, first: int, end: int) -> Iterator[ElementBlock]:
        """The units from ``first`` up to ``end``, cut into the largest aligned powers of two."""
        interlace, square_bits = self._interlace, self.configuration.square_bits
        place = 0
        while first < end:
            largest = (end - first).bit_length() - 1
            aligned = (first & -first).bit_length() - 1 if first else largest
            bits = min(largest, aligned)
            x_bits, y_bits = interlace.stride_bits(bits)
            x, y = (position >> square_bits for position in interlace.pixel(first, 0))
            shifted = interlace.shifted(bits)
            if shifted:  # by its last bit, in rows where the bit of y is 0
                x |= (first & 1) << x_bits - 1
            yield ElementBlock(
                element, place, x & ((1 << x_bits) - 1), y & ((1 << y_bits) - 1), x_bits, y_bits,
                square_bits, shifted, 1 << bits,
                bits > 0 and (interlace.x_unit_bits > x_bits or self.configuration.skew))
            first += 1 << bits
            place += 1

    @property
    def scan_tile(self) -> Int64:
        return self._interlace.tile

    @property
    def scan_group(self) -> int:
        return 1 << self._interlace.group_bits

    @property
    def scan_reads_per_line(self) -> int:
        return self._interlace.scan_reads
