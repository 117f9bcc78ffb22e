"""Which regions each triangle visits, and what it finds there, by whole arrays.

A *band* is what of a triangle's box lies in one row of regions.  A box of at most 2 × 2 regions
visits them all.  A larger one visits, band by band, the regions whose columns meet
[least ``first``, greatest ``beyond``) over all rows of the band, the empty ones too; so it may
visit a region without a fragment, but none that is beside the triangle.

A visit goes over all rows of the band, whatever it finds in them.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ..reference.coverage import ROW_LIMIT, Extents, Triangles, extents
from .region_grid import RegionGrid

Int64 = NDArray[np.int64]


@dataclass(frozen=True, eq=False)
class RegionVisits:
    """All visits of some triangles; int64 (n,) each.

    ``extents``    the rows of these triangles
    ``triangle``   counts in ``Triangles``, not in the display list
    ``region``     its number
    ``first``      which of the ``extents`` is the first row visited
    ``rows``       how many are, at least one
    ``fragments``  covered pixels

    In drawing order: triangles ascending, regions ascending within a triangle.  Triangles that
    visit nothing are left out.
    """

    extents: Extents
    triangle: Int64
    region: Int64
    first: Int64
    rows: Int64
    fragments: Int64

    @property
    def clocks(self) -> Int64:
        """int64 (n,): a clock for each row, or for each fragment."""
        return np.maximum(self.rows, self.fragments)

    def __len__(self) -> int:
        return len(self.triangle)


def region_visits(triangles: Triangles, grid: RegionGrid,
                  row_limit: int = ROW_LIMIT) -> Iterator[RegionVisits]:
    """All triangles, about ``row_limit`` rows of pixels at a time; the picture lies in ``grid``."""
    small = is_small(triangles, grid)
    for rows in extents(triangles, row_limit):
        yield _visits(triangles, grid, small, rows)


def is_small(triangles: Triangles, grid: RegionGrid) -> NDArray[np.bool_]:
    """bool (n,): the box lies in at most 2 × 2 regions."""
    return np.asarray(
        (grid.column_at[triangles.right - 1] - grid.column_at[triangles.left] < 2)
        & (grid.row_at[triangles.bottom - 1] - grid.row_at[triangles.top] < 2))


def _visits(triangles: Triangles, grid: RegionGrid, small: NDArray[np.bool_],
            extent: Extents) -> RegionVisits:
    column_at, first, beyond = grid.column_at, extent.first, extent.beyond
    row = grid.row_at.take(extent.row)
    begins = np.ones(len(extent), bool)
    begins[1:] = (extent.triangle[1:] != extent.triangle[:-1]) | (row[1:] != row[:-1])
    start = np.flatnonzero(begins)

    # Of the bands.
    least, most = np.minimum.reduceat(first, start), np.maximum.reduceat(beyond, start)
    triangle = extent.triangle.take(start)
    whole = small.take(triangle)
    least[whole] = triangles.left.take(triangle[whole])
    most[whole] = triangles.right.take(triangle[whole])
    left = column_at.take(np.minimum(least, len(column_at) - 1))
    count = np.where(least < most, column_at.take(most - 1) + 1 - left, 0)
    base = np.cumsum(count) - count
    height = np.diff(start, append=len(extent))

    # Of the visits.
    band = np.repeat(np.arange(len(start)), count)
    column = np.arange(len(band)) + (left - base).take(band)
    band_of_row = np.cumsum(begins) - 1
    return RegionVisits(
        extents=extent,
        triangle=triangle.take(band),
        region=row.take(start).take(band) * grid.columns + column,
        first=start.take(band),
        rows=height.take(band),
        fragments=_fragments(grid, first, beyond, (base - left).take(band_of_row), len(band)),
    )


def _fragments(grid: RegionGrid, first: Int64, beyond: Int64, base: Int64, visits: int) -> Int64:
    """Covered pixels of each visit; ``base`` of each row is its visit in column 0 of regions."""
    filled = np.flatnonzero(first < beyond)
    first, beyond, base = first.take(filled), beyond.take(filled), base.take(filled)
    left, right = grid.column_at.take(first), grid.column_at.take(beyond - 1)
    pieces = right - left + 1
    row = np.repeat(np.arange(len(filled)), pieces)
    column = np.arange(len(row)) - np.repeat(np.cumsum(pieces) - pieces - left, pieces)
    length = (np.minimum(beyond.take(row), grid.x.take(column + 1))
              - np.maximum(first.take(row), grid.x.take(column)))
    found = np.bincount(base.take(row) + column, length, visits)
    return found.astype(np.int64)
