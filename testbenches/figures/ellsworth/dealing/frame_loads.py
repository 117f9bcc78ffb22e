"""What one frame costs each region of many grids."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, fields, replace

import numpy as np
from numpy.typing import NDArray

from .....golden.balancing.region_counts import RegionCounts, counts_of
from .....golden.balancing.region_grid import RegionGrid
from .....golden.balancing.region_visits import region_visits
from .....golden.reference.coverage import Triangles

Int64 = NDArray[np.int64]


@dataclass(frozen=True, eq=False)
class BoxLoads:
    """What can be known of each region before anything is drawn; int64 (regions,) each.

    ``boxes``   triangles whose box meets it
    ``pixels``  the sum over these of the box's rows there, or of half its pixels, the greater
    """

    boxes: Int64
    pixels: Int64


class FrameLoads:
    """The counts of a frame's triangles for any grid.

    What a triangle costs that lies in one region is worked out once for all grids; only those that
    lie across a border are looked at again.
    """

    def __init__(self, triangles: Triangles) -> None:
        self.triangles = triangles
        screen = triangles.grid
        whole = RegionGrid.of_size(screen.width, screen.height, screen.width, screen.height)
        self._clocks = np.zeros(len(triangles), np.int64)
        self._fragments = 0
        for visits in region_visits(triangles, whole):
            self._clocks[visits.triangle] = visits.clocks
            self._fragments += int(visits.fragments.sum())

    @property
    def fragments(self) -> int:
        return self._fragments

    def counts(self, grid: RegionGrid) -> RegionCounts:
        """As ``golden.balancing.region_counts.counts_of`` has them."""
        region, within = self._home(grid)
        across = np.flatnonzero(~within)
        found = counts_of(_chosen(self.triangles, across), grid)
        home = region[within]
        return RegionCounts(
            found.triangles + np.bincount(home, minlength=grid.count),
            found.clocks + np.bincount(home, self._clocks[within], grid.count).astype(np.int64),
            len(self.triangles))

    def boxes(self, grid: RegionGrid) -> BoxLoads:
        """By the triangles' boxes alone."""
        boxes, pixels = np.zeros(grid.count, np.int64), np.zeros(grid.count, np.int64)
        _, within = self._home(grid)
        for chosen in (np.flatnonzero(within), np.flatnonzero(~within)):
            for region, rows, columns in _pieces(_chosen(self.triangles, chosen), grid):
                boxes += np.bincount(region, minlength=grid.count)
                pixels += np.bincount(region, np.maximum(rows, (rows * columns + 1) // 2),
                                      grid.count).astype(np.int64)
        return BoxLoads(boxes, pixels)

    def _home(self, grid: RegionGrid) -> tuple[Int64, NDArray[np.bool_]]:
        """The region of each triangle's first pixel, and whether its box lies in it."""
        t = self.triangles
        column, row = grid.column_at[t.left], grid.row_at[t.top]
        within = (column == grid.column_at[t.right - 1]) & (row == grid.row_at[t.bottom - 1])
        return row * grid.columns + column, within


def _chosen(triangles: Triangles, which: Int64) -> Triangles:
    changed = {field.name: getattr(triangles, field.name)[..., which]
               for field in fields(triangles) if field.name != "grid"}
    return replace(triangles, **changed)


def _pieces(triangles: Triangles, grid: RegionGrid) -> Iterator[tuple[Int64, Int64, Int64]]:
    """The region, rows and columns of each piece of the triangles' boxes, so many of which at a
    time that each box has one at most."""
    left, right = grid.column_at[triangles.left], grid.column_at[triangles.right - 1]
    top, bottom = grid.row_at[triangles.top], grid.row_at[triangles.bottom - 1]
    for down in range(int((bottom - top).max(initial=-1)) + 1):
        for along in range(int((right - left).max(initial=-1)) + 1):
            met = np.flatnonzero((left + along <= right) & (top + down <= bottom))
            column, row = left[met] + along, top[met] + down
            columns = (np.minimum(triangles.right[met], grid.x[column + 1])
                       - np.maximum(triangles.left[met], grid.x[column]))
            rows = (np.minimum(triangles.bottom[met], grid.y[row + 1])
                    - np.maximum(triangles.top[met], grid.y[row]))
            yield row * grid.columns + column, rows, columns
