"""The winner of every pixel, collected from fragments in any order."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from .coverage import Spans, Triangles
from .display_list import DisplayList
from .grid import Grid
from .picture import NO_PRIMITIVE, Picture

Int64 = NDArray[np.int64]

#: A fragment's key is its depth, at most 32 bits, above its triangle's number.
#: Triangles keep the drawing order, so the least key is the least (depth, primitive).
_TRIANGLE_BITS = 31
_NOTHING = np.iinfo(np.int64).max


@dataclass(frozen=True, eq=False)
class Visible:
    """The pixels on which something was drawn, ascending, and their winners; int64 (n,) each.

    ``triangle`` counts in ``Triangles``, not in the display list.
    """

    x: Int64
    y: Int64
    triangle: Int64
    depth: Int64


class DepthBuffer:
    """Keeps the least (depth, primitive) of each pixel."""

    def __init__(self, grid: Grid) -> None:
        self._grid = grid
        self._least = np.full(grid.height * grid.width, _NOTHING)

    def add(self, runs: Spans, span: Int64, column: Int64, depth: Int64) -> None:
        """Take every fragment of ``runs``, expanded to ``span`` and ``column``.

        ``depth`` int64, 0 … 2**32 - 2, is overwritten.
        """
        depth <<= _TRIANGLE_BITS
        depth |= runs.triangle.take(span)
        pixel = (runs.row * self._grid.width + runs.first).take(span)
        pixel += column
        np.minimum.at(self._least, pixel, depth)

    def visible(self) -> Visible:
        pixel = np.flatnonzero(self._least != _NOTHING)
        key = self._least.take(pixel)
        y, x = np.divmod(pixel, self._grid.width)
        return Visible(x, y, key & ((1 << _TRIANGLE_BITS) - 1), key >> _TRIANGLE_BITS)

    def picture(
        self,
        display_list: DisplayList,
        triangles: Triangles,
        visible: Visible,
        color: NDArray[np.uint8],
    ) -> Picture:
        """The finished picture; ``color`` uint8 (n, 3) of the visible pixels."""
        size = self._grid.height, self._grid.width
        picture = Picture(
            color=np.full((*size, 3), display_list.background, np.uint8),
            depth=np.full(size, display_list.depth_limit + 1, np.int64),
            winner=np.full(size, NO_PRIMITIVE, np.int32),
        )
        pixel = visible.y * self._grid.width + visible.x
        picture.color.reshape(-1, 3)[pixel] = color
        picture.depth.reshape(-1)[pixel] = visible.depth
        picture.winner.reshape(-1)[pixel] = triangles.primitive.take(visible.triangle)
        return picture
