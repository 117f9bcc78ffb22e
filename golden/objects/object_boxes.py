"""Where on the screen an object can have a pixel: its mesh's box, moved."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ..scenes.scene_files.object_list import ObjectList
from ..specification.regions import Regions

Int64 = NDArray[np.int64]
Bool = NDArray[np.bool_]


@dataclass(frozen=True, eq=False)
class ObjectBoxes:
    """The pixels of the picture whose centres lie in an object's box, ends included; int64 (n,)
    each.  No triangle of it covers another one.

    ``left, top, right, bottom``  both ends included; of an object without such a pixel anything
    ``empty``                     bool (n,): those objects
    """

    left: Int64
    top: Int64
    right: Int64
    bottom: Int64
    empty: Bool

    @classmethod
    def of(cls, objects: ObjectList) -> ObjectBoxes:
        """At the highest resolution."""
        low, high = objects.boxes
        unit = 1 << objects.picture.sub_bits
        size = np.array([objects.picture.width, objects.picture.height])
        # The first centre that is not before the box, and the last one that is not beyond it.
        first, last = -((unit // 2 - low) // unit), (high - unit // 2) // unit
        empty = np.asarray(((last < 0) | (first >= size) | (last < first)).any(axis=1))
        first, last = np.maximum(first, 0), np.minimum(last, size - 1)
        return cls(first[:, 0], first[:, 1], last[:, 0], last[:, 1], empty)

    def __len__(self) -> int:
        return len(self.empty)

    def met(self, regions: Regions) -> Bool:
        """bool (n, regions): which regions hold a pixel of each."""
        columns, rows = np.arange(regions.columns), np.arange(regions.rows)
        across = ((columns >= self.left[:, np.newaxis] >> regions.x_bits)
                  & (columns <= self.right[:, np.newaxis] >> regions.x_bits))
        down = ((rows >= self.top[:, np.newaxis] >> regions.y_bits)
                & (rows <= self.bottom[:, np.newaxis] >> regions.y_bits))
        met = down[:, :, np.newaxis] & across[:, np.newaxis]
        return np.asarray(met.reshape(len(self), regions.count) & ~self.empty[:, np.newaxis])
