"""The winner of every pixel, collected from fragments in any order."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ..specification.display_list import DisplayList
from ..specification.picture import NO_PRIMITIVE, Picture
from ..specification.sampling_grid import Grid
from .coverage import Spans, Triangles

Int64 = NDArray[np.int64]

#: A fragment's key is its depth, at most 32 bits, above its triangle's number.
#: Triangles keep the drawing order, so the least key is the least (depth, primitive).
_TRIANGLE_BITS = 31
_NOTHING = np.iinfo(np.int64).max

#: Pixels finished at once.
PIXEL_LIMIT = 1 << 14


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

    def picture(
        self,
        display_list: DisplayList,
        triangles: Triangles,
        color_of: Callable[[Visible], NDArray[np.uint8]],
    ) -> Picture:
        """The finished picture; ``color_of`` gives uint8 (n, 3), the colours of n pixels.

        ``color_of`` is asked for some rows of the picture at a time, so that the arrays it
        computes them with stay small.
        """
        grid = self._grid
        size = grid.height, grid.width
        picture = Picture(
            color=np.full((*size, 3), display_list.background, np.uint8),
            depth=np.full(size, display_list.depth_limit + 1, np.int64),
            winner=np.full(size, NO_PRIMITIVE, np.int32),
        )
        rows = max(1, PIXEL_LIMIT // grid.width)
        for top in range(0, grid.height, rows):
            visible = self._visible(top, min(top + rows, grid.height))
            pixel = visible.y * grid.width + visible.x
            picture.color.reshape(-1, 3)[pixel] = color_of(visible)
            picture.depth.reshape(-1)[pixel] = visible.depth
            picture.winner.reshape(-1)[pixel] = triangles.primitive.take(visible.triangle)
        return picture

    def _visible(self, top: int, bottom: int) -> Visible:
        width = self._grid.width
        least = self._least[top * width : bottom * width]
        pixel = np.flatnonzero(least != _NOTHING)
        key = least.take(pixel)
        y = (pixel / width).astype(np.int64)  # of such small numbers, and five times as fast as //
        return Visible(x=pixel - y * width, y=y + top,
                       triangle=key & ((1 << _TRIANGLE_BITS) - 1), depth=key >> _TRIANGLE_BITS)
