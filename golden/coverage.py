"""Which pixels each triangle covers, by whole arrays, straight from the half-planes.

A pixel is covered when its centre is strictly inside the triangle or on a top
or left edge.  Everything is in integers, so it is exact.  The steps are

    display list → ``Triangles`` that can cover a centre → ``Spans`` of rows → fragments

and none of them loops over triangles, rows or pixels; large lists go through in
chunks, so the working set stays bounded.  This is written independently of
``setup``, which steps edges as the hardware does.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .display_list import DisplayList
from .grid import Grid

Int64 = NDArray[np.int64]
#: int32 where the triangles are small enough, int64 otherwise.
Integers = NDArray[Any]

#: Rows and fragments handled at once: small enough to stay in the cache, large
#: enough that the cost of a numpy call is spread over many elements.
ROW_LIMIT = 1 << 18
FRAGMENT_LIMIT = 1 << 18


@dataclass(frozen=True, eq=False)
class Triangles:
    """The triangles with area whose box holds a pixel centre, in drawing order; n of them.

    ``primitive``    int64 (n,): index in the display list, increasing
    ``x`` ``y``      int32 or int64 (3, n): vertices, in the display list's order
    ``double_area``  int64 (n,): twice the area in square sub-pixel units, negative
                     when the vertices run anticlockwise as seen
    ``left`` ``right`` ``top`` ``bottom``  int32 or int64 (n,): columns left … right-1
                     and rows top … bottom-1 hold every covered pixel

    The dtype of the coordinates is wide enough for every edge function within the box.
    """

    primitive: Int64
    x: Integers
    y: Integers
    double_area: Int64
    left: Integers
    right: Integers
    top: Integers
    bottom: Integers
    grid: Grid

    @classmethod
    def of(cls, display_list: DisplayList, grid: Grid) -> Triangles:
        """Leave out what cannot cover a pixel: most of a fine mesh, cheaply and early."""
        corners = np.ascontiguousarray(display_list.position.reshape(-1, 6).T)
        x, y = corners[0::2], corners[1::2]
        x_low, x_high = _range(x)
        y_low, y_high = _range(y)
        left = _first_centre(x_low, grid.unit_x, grid.width)
        right = _first_centre(x_high, grid.unit_x, grid.width)
        top = _first_centre(y_low, grid.unit_y, grid.height)
        bottom = _first_centre(y_high, grid.unit_y, grid.height)
        kept = np.flatnonzero((left < right) & (top < bottom))

        # Within the box of a triangle of size S (and its pixels lie within it)
        # an edge function is at most 2 S², and a step at most S times the unit.
        size = int(max((x_high[kept] - x_low[kept]).max(initial=0),
                       (y_high[kept] - y_low[kept]).max(initial=0)))  # fmt: skip
        unit = max(grid.unit_x, grid.unit_y)
        dtype = np.int32 if 4 * size * max(size, unit) < 1 << 31 else np.int64
        x, y = x.take(kept, axis=1).astype(dtype), y.take(kept, axis=1).astype(dtype)
        double_area = (x[1] - x[0]) * (y[2] - y[0]) - (x[2] - x[0]) * (y[1] - y[0])
        if not double_area.all():
            solid = np.flatnonzero(double_area)
            kept, x, y = kept.take(solid), x.take(solid, axis=1), y.take(solid, axis=1)
            double_area = double_area.take(solid)
        return cls(
            primitive=kept,
            x=x,
            y=y,
            double_area=double_area.astype(np.int64),
            left=left.take(kept).astype(dtype),
            right=right.take(kept).astype(dtype),
            top=top.take(kept).astype(dtype),
            bottom=bottom.take(kept).astype(dtype),
            grid=grid,
        )

    def __len__(self) -> int:
        return len(self.primitive)


def _range(values: Integers) -> tuple[Integers, Integers]:
    first, second, third = values
    return (np.minimum(np.minimum(first, second), third),
            np.maximum(np.maximum(first, second), third))  # fmt: skip


def _first_centre(coordinate: Integers, unit: int, limit: int) -> Integers:
    """The first pixel whose centre is not before ``coordinate``, held to 0 … limit.

    ceil((c - unit/2) / unit) = floor((c + unit/2 - 1) / unit), a shift.
    """
    shift = unit.bit_length() - 1
    return np.asarray(np.clip((coordinate + (unit // 2 - 1)) >> shift, 0, limit))


@dataclass(frozen=True, eq=False)
class Spans:
    """Runs of covered pixels, each of one triangle in one row; int64 (n,) each.

    ``triangle`` counts in ``Triangles``, not in the display list.  In drawing
    order: triangles ascending, rows ascending within a triangle.  No span is empty.
    """

    triangle: Int64
    row: Int64
    first: Int64
    length: Int64

    def __len__(self) -> int:
        return len(self.triangle)

    def at(self, x: int, y: int) -> Spans:
        """One-pixel spans at (x, y), of the triangles that cover it."""
        here = np.flatnonzero((self.row == y) & (self.first <= x) & (x < self.first + self.length))
        return Spans(self.triangle[here], self.row[here],
                     np.full(len(here), x), np.ones(len(here), np.int64))  # fmt: skip

    def chunks(self, limit: int) -> Iterator[Spans]:
        """The same spans in order, at most ``limit`` fragments (or one span) at a time."""
        ends = np.cumsum(self.length)
        begin = 0
        while begin < len(self):
            done = int(ends[begin - 1]) if begin else 0
            end = max(begin + 1, int(np.searchsorted(ends, done + limit, side="right")))
            yield Spans(self.triangle[begin:end], self.row[begin:end],
                        self.first[begin:end], self.length[begin:end])  # fmt: skip
            begin = end

    def expand(self) -> tuple[Int64, Int64]:
        """For every fragment the index of its span, and its column counted from ``first``."""
        span = np.repeat(np.arange(len(self)), self.length)
        starts = np.cumsum(self.length) - self.length
        return span, np.arange(len(span)) - starts.take(span)


@dataclass(frozen=True, eq=False)
class _HalfPlane:
    """One edge of each triangle, as a test on the columns of a row; (n,) each.

    With E its edge function, not negative inside, ``value`` is E at the
    triangle's first column and row less 1 where the edge itself is outside,
    ``step_y`` its change from row to row and ``step_x`` the size of its change
    from column to column.  A left edge bounds columns c, counted from the
    triangle's first, by ``c >= -floor(value / step_x)``; a right edge by
    ``c < floor(value / step_x) + 1``.  ``not_left`` and ``not_right`` are 0 for
    an edge that is one, else larger than any quotient.
    """

    value: Integers
    step_x: Integers
    step_y: Integers
    not_left: Integers
    not_right: Integers

    @classmethod
    def of(cls, triangles: Triangles, begin: int) -> _HalfPlane:
        grid, dtype = triangles.grid, triangles.x.dtype
        never = dtype.type(1) << dtype.type(30 if dtype == np.int32 else 60)
        end = (begin + 1) % 3
        x, y = triangles.x, triangles.y
        direction = np.where(triangles.double_area > 0, 1, -1).astype(dtype)
        # Clockwise, the inside of the edge has (run)(Y - y) - (fall)(X - x) > 0.
        run = (x[end] - x[begin]) * direction
        fall = (y[end] - y[begin]) * direction
        centre_x = triangles.left * grid.unit_x + grid.unit_x // 2
        centre_y = triangles.top * grid.unit_y + grid.unit_y // 2
        value = run * (centre_y - y[begin]) - fall * (centre_x - x[begin])
        # Upwards is a left edge, which belongs to the triangle; downwards a
        # right one, which does not.  Level edges are top or bottom: the rows of
        # the box already keep the one and leave out the other, so it bounds nothing.
        level = fall == 0
        return cls(
            value=np.where(level, 0, value - (fall > 0)),
            step_x=np.where(level, 1, abs(fall) * grid.unit_x),
            step_y=np.where(level, 0, run * grid.unit_y),
            not_left=np.where(fall < 0, 0, never),
            not_right=np.where(fall > 0, 0, never),
        )


def spans(triangles: Triangles, row_limit: int = ROW_LIMIT) -> Iterator[Spans]:
    """Every covered pixel once per triangle, about ``row_limit`` rows at a time.

    A chunk holds whole triangles, so it may exceed the limit by one triangle's rows.
    """
    half_planes = [_HalfPlane.of(triangles, begin) for begin in range(3)]
    height = (triangles.bottom - triangles.top).astype(np.int64)
    ends = np.cumsum(height)
    begin = 0
    while begin < len(triangles):
        done = int(ends[begin - 1]) if begin else 0
        end = max(begin + 1, int(np.searchsorted(ends, done + row_limit, side="right")))
        yield _rows(triangles, half_planes, begin, end, height)
        begin = end


def _rows(
    triangles: Triangles, half_planes: list[_HalfPlane], begin: int, end: int, height: Int64
) -> Spans:
    """The spans of triangles ``begin`` … ``end`` - 1."""
    heights = height[begin:end]
    triangle = np.repeat(np.arange(begin, end), heights)
    starts = np.cumsum(heights) - heights
    down = np.arange(len(triangle)) - np.repeat(starts, heights)
    down_narrow = down.astype(triangles.x.dtype)
    from_left, from_right = None, None
    for edge in half_planes:
        value = edge.value.take(triangle)
        value += edge.step_y.take(triangle) * down_narrow
        value //= edge.step_x.take(triangle)
        left, right = value + edge.not_left.take(triangle), value + edge.not_right.take(triangle)
        from_left = left if from_left is None else np.minimum(from_left, left)
        from_right = right if from_right is None else np.minimum(from_right, right)
    assert from_left is not None and from_right is not None
    box_left = triangles.left.take(triangle)
    first = np.maximum(-from_left, 0)
    beyond = np.minimum(from_right, triangles.right.take(triangle) - box_left - 1) + 1
    length = beyond - first
    filled = np.flatnonzero(length > 0)
    triangle = triangle.take(filled)
    return Spans(
        triangle=triangle,
        row=down.take(filled) + triangles.top.take(triangle),
        first=(box_left + first).take(filled).astype(np.int64),
        length=length.take(filled).astype(np.int64),
    )
