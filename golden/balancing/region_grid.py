"""How the screen is cut up into regions, of the machine's sizes or of any."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from ..specification.regions import Regions

Int64 = NDArray[np.int64]


@dataclass(frozen=True, eq=False)
class RegionGrid:
    """Rectangles row by row from the top left; region (i, j) has number j · ``columns`` + i.

    ``x``  int64 (columns + 1,): column i of regions has the pixels x[i] … x[i + 1] - 1; x[0] is 0
    ``y``  int64 (rows + 1,): likewise

    The last ones may reach beyond the picture.
    """

    x: Int64
    y: Int64

    @classmethod
    def of(cls, regions: Regions) -> RegionGrid:
        """The machine's, of power-of-two sizes."""
        return cls(np.arange(regions.columns + 1) << regions.x_bits,
                   np.arange(regions.rows + 1) << regions.y_bits)

    @classmethod
    def of_size(cls, width: int, height: int, region_width: int, region_height: int) -> RegionGrid:
        """A picture cut up into rectangles of any size; those at the right and at the bottom may be
        smaller."""
        return cls(np.append(np.arange(0, width, region_width), width),
                   np.append(np.arange(0, height, region_height), height))

    @property
    def columns(self) -> int:
        return len(self.x) - 1

    @property
    def rows(self) -> int:
        return len(self.y) - 1

    @property
    def count(self) -> int:
        return self.columns * self.rows

    @cached_property
    def column_at(self) -> Int64:
        """int64 (pixels,): the column of regions that each column of pixels is in."""
        return np.repeat(np.arange(self.columns), np.diff(self.x))

    @cached_property
    def row_at(self) -> Int64:
        """int64 (pixels,): likewise."""
        return np.repeat(np.arange(self.rows), np.diff(self.y))
