"""What a picture costs each region, and how evenly a table deals that out."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ..reference.coverage import Triangles
from ..specification.display_list import DisplayList
from ..specification.regions import Balance
from ..specification.sampling_grid import Grid
from .region_grid import RegionGrid
from .region_visits import region_visits

Int64 = NDArray[np.int64]


@dataclass(frozen=True, eq=False)
class RegionCounts:
    """int64 (regions,) each.

    ``triangles``  that visit it
    ``clocks``     the sum over these of the rows visited, or of the fragments, the greater
    ``drawn``      triangles of the list that may cover a pixel
    """

    triangles: Int64
    clocks: Int64
    drawn: int

    def of(self, balance: Balance) -> Int64:
        """What a machine counts; zeros where it counts nothing."""
        return {"static": self.triangles * 0, "triangles": self.triangles,
                "clocks": self.clocks}[balance]

    @property
    def overlap_factor(self) -> float:
        """Regions that a triangle visits, on average; 0 where none is drawn.

        Molnar's estimate for boxes of w × h pixels and regions of W × H is ((W + w) / W)
        ((H + h) / H); Ellsworth 1994.
        """
        return int(self.triangles.sum()) / self.drawn if self.drawn else 0.0


def region_counts(display_list: DisplayList, grid: RegionGrid) -> RegionCounts:
    """What is counted of a picture at the highest resolution."""
    return counts_of(Triangles.of(display_list, Grid.of(display_list)), grid)


def counts_of(triangles: Triangles, grid: RegionGrid) -> RegionCounts:
    """Likewise, where several grids are asked about one list."""
    visited = np.zeros(grid.count, np.int64)
    clocks = np.zeros(grid.count, np.int64)
    for visits in region_visits(triangles, grid):
        visited += np.bincount(visits.region, minlength=grid.count)
        clocks += np.bincount(visits.region, visits.clocks, grid.count).astype(np.int64)
    return RegionCounts(visited, clocks, len(triangles))


def loads(counts: Int64, table: Int64, elements: int) -> Int64:
    """int64 (elements,): what falls to each processing element by a table."""
    return np.bincount(table, counts, elements).astype(np.int64)


def utilisation(counts: Int64, table: Int64, elements: int) -> float:
    """The share of the elements' time in which they work, if each takes as long as is counted of
    its regions and all wait for the busiest one; 1 where nothing is counted.

    Ellsworth 1994, figure 4.
    """
    load = loads(counts, table, elements)
    busiest = int(load.max())
    return int(load.sum()) / (elements * busiest) if busiest else 1.0
