"""What the last frames tell of the next one: by which its regions can be dealt out beforehand."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from .....golden.balancing import learnt_counts as learnt
from .frame_loads import BoxLoads

Int64 = NDArray[np.int64]
Float64 = NDArray[np.float64]

#: Between which the growth of a region is thought to go on.
GOES_ON = (float(learnt.GOES_ON[0]), float(learnt.GOES_ON[1]))

#: Who can use a cure.
COUNTERS, BOXES, NOBODY = "counters", "boxes ahead", "-"


@dataclass(frozen=True, eq=False)
class Seen:
    """``clocks`` counted of each region in the last three frames, the last one first;
    ``triangles`` of the last one; ``boxes`` of the coming frame and of the last one, ``shape`` of
    the grid: rows and columns of regions."""

    clocks: tuple[Int64, Int64, Int64]
    triangles: Int64
    boxes: tuple[BoxLoads, BoxLoads]
    shape: tuple[int, int]

    @property
    def last(self) -> Float64:
        return self.clocks[0].astype(np.float64)

    @property
    def growth(self) -> Float64:
        """From the frame before to the last one."""
        return np.asarray(self.clocks[0] - self.clocks[1], np.float64)

    @property
    def growth_before(self) -> Float64:
        return np.asarray(self.clocks[1] - self.clocks[2], np.float64)

    def blurred(self, counts: Float64, share: float) -> Float64:
        """Each region gives ``share`` of its count to each neighbour left and right, and then as
        much up and down; none beyond the screen."""
        field = counts.reshape(self.shape)
        for axis in (1, 0):
            around = np.pad(field, [(int(each == axis),) * 2 for each in (0, 1)], mode="edge")
            count = field.shape[axis]
            before, after = (np.take(around, np.arange(count) + place, axis) for place in (0, 2))
            field = share * before + (1 - 2 * share) * field + share * after
        return np.asarray(field.reshape(-1), np.float64)


def _growth_learnt(seen: Seen) -> Float64:
    """By the factor by which the growth before would have foretold the growth best, in least
    squares."""
    before = float(seen.growth_before @ seen.growth_before)
    goes_on = float(seen.growth @ seen.growth_before) / max(before, 1.0)
    return seen.last + min(max(goes_on, GOES_ON[0]), GOES_ON[1]) * seen.growth


def _boxes_at_cost(seen: Seen) -> Float64:
    """A region's clocks for a box pixel in the last frame; where it had none, all regions'."""
    coming, last = (boxes.pixels.astype(np.float64) for boxes in seen.boxes)
    common = seen.last.sum() / max(last.sum(), 1.0)
    return coming * np.where(last > 0, seen.last / np.maximum(last, 1.0), common)


@dataclass(frozen=True)
class Cure:
    """``needs``: what a machine must have for it; ``estimate`` of each region's clocks."""

    name: str
    needs: str
    estimate: Callable[[Seen], Float64 | Int64]

    def counts(self, seen: Seen) -> Int64:
        """To make a table from."""
        return np.maximum(np.rint(self.estimate(seen)), 0).astype(np.int64)


LAST = "last frame's clocks"

#: In the order of the table.
CURES = (
    Cure("last frame's triangles", COUNTERS, lambda seen: seen.triangles),
    Cure(LAST, COUNTERS, lambda seen: seen.clocks[0]),
    Cure("blurred", COUNTERS, lambda seen: seen.blurred(seen.last, 1 / 4)),
    Cure("blurred a little", COUNTERS, lambda seen: seen.blurred(seen.last, 1 / 16)),
    Cure("extrapolated", COUNTERS, lambda seen: seen.last + seen.growth),
    Cure("half extrapolated", COUNTERS, lambda seen: seen.last + seen.growth / 2),
    Cure("extrapolated where it grows", COUNTERS,
         lambda seen: seen.last + np.maximum(seen.growth, 0)),
    Cure("growth blurred", COUNTERS,
         lambda seen: seen.last + seen.blurred(seen.growth, 1 / 8)),
    Cure("growth learnt", COUNTERS, _growth_learnt),
    Cure("growth and blur learnt", COUNTERS,
         lambda seen: learnt.learnt_counts(seen.clocks, seen.shape[1])),
    Cure("coming boxes", BOXES, lambda seen: seen.boxes[0].boxes),
    Cure("coming boxes' pixels", BOXES, lambda seen: seen.boxes[0].pixels),
    Cure("coming boxes at last frame's cost", BOXES, _boxes_at_cost),
)
