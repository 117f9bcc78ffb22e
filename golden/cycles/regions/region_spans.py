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
from ...balancing.region_visits import RegionVisits, is_small, region_visits
from ...organisations.dealt_regions import DealtRegions
from ...reference.coverage import Triangles
from ..row_clocks import Entries

Bool = NDArray[np.bool_]
Int64 = NDArray[np.int64]

#: Rows of triangles cut up at once.
ROW_LIMIT = 1 << 12


@dataclass(frozen=True, eq=False)
class RegionSpans:
    """The visits of the triangles ``begin`` … ``end`` - 1, and the spans found on them, both in the
    order of (triangle, element, region), spans of a visit by row; (n,) each, int64 unless said.

    ``large``  bool (end - begin,): the triangles whose box meets more than 2 × 2 regions

    Of the visits, one of no region where a large triangle has none of an element's:

    ``visit_triangle``  counted from ``begin``
    ``visit_element``   processing element
    ``visit_region``    its number, or -1
    ``visit_rows``      rows it goes over; 1 of no region, for it takes a clock
    ``visit_ends``      bool: it is the triangle's last one in its element

    Of the spans, none of which is empty:

    ``element``  of its visit
    ``visit``    which of the visits
    ``step``     rows of the visit above this one
    ``length``   pixels
    ``squares``  1: a span is one run of neighbouring pixels
    ``units``    memory units that it is drawn into, those of the element
    ``place``    how many of these spans come before it in the order of (triangle, row, column),
                 that of ``reference.exact.fragments``
    """

    begin: int
    end: int
    large: Bool
    visit_triangle: Int64
    visit_element: Int64
    visit_region: Int64
    visit_rows: Int64
    visit_ends: Bool
    element: Int64
    visit: Int64
    step: Int64
    length: Int64
    squares: Int64
    units: Int64
    place: Int64

    def counted(self, x: Int64, lane: Int64, weights: Bool | None) -> Int64:
        """int64 (n, 2): how many fragments of each span are in each lane, or the sum of their
        weights; ``x`` and ``lane`` of all fragments, triangles ascending, rows ascending, columns
        ascending."""
        order = np.empty(len(self), np.int64)
        order[self.place] = np.arange(len(self))
        span = np.repeat(order, self.length[order])
        found = np.bincount(2 * span + lane, weights, 2 * len(self))
        return found.astype(np.int64).reshape(-1, 2)

    def entries(self) -> tuple[Entries, Int64]:
        """What leaves the walkers, a visit's as others' of a triangle; and which of the visits they
        are, for those that are empty and are not their triangle's last leave nothing."""
        filled = np.zeros(len(self.visit_rows), bool)
        filled[self.visit[self.step == self.visit_rows[self.visit] - 1]] = True
        ends = np.flatnonzero(self.visit_ends & ~filled)
        visit = np.concatenate([self.visit, ends])
        offset = np.concatenate([self.step, self.visit_rows[ends] - 1])
        span = np.concatenate([np.arange(len(self)), np.full(len(ends), -1)])
        order = np.argsort(visit, kind="stable")  # a visit's end comes last
        visits, pair = np.unique(visit[order], return_inverse=True)
        return Entries(self.visit_triangle[visits], self.visit_element[visits],
                       self.visit_rows[visits], pair, offset[order], span[order]), visits

    def __len__(self) -> int:
        return len(self.length)


def region_spans(triangles: Triangles, organisation: DealtRegions,
                 row_limit: int = ROW_LIMIT) -> Iterator[RegionSpans]:
    """All triangles, about ``row_limit`` rows at a time."""
    grid = RegionGrid.of(organisation.regions)
    large = ~is_small(triangles, grid)
    for visits in region_visits(triangles, grid, row_limit):
        yield _cut(organisation, grid, large, visits)


def _cut(organisation: DealtRegions, grid: RegionGrid, large: Bool,
         visits: RegionVisits) -> RegionSpans:
    extents, elements = visits.extents, organisation.elements
    large = large[extents.begin:extents.end]
    triangle, element = visits.triangle - extents.begin, organisation.table[visits.region]
    visits_none = np.zeros((len(large), elements), bool)
    visits_none[large] = True
    visits_none[triangle, element] = False
    of_none, by_none = np.nonzero(visits_none)

    triangle, element = np.concatenate([triangle, of_none]), np.concatenate([element, by_none])
    region = np.concatenate([visits.region, np.full(len(of_none), -1)])
    order = np.lexsort((region, element, triangle))
    triangle, element, region = triangle[order], element[order], region[order]
    rows = np.concatenate([visits.rows, np.ones_like(of_none)])[order]
    first_row = np.concatenate([visits.first, np.zeros_like(of_none)])[order]
    ends = np.ones(len(order), bool)
    ends[:-1] = (triangle[1:] != triangle[:-1]) | (element[1:] != element[:-1])

    visit = np.repeat(np.arange(len(order)), rows)
    step = np.arange(len(visit)) - np.repeat(np.cumsum(rows) - rows, rows)
    row = first_row[visit] + step
    column = (region % grid.columns)[visit]
    length = (np.minimum(extents.beyond[row], grid.x[column + 1])
              - np.maximum(extents.first[row], grid.x[column]))
    filled = np.flatnonzero((length > 0) & (region[visit] >= 0))
    visit, step, row, column = visit[filled], step[filled], row[filled], column[filled]
    place = np.empty(len(filled), np.int64)
    place[np.lexsort((column, row))] = np.arange(len(filled))
    return RegionSpans(
        begin=extents.begin, end=extents.end, large=large, visit_triangle=triangle,
        visit_element=element, visit_region=region, visit_rows=rows, visit_ends=ends,
        element=element[visit], visit=visit, step=step, length=length[filled],
        squares=np.ones(len(filled), np.int64),
        units=np.full(len(filled), 1 << organisation.configuration.share_bits), place=place)
