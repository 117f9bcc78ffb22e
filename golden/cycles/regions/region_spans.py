"""What of each triangle falls to each processing element where a table deals regions out.

The walker of an element goes over the rows of each of its visits, one after another, and finds a
span in those that are not empty there.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ...balancing.region_grid import RegionGrid
from ...balancing.region_visits import RegionVisits, region_visits
from ...reference.coverage import Triangles

Int64 = NDArray[np.int64]

#: Rows of triangles cut up at once.
ROW_LIMIT = 1 << 12


@dataclass(frozen=True, eq=False)
class RegionSpans:
    """The visits of the triangles ``begin`` … ``end`` - 1, and the spans found on them, both in the
    order of (triangle, element, region), spans of a visit by row; int64 (n,) each.

    Of the visits:

    ``visit_triangle``  counted from ``begin``
    ``visit_element``   processing element
    ``visit_band``      rows of regions of the triangle's box above it
    ``visit_rows``      rows it goes over

    Of the spans, none of which is empty:

    ``triangle`` ``element``  of its visit
    ``visit``    which of the visits
    ``step``     rows of the visit above this one
    ``length``   pixels
    ``squares``  1: a span is one run of neighbouring pixels
    ``units``    memory units that it is spread over, those of the element
    ``place``    how many of the spans of these triangles come before it in the order of
                 (triangle, row, column), that of ``reference.exact.fragments``
    """

    begin: int
    end: int
    visit_triangle: Int64
    visit_element: Int64
    visit_band: Int64
    visit_rows: Int64
    triangle: Int64
    element: Int64
    visit: Int64
    step: Int64
    length: Int64
    squares: Int64
    units: Int64
    place: Int64

    def counted(self, x: Int64, lane: Int64, weights: NDArray[np.bool_] | None) -> Int64:
        """int64 (n, 2): how many fragments of each span are in each lane, or the sum of their
        weights; ``x`` and ``lane`` of all fragments, triangles ascending, rows ascending, columns
        ascending."""
        order = np.empty(len(self), np.int64)
        order[self.place] = np.arange(len(self))
        span = np.repeat(order, self.length[order])
        found = np.bincount(2 * span + lane, weights, 2 * len(self))
        return found.astype(np.int64).reshape(-1, 2)

    def __len__(self) -> int:
        return len(self.length)


def region_spans(triangles: Triangles, grid: RegionGrid, table: Int64, units: int,
                 row_limit: int = ROW_LIMIT) -> Iterator[RegionSpans]:
    """All triangles, about ``row_limit`` rows at a time, where each element has ``units``."""
    for visits in region_visits(triangles, grid, row_limit):
        yield _cut(triangles, grid, table, units, visits)


def _cut(triangles: Triangles, grid: RegionGrid, table: Int64, units: int,
         visits: RegionVisits) -> RegionSpans:
    extents = visits.extents
    order = np.lexsort((visits.region, table[visits.region], visits.triangle))
    triangle, region = visits.triangle[order], visits.region[order]
    rows, first_row = visits.rows[order], visits.first[order]

    visit = np.repeat(np.arange(len(order)), rows)
    step = np.arange(len(visit)) - np.repeat(np.cumsum(rows) - rows, rows)
    row = first_row[visit] + step
    column = (region % grid.columns)[visit]
    first = np.maximum(extents.first[row], grid.x[column])
    length = np.minimum(extents.beyond[row], grid.x[column + 1]) - first
    filled = np.flatnonzero(length > 0)
    visit, step, row, column = visit[filled], step[filled], row[filled], column[filled]
    place = np.empty(len(filled), np.int64)
    place[np.lexsort((column, row))] = np.arange(len(filled))

    above = grid.row_at[triangles.top[triangle]]
    triangle = triangle - extents.begin
    element = table[region]
    return RegionSpans(
        begin=extents.begin, end=extents.end, visit_triangle=triangle, visit_element=element,
        visit_band=region // grid.columns - above, visit_rows=rows, triangle=triangle[visit],
        element=element[visit], visit=visit, step=step, length=length[filled],
        squares=np.ones(len(filled), np.int64), units=np.full(len(filled), units), place=place)
