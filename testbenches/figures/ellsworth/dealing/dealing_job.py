"""How evenly the regions of a frame are dealt out, for all processors, ratios and counts."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import islice
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .....golden.balancing.region_counts import RegionCounts, utilisation
from .....golden.balancing.region_grid import RegionGrid
from .....golden.organisations.region_table import packed_table, static_table
from .....golden.specification.regions import default_slots
from ....support.measurement_cache import measured_once, package_hash
from .cures import CURES, Seen
from .frame_loads import BoxLoads, FrameLoads
from .models import FigureModel, Size, mean_box, triangles_of
from .screen_grids import RATIOS, processors_for, screen_grid

Int64 = NDArray[np.int64]

#: Of a frame, by what its table was made; and what no table exceeds, as no region can be cut.
STATIC, SCATTERED, CEILING = "static", "static, scattered", "ceiling"
TRIANGLES, CLOCKS = "triangles", "clocks"
THIS, LAST = "this frame", "last frame"
HOW = (STATIC, SCATTERED,
       *(f"{count}, {frame}" for count in (TRIANGLES, CLOCKS) for frame in (THIS, LAST)), CEILING)

#: Where cures are tried: at the paper's ratio.
CURE_PROCESSORS = (16, 64, 256)
CURE_RATIO = 8

#: Frames before the first that are looked at: what the cures want.
BEFORE = 3


def dealt(counts: Int64, processors: int) -> Int64:
    """The table that machines make of counts, with as many slots as they have by default."""
    return packed_table(counts, processors, default_slots(len(counts), processors))


def scattered_table(grid: RegionGrid, processors: int) -> Int64:
    """A static one in which a processor's regions lie far from each other: from row to row it moves
    on by some 3/8 of the processors, an odd number."""
    region = np.arange(grid.count)
    step = round(0.382 * processors) | 1
    return np.asarray((region % grid.columns + step * (region // grid.columns)) % processors)


def cure_processors(size: Size) -> list[int]:
    return [each for each in CURE_PROCESSORS if each in processors_for(size)]


@dataclass(frozen=True, eq=False)
class FrameCounts:
    """A frame's counts by the number of regions; ``boxes`` of the grids where cures are tried."""

    given: int
    drawn: int
    fragments: int
    box: tuple[float, float]
    regions: dict[int, RegionCounts]
    boxes: dict[int, BoxLoads]


def frame_counts(model: FigureModel, size: Size, first: int, count: int) -> Iterator[FrameCounts]:
    """Of so many frames from ``first`` on; ``box`` as of ``mean_box``."""
    processors = processors_for(size)
    grids = {regions: screen_grid(size, regions)
             for regions in sorted({each * ratio for each in processors for ratio in RATIOS})}
    boxed = {each * CURE_RATIO for each in cure_processors(size)}
    for display_list in model.lists(size, first, count):
        triangles = triangles_of(display_list)
        loads = FrameLoads(triangles)
        yield FrameCounts(
            display_list.triangles, len(triangles), loads.fragments,
            mean_box(triangles, display_list.sub_bits),
            {regions: loads.counts(grid) for regions, grid in grids.items()},
            {regions: loads.boxes(grids[regions]) for regions in boxed})


@dataclass(frozen=True)
class DealingJob:
    """Frames ``first`` … ``first + count - 1`` of a model.  ``run`` makes of each a number, and of
    these lists; keys are what JSON knows:

    ``given``        triangles that face the eye, ``drawn``: those that may cover a pixel,
                     ``fragments``, ``width`` and ``height`` (of the mean box)
    ``visits``       by the number of regions, and ``clocks``: of all regions together
    ``utilisation``  by processors, ratio (both words) and ``HOW``
    ``cures``        by processors and the name of a cure
    """

    model: FigureModel
    size: Size
    first: int
    count: int

    def run(self) -> dict[str, Any]:
        return measured_once([package_hash(), "regions dealt out", repr(self),
                              self.model.identity(self.size)], self._measure)

    def _measure(self) -> dict[str, Any]:
        frames = frame_counts(self.model, self.size, self.first - BEFORE, self.count + BEFORE)
        seen = list(islice(frames, BEFORE))
        found = []
        for now in frames:
            found.append(_facts(now, seen, self.size))
            seen = [*seen[1:], now]
        merged: dict[str, Any] = merge_lists(found)
        return merged


def merge_lists(parts: Sequence[Any]) -> Any:
    """Of dictionaries alike, in which numbers or lists stand, one in which lists stand."""
    if isinstance(parts[0], dict):
        return {name: merge_lists([part[name] for part in parts]) for name in parts[0]}
    return [number for part in parts for number in (part if isinstance(part, list) else [part])]


def _facts(now: FrameCounts, seen: Sequence[FrameCounts], size: Size) -> dict[str, Any]:
    """``seen``: the frames before, the last one last."""
    last = seen[-1].regions
    return {
        "given": now.given, "drawn": now.drawn, "fragments": now.fragments,
        "width": now.box[0], "height": now.box[1],
        "visits": {str(regions): int(counts.triangles.sum())
                   for regions, counts in now.regions.items()},
        "clocks": {str(regions): int(counts.clocks.sum())
                   for regions, counts in now.regions.items()},
        "utilisation": {str(each): {
            str(ratio): _utilisations(now.regions[each * ratio], last[each * ratio], each,
                                      screen_grid(size, each * ratio))
            for ratio in RATIOS} for each in processors_for(size)},
        "cures": {str(each): _cured(now, seen, each, size) for each in cure_processors(size)},
    }


def _utilisations(now: RegionCounts, last: RegionCounts, processors: int, grid: RegionGrid
                  ) -> dict[str, float]:
    """In clocks, whatever the table was made of."""
    tables = [static_table(grid.count, processors), scattered_table(grid, processors),
              *(dealt(counts, processors) for counts in
                (now.triangles, last.triangles, now.clocks, last.clocks))]
    found = [utilisation(now.clocks, table, processors) for table in tables]
    most = int(now.clocks.max())
    ceiling = min(1.0, int(now.clocks.sum()) / (processors * most)) if most else 1.0
    return dict(zip(HOW, [*found, ceiling], strict=True))


def _cured(now: FrameCounts, seen: Sequence[FrameCounts], processors: int, size: Size
           ) -> dict[str, float]:
    regions = processors * CURE_RATIO
    third, second, last = (frame.regions[regions] for frame in seen[-3:])
    grid = screen_grid(size, regions)
    told = Seen((last.clocks, second.clocks, third.clocks), last.triangles,
                (now.boxes[regions], seen[-1].boxes[regions]), (grid.rows, grid.columns))
    clocks = now.regions[regions].clocks
    return {cure.name: utilisation(clocks, dealt(cure.counts(told), processors), processors)
            for cure in CURES}
