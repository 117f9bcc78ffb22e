"""The rows of regions that large boxes meet, as each processing element looks for visits there."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ...balancing.region_grid import RegionGrid
from ...organisations.dealt_regions import DealtRegions
from ...reference.coverage import Triangles, first_centre
from .large_visits import Band
from .region_spans import RegionSpans

Int64 = NDArray[np.int64]


class LargeBoxes:
    """Those of the triangles whose boxes meet more than 2 × 2 regions."""

    def __init__(self, organisation: DealtRegions, triangles: Triangles) -> None:
        grid = self._grid = RegionGrid.of(organisation.regions)
        self._triangles = triangles
        column = np.arange(grid.columns)
        own = (organisation.table.reshape(grid.rows, grid.columns)
               == np.arange(organisation.elements)[:, np.newaxis, np.newaxis])
        # Of each element in each row of regions; where it has none they lie beside any box.
        self._first_own = np.where(own, column, grid.columns).min(axis=2)
        self._last_own = np.where(own, column, -1).max(axis=2)

    def bands(self, spans: RegionSpans) -> dict[tuple[int, int], list[Band]]:
        """By triangle, counted from the first of ``spans``, and element."""
        found = {}
        large = np.flatnonzero(spans.large)
        begins = np.searchsorted(spans.visit_triangle, large).tolist()
        ends = np.searchsorted(spans.visit_triangle, large, side="right").tolist()
        for triangle, begin, end in zip(large.tolist(), begins, ends, strict=True):
            region = spans.visit_region[begin:end]
            element = spans.visit_element[begin:end][region >= 0]
            for number, bands in enumerate(self._bands(
                    spans.begin + triangle, region[region >= 0], element)):
                found[triangle, number] = bands
        return found

    def _bands(self, triangle: int, region: Int64, element: Int64) -> list[list[Band]]:
        """Of each element; ``region`` and ``element`` of all visits."""
        grid, triangles = self._grid, self._triangles
        left, right = triangles.left[triangle], triangles.right[triangle] - 1
        top, bottom = int(triangles.top[triangle]), int(triangles.bottom[triangle])
        middle = int(first_centre(np.sort(triangles.y[:, triangle])[1:2], triangles.grid.unit_y,
                                  triangles.grid.height)[0])
        rows = range(int(grid.row_at[top]), int(grid.row_at[bottom - 1]) + 1)
        passed = ((self._first_own[:, rows.start:rows.stop] > grid.column_at[right])
                  | (self._last_own[:, rows.start:rows.stop] < grid.column_at[left])).tolist()
        visits: list[list[tuple[int, int]]] = [[] for _ in rows]
        for number, owner in zip(region.tolist(), element.tolist(), strict=True):
            row, column = divmod(number, grid.columns)
            visits[row - rows.start].append((column, owner))
        bands: list[list[Band]] = [[] for _ in passed]
        for band, row in enumerate(rows):
            first, last = max(top, int(grid.y[row])), min(bottom, int(grid.y[row + 1])) - 1
            probes = 4 if first < middle <= last else 2
            least = min((column for column, _ in visits[band]), default=0)
            own: list[list[int]] = [[] for _ in passed]
            for column, owner in sorted(visits[band]):
                own[owner].append(column - least)
            for number, beside in enumerate(passed):
                bands[number].append(Band(0, 0, ()) if beside[band] else
                                     Band(probes, len(visits[band]), own[number]))
        return bands
