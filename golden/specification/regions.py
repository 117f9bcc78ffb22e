"""Regions of the screen, that a table gives to processing elements (Ellsworth 1994)."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal, TypeVar

import numpy as np
from numpy.typing import NDArray

from .errors import InputError
from .ranges import MAXIMUM_SIZE, check_whole

MAXIMUM_REGIONS = 1024

#: What a processing element counts of its regions, by which the next table is made: nothing, the
#: triangles that visit them, or the clocks that these take it at least.
Balance = Literal["static", "triangles", "clocks"]

#: Who makes the next table.
Balancer = Literal["host", "hardware"]

Coordinate = TypeVar("Coordinate", int, NDArray[np.int64])


@dataclass(frozen=True)
class Regions:
    """Rectangles of ``2**x_bits`` by ``2**y_bits`` pixels, ``columns`` by ``rows`` of them, row by
    row from the top left.  Those at the right and at the bottom may reach beyond the picture."""

    columns: int
    rows: int
    x_bits: int
    y_bits: int

    @property
    def count(self) -> int:
        return self.columns * self.rows

    def region(self, x: Coordinate, y: Coordinate) -> Coordinate:
        """The number of the region that holds a pixel."""
        return (y >> self.y_bits) * self.columns + (x >> self.x_bits)

    @property
    def column_bits(self) -> int:
        """Bits of a region's column."""
        return (self.columns - 1).bit_length()

    @property
    def row_bits(self) -> int:
        return (self.rows - 1).bit_length()

    @property
    def index_bits(self) -> int:
        """Bits of column and row side by side, by which boards look a region up: no product."""
        return self.column_bits + self.row_bits

    def even_share(self, elements: int) -> int:
        """Regions of each of so many processing elements, were all given as many."""
        return -(-self.count // elements)


@dataclass(frozen=True)
class RegionedPicture:
    """What a cage of ``units`` memory units draws where regions are dealt out: always the whole
    picture, if it is held at all."""

    units: int
    width: int
    height: int
    x_shift: int = 0
    y_shift: int = 0


def check_region_counts(regions: object) -> None:
    """Raise ``InputError`` unless that is a tuple of columns and rows."""
    if not isinstance(regions, tuple) or len(regions) != 2:
        raise InputError(f"regions: {regions!r} is not (columns, rows), such as (8, 8)")
    for name, number in zip(("columns", "rows"), regions, strict=True):
        check_whole(f"regions: {name}", number, 1, MAXIMUM_SIZE)


def regions_of(width: int, height: int, columns: int, rows: int) -> Regions:
    """The ``columns`` × ``rows`` regions of a picture; ``InputError``, with the nearest numbers
    that work, where no power-of-two size gives as many."""
    x_bits = _size_bits("columns", width, columns)
    y_bits = _size_bits("rows", height, rows)
    if columns * rows > MAXIMUM_REGIONS:
        raise InputError(f"regions: {columns}x{rows} are {columns * rows} regions, at most "
                         f"{MAXIMUM_REGIONS}; take larger ones")
    return Regions(columns, rows, x_bits, y_bits)


def _size_bits(axis: str, pixels: int, wanted: int) -> int:
    """Log2 of the smallest size of which there are ``wanted`` in so many pixels."""
    counts = [-(-pixels >> bits) for bits in range((pixels - 1).bit_length() + 1)]
    if wanted in counts:
        return counts.index(wanted)
    below = [count for count in counts if count < wanted][:1]
    above = [count for count in counts if count > wanted][-1:]
    raise InputError(f"regions: no power-of-two size gives {wanted} {axis} of {pixels} pixels; "
                     f"take {' or '.join(map(str, below + above))}")


def default_slots(count: int, elements: int) -> int:
    """Regions that each of so many processing elements has room for: a quarter more than an even
    share, but no more than there are."""
    return min(count, -(-5 * count // (4 * elements)))
