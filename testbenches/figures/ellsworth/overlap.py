"""How many regions a triangle overlaps, by the size of both, beside what Molnar expects."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from ....golden.balancing.region_grid import RegionGrid
from ....golden.scene_display_list import make_display_list
from ...support.measurement_cache import measured_once, package_hash
from .dealing.frame_loads import FrameLoads
from .dealing.models import Size, mean_box, triangles_of
from .dealing.screen_grids import cut, fits, screen_grid

#: Random triangles: so many of each size, with their corners anywhere in a square of such a side.
COUNT = 20_000
SIDES = (4, 8, 16, 32, 64)
SEED = 1

#: Regions of the whole screen.
REGIONS = (16, 64, 256, 1024, 4096)

#: As many regions, wider or taller: columns and rows, for triangles of one size.
SHAPES = ((256, 1), (64, 4), (32, 8), (16, 16), (8, 32), (4, 64), (1, 256))
SHAPE_SIDE = 16


def expected_overlap(box: tuple[float, float], region: tuple[float, float]) -> float:
    """((W + w) / W) ((H + h) / H): Molnar, of boxes w × h that lie anywhere on regions W × H."""
    (w, h), (width, height) = box, region
    return (width + w) / width * (height + h) / height


@dataclass(frozen=True)
class Overlap:
    """Of random triangles in squares of ``side`` on ``columns`` × ``rows`` regions of ``region``
    pixels, ``nearly_square`` or one of ``SHAPES``; the mean box of a triangle is of ``box`` pixels
    and holds ``centres`` columns and rows of pixel centres."""

    side: int
    columns: int
    rows: int
    nearly_square: bool
    box: tuple[float, float]
    centres: tuple[float, float]
    region: tuple[float, float]
    measured: float

    @property
    def regions(self) -> int:
        return self.columns * self.rows

    @property
    def expected(self) -> float:
        return expected_overlap(self.box, self.region)

    @property
    def expected_of_centres(self) -> float:
        """Of w pixel centres in a row, which lie in two regions in w - 1 of W places."""
        w, h = self.centres
        return expected_overlap((w - 1, h - 1), self.region)


@dataclass(frozen=True)
class OverlapJob:
    size: Size
    side: int

    def run(self) -> list[Overlap]:
        found = measured_once([package_hash(), "overlap", repr(self)], self._measure)
        return [Overlap(**each | {name: tuple(each[name]) for name in ("box", "centres", "region")})
                for each in found["overlaps"]]

    def _measure(self) -> dict[str, Any]:
        width, height = self.size
        display_list = make_display_list(f"random:n={COUNT},size={self.side},seed={SEED}",
                                         width=width, height=height, shading="flat").display_list
        triangles = triangles_of(display_list)
        loads = FrameLoads(triangles)
        return {"overlaps": [{
            "side": self.side, "columns": grid.columns, "rows": grid.rows,
            "nearly_square": nearly_square, "box": mean_box(triangles, display_list.sub_bits),
            "centres": [float(np.mean(triangles.right - triangles.left)),
                        float(np.mean(triangles.bottom - triangles.top))],
            "region": [width / grid.columns, height / grid.rows],
            "measured": loads.counts(grid).overlap_factor}
            for nearly_square, grid in self._grids()]}

    def _grids(self) -> Iterator[tuple[bool, RegionGrid]]:
        for regions in REGIONS:
            if fits(self.size, regions):
                yield True, screen_grid(self.size, regions)
        for columns, rows in SHAPES:
            if self.side == SHAPE_SIDE and columns <= self.size[0] and rows <= self.size[1]:
                yield False, cut(self.size, columns, rows)


def overlap_jobs(size: Size) -> list[OverlapJob]:
    """Of triangles that the screen holds."""
    return [OverlapJob(size, side) for side in SIDES if side <= min(size)]


def by_regions(overlaps: Sequence[Overlap]) -> dict[int, list[Overlap]]:
    """Those on nearly square regions, by the triangles' size."""
    found: dict[int, list[Overlap]] = {}
    for each in overlaps:
        if each.nearly_square:
            found.setdefault(each.side, []).append(each)
    return found


def by_shape(overlaps: Sequence[Overlap]) -> list[Overlap]:
    return [each for each in overlaps if not each.nearly_square]
