"""Which pixels each triangle covers, by whole arrays, straight from the half-planes.

A pixel is covered when its centre is strictly inside the triangle or on a top
or left edge.  Everything is in integers, so it is exact.  The steps are

    display list → ``Triangles`` that can cover a centre → ``Extents`` of rows, or those that are
    not empty as ``Spans`` → fragments

and none of them loops over triangles, rows or pixels; large lists go through in
chunks, so the working set stays bounded.  This is written independently of
``triangle_setup``, whose edges a machine is told as a start and a step a row.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..specification.display_list import DisplayList
from ..specification.sampling_grid import Grid

Int64 = NDArray[np.int64]
Float64 = NDArray[np.float64]
#: int32 where the triangles are small enough, int64 otherwise.
Integers = NDArray[Any]

#: Rows and fragments handled at once: few enough that their arrays stay in the cache and
#: are handed out again by the allocator in place of fresh pages, which cost more than the
#: arithmetic; many enough to spread the cost of a numpy call.
ROW_LIMIT = 1 << 15
FRAGMENT_LIMIT = 1 << 15


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
        left = first_centre(x_low, grid.unit_x, grid.width)
        right = first_centre(x_high, grid.unit_x, grid.width)
        top = first_centre(y_low, grid.unit_y, grid.height)
        bottom = first_centre(y_high, grid.unit_y, grid.height)
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


def first_centre(coordinate: Integers, unit: int, limit: int) -> Integers:
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
    """One edge of each triangle, as a test on the columns of a row; float64 (n,) each.

    With E its edge function, positive inside, ``value`` is E at the triangle's
    first column and row, less 1 where the edge itself is outside; ``step_y`` is its
    change from row to row and ``fall`` its change from column to column, negated.
    Columns c, counted from the triangle's first, are inside up to value / fall where
    ``fall`` is positive, a right edge, and from value / fall on where it is negative.

    Within the triangle's box all of it is whole and below 2**46, which doubles hold
    as it is; and where a quotient of two such numbers is not whole, it is further
    from the next whole number than the rounding of a double reaches.
    """

    value: Float64
    step_y: Float64
    fall: Float64

    @classmethod
    def of(cls, triangles: Triangles, begin: int) -> _HalfPlane:
        grid = triangles.grid
        end = (begin + 1) % 3
        x, y = triangles.x, triangles.y
        direction = np.sign(triangles.double_area)
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
            value=np.where(level, np.inf, value - (fall > 0)),
            step_y=(run * grid.unit_y).astype(np.float64),
            fall=np.where(level, 1.0, fall * grid.unit_x),
        )


@dataclass(frozen=True, eq=False)
class Extents:
    """All rows of the boxes of the triangles ``begin`` … ``end`` - 1; int64 (n,) each.

    ``triangle`` counts in ``Triangles``, not in the display list.  In drawing order: triangles
    ascending, rows ascending within a triangle.  Columns ``first`` up to, without, ``beyond`` are
    covered: those at or after the row's left edge, and before its right one.  Where both edges lie
    between two centres the row is empty, and ``first`` equals ``beyond``.
    """

    begin: int
    end: int
    triangle: Int64
    row: Int64
    first: Int64
    beyond: Int64

    def __len__(self) -> int:
        return len(self.triangle)


def extents(triangles: Triangles, row_limit: int = ROW_LIMIT) -> Iterator[Extents]:
    """Every row of every box once, about ``row_limit`` at a time.

    A chunk holds whole triangles, so it may exceed the limit by one triangle's rows.
    """
    for begin, end, triangle, down, first, last in _bounds(triangles, row_limit):
        # A row beside the screen has its edges there; they are held to the box, which is on it.
        width = (triangles.right - triangles.left).take(triangle)
        left = triangles.left.take(triangle)
        yield Extents(
            begin,
            end,
            triangle,
            down + triangles.top.take(triangle),
            np.minimum(first, width).astype(np.int64) + left,
            np.maximum(last + 1, 0).astype(np.int64) + left,
        )


def spans(triangles: Triangles, row_limit: int = ROW_LIMIT) -> Iterator[Spans]:
    """Every covered pixel once per triangle, about ``row_limit`` rows at a time.

    A chunk holds whole triangles, so it may exceed the limit by one triangle's rows.
    """
    for _, _, triangle, down, first, last in _bounds(triangles, row_limit):
        last -= first
        filled = np.flatnonzero(last >= 0)
        triangle = triangle.take(filled)
        yield Spans(
            triangle=triangle,
            row=down.take(filled) + triangles.top.take(triangle),
            first=first.take(filled).astype(np.int64) + triangles.left.take(triangle),
            length=last.take(filled).astype(np.int64) + 1,
        )


def _bounds(
    triangles: Triangles, row_limit: int
) -> Iterator[tuple[int, int, Int64, Int64, Float64, Float64]]:
    """Of triangles ``begin`` … ``end`` - 1 the rows: triangle, rows below its first one, and the
    first and the last column inside, counted from the box's left; first > last where none is."""
    half_planes = [_HalfPlane.of(triangles, begin) for begin in range(3)]
    height = (triangles.bottom - triangles.top).astype(np.int64)
    ends = np.cumsum(height)
    begin = 0
    while begin < len(triangles):
        done = int(ends[begin - 1]) if begin else 0
        end = max(begin + 1, int(np.searchsorted(ends, done + row_limit, side="right")))
        yield begin, end, *_rows(triangles, half_planes, begin, end, height)
        begin = end


def _rows(
    triangles: Triangles, half_planes: list[_HalfPlane], begin: int, end: int, height: Int64
) -> tuple[Int64, Int64, Float64, Float64]:
    heights = height[begin:end]
    triangle = np.repeat(np.arange(begin, end), heights)
    starts = np.cumsum(heights) - heights
    down = np.arange(len(triangle)) - np.repeat(starts, heights)
    first = np.zeros(len(triangle))
    last = (triangles.right - triangles.left - 1).take(triangle).astype(np.float64)
    for edge in half_planes:
        bound = edge.step_y.take(triangle)
        bound *= down
        bound += edge.value.take(triangle)
        fall = edge.fall.take(triangle)
        bound /= fall
        right = fall > 0
        np.minimum(last, np.where(right, bound, np.inf), out=last)
        np.maximum(first, np.where(right, 0.0, bound), out=first)
    np.ceil(first, out=first)
    np.floor(last, out=last)
    return triangle, down, first, last
