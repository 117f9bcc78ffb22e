"""The reference picture: the mathematics of the picture contract, in integers.

A pixel's winner is the least (depth, primitive) of the fragments that fall on
it; depth and colour are the planes through the vertices at the pixel centre,
rounded half up.  Nothing is approximated, for any display list.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..specification.display_list import DisplayList, Shading, shading_for
from ..specification.errors import InputError
from ..specification.picture import Picture
from ..specification.sampling_grid import Grid
from .coverage import FRAGMENT_LIMIT, ROW_LIMIT, Spans, Triangles, spans
from .depth_buffer import DepthBuffer

Int64 = NDArray[np.int64]

#: Where a depth plane overflows 64 bits, vertex depths are split here.
_HALF_DEPTH_BITS = 16


@dataclass(frozen=True, eq=False)
class Fragments:
    """Pixels of primitives, in drawing order: primitive, then row, then column.

    ``primitive`` ``x`` ``y`` int32 (n,), ``depth`` int64 (n,), ``color`` uint8 (n, 3)
    """

    primitive: NDArray[np.int32]
    x: NDArray[np.int32]
    y: NDArray[np.int32]
    depth: Int64
    color: NDArray[np.uint8]

    def __len__(self) -> int:
        return len(self.primitive)


class _Geometry:
    """What every plane of a triangle shares; int64 (n,) each.

    The second and third vertex from the first, mirrored where they run
    anticlockwise; the centre of the first column and row from the first vertex.
    """

    def __init__(self, triangles: Triangles) -> None:
        grid = triangles.grid
        sign = np.sign(triangles.double_area)
        x, y = triangles.x, triangles.y
        self.x1, self.x2 = (sign * (x[vertex] - x[0]) for vertex in (1, 2))
        self.y1, self.y2 = (sign * (y[vertex] - y[0]) for vertex in (1, 2))
        self.right = (triangles.left * grid.unit_x + grid.unit_x // 2 - x[0]).astype(np.int64)
        self.down = (triangles.top * grid.unit_y + grid.unit_y // 2 - y[0]).astype(np.int64)
        self.area = abs(triangles.double_area)
        self.triangles = triangles


class _Plane:
    """The plane through one value per vertex, times D, the doubled area; (n,) each.

    ``value`` is the numerator at the triangle's first column and row plus
    floor(D/2), so that dividing by D rounds half up.  All of it is modulo 2**64:
    away from the triangle a numerator may be huge, but at a covered pixel it is
    between 0 and D times the largest vertex value, and if that fits, sums and
    products modulo 2**64 arrive at it whatever happened on the way.
    """

    def __init__(self, geometry: _Geometry, values: Int64) -> None:
        first, second, third = values.T
        rise1, rise2 = second - first, third - first
        slope_x = rise1 * geometry.y2 - rise2 * geometry.y1
        slope_y = rise2 * geometry.x1 - rise1 * geometry.x2
        self.value = first * geometry.area + geometry.area // 2
        self.value += slope_x * geometry.right
        self.value += slope_y * geometry.down
        self.step_x = slope_x * geometry.triangles.grid.unit_x
        self.step_y = slope_y * geometry.triangles.grid.unit_y

    def at(self, triangle: Int64, right: Int64, down: Int64) -> Int64:
        """The numerators ``right`` and ``down`` pixels from the first column and row."""
        result: Int64 = self.value.take(triangle)
        result += self.step_x.take(triangle) * right
        result += self.step_y.take(triangle) * down
        return result

    def along(self, runs: Spans, right: Int64, down: Int64, span: Int64, column: Int64) -> Int64:
        """The numerators of every fragment of ``runs``, which start at (right, down)."""
        result = self.at(runs.triangle, right, down).take(span)
        result += self.step_x.take(runs.triangle).take(span) * column
        return result


def _floor_quotient(numerator: NDArray[Any], divisor: NDArray[Any]) -> Int64:
    """floor(numerator / divisor) by doubles, several at once: not negative, divisor below 2**45.

    Exact for numerators below 2**52: a quotient that is not whole is at least 1 / divisor
    away from the next whole number q, and q * divisor <= 2**52 makes that more than the
    2**-53 * q by which a double may be off.
    """
    return np.asarray((numerator / divisor).astype(np.int64))


class _Depth:
    """Depth of every fragment, exact for every triangle."""

    def __init__(self, display_list: DisplayList, triangles: Triangles) -> None:
        geometry = _Geometry(triangles)
        self._triangles = triangles
        self._area = geometry.area
        depth = display_list.depth.take(triangles.primitive, axis=0)
        # One plane will do where D * (depth + 1), which bounds every covered
        # pixel's numerator plus floor(D/2), stays below 2**63.  Tested without overflow.
        limit = np.iinfo(np.int64).max // self._area
        greatest = depth.max(axis=1, initial=0)
        self.whole = bool((greatest < limit).all())
        self._doubles = bool((greatest < (1 << 52) // self._area).all())
        if self.whole:
            self._high = _Plane(geometry, depth)
        else:
            # depth = high * 2**16 + low, and planes are linear in the vertex
            # values.  At a covered pixel each half's numerator is from 0 to
            # D * (2**16 - 1) < 2**60, since D <= 2**44 in a guard band of 22 bits.
            self._high = _Plane(geometry, depth >> _HALF_DEPTH_BITS)
            self._low = _Plane(geometry, depth & ((1 << _HALF_DEPTH_BITS) - 1))

    def of(self, runs: Spans, span: Int64, column: Int64) -> Int64:
        """Depth of every fragment of ``runs``, from ``runs.expand()``."""
        triangles = self._triangles
        right = runs.first - triangles.left.take(runs.triangle)
        down = runs.row - triangles.top.take(runs.triangle)
        area = self._area.take(runs.triangle).take(span)
        high = self._high.along(runs, right, down, span, column)
        if self._doubles:
            return _floor_quotient(high, area)
        if self.whole:
            high //= area
            return high
        low = self._low.along(runs, right, down, span, column)
        # Both numerators carry floor(D/2); it must count once, with the low half.
        high -= area // 2
        # floor((high * 2**16 + low) / D) with high = quotient * D + rest is
        # quotient * 2**16 + floor((rest * 2**16 + low) / D): rest * 2**16 < 2**60.
        quotient, rest = np.divmod(high, area)
        return np.asarray((quotient << _HALF_DEPTH_BITS)
                          + ((rest << _HALF_DEPTH_BITS) + low) // area)  # fmt: skip


def _colors(
    display_list: DisplayList,
    triangles: Triangles,
    shading: Shading,
    triangle: Int64,
    x: Int64,
    y: Int64,
) -> NDArray[np.uint8]:
    """uint8 (n, 3): the colour of ``triangle`` (a number in ``triangles``) at pixel (x, y)."""
    primitive = triangles.primitive.take(triangle)
    if shading == "flat":
        return display_list.color[:, 0].take(primitive, axis=0)
    grid = triangles.grid
    x0, x1, x2 = (corner.take(triangle) for corner in triangles.x)
    y0, y1, y2 = (corner.take(triangle) for corner in triangles.y)
    across = x * grid.unit_x + grid.unit_x // 2 - x0
    below = y * grid.unit_y + grid.unit_y // 2 - y0
    # Twice the areas that the centre makes with two edges: the weights, times the
    # doubled area, of the second and third vertex.  Below 2**45, and 255 times
    # that below 2**53, so doubles hold every sum and product as it is.
    double_area = triangles.double_area.take(triangle).astype(np.float64)
    second = (across * (y2 - y0) - below * (x2 - x0)).astype(np.float64)
    third = (below * (x1 - x0) - across * (y1 - y0)).astype(np.float64)
    first = double_area - second - third
    # floor(D/2), with the sign of the area that all the rest carries.
    half = np.trunc(double_area / 2)
    vertex_color = display_list.color.reshape(-1, 9).take(primitive, axis=0)
    color = np.empty((len(triangle), 3), np.uint8)
    for channel in range(3):
        numerator = first * vertex_color[:, channel]
        numerator += vertex_color[:, 3 + channel] * second
        numerator += vertex_color[:, 6 + channel] * third
        numerator += half
        color[:, channel] = _floor_quotient(numerator, double_area)
    return color


def draw(
    display_list: DisplayList,
    *,
    shading: Shading | None = None,
    x_shift: int = 0,
    y_shift: int = 0,
    fragment_limit: int = FRAGMENT_LIMIT,
    row_limit: int = ROW_LIMIT,
) -> Picture:
    """The picture of ``display_list`` at the resolution ``Grid.of`` gives.

    ``shading`` "flat" takes each triangle's first vertex colour; the default
    interpolates unless every triangle has one colour.  The limits bound the
    working set and do not change the picture.
    """
    shading = shading_for(display_list, shading)
    grid = Grid.of(display_list, x_shift, y_shift)
    triangles = Triangles.of(display_list, grid)
    depth = _Depth(display_list, triangles)
    buffer = DepthBuffer(grid)
    for rows in spans(triangles, row_limit):
        for runs in rows.chunks(fragment_limit):
            span, column = runs.expand()
            buffer.add(runs, span, column, depth.of(runs, span, column))
    return buffer.picture(
        display_list, triangles,
        lambda seen: _colors(display_list, triangles, shading, seen.triangle, seen.x, seen.y))


def fragments(
    display_list: DisplayList,
    *,
    shading: Shading | None = None,
    x_shift: int = 0,
    y_shift: int = 0,
    pixel: tuple[int, int] | None = None,
) -> Fragments:
    """Every fragment of the list in drawing order, hidden ones too.

    With ``pixel`` (x, y) only those that fell on it.  ``InputError`` for a
    pixel outside the picture.
    """
    shading = shading_for(display_list, shading)
    grid = Grid.of(display_list, x_shift, y_shift)
    if pixel is not None and not (0 <= pixel[0] < grid.width and 0 <= pixel[1] < grid.height):
        raise InputError(f"pixel: {pixel} is outside the picture of {grid.width}x{grid.height}")
    triangles = Triangles.of(display_list, grid)
    depth = _Depth(display_list, triangles)
    parts: list[Fragments] = []
    for rows in spans(triangles):
        wanted = rows if pixel is None else rows.at(*pixel)
        for runs in wanted.chunks(FRAGMENT_LIMIT):
            span, column = runs.expand()
            triangle = runs.triangle.take(span)
            x, y = runs.first.take(span) + column, runs.row.take(span)
            parts.append(Fragments(
                primitive=triangles.primitive.take(triangle).astype(np.int32),
                x=x.astype(np.int32),
                y=y.astype(np.int32),
                depth=depth.of(runs, span, column),
                color=_colors(display_list, triangles, shading, triangle, x, y),
            ))  # fmt: skip
    if not parts:
        none = np.zeros(0, np.int32)
        return Fragments(none, none, none, np.zeros(0, np.int64), np.zeros((0, 3), np.uint8))
    return Fragments(*(
        np.concatenate([getattr(part, name) for part in parts])
        for name in ("primitive", "x", "y", "depth", "color")
    ))  # fmt: skip


def depth_complexity(
    display_list: DisplayList, *, x_shift: int = 0, y_shift: int = 0
) -> NDArray[np.int32]:
    """int32 (height, width): how many fragments fell on each pixel."""
    grid = Grid.of(display_list, x_shift, y_shift)
    # One more where a span begins and one less where it has ended, summed along
    # the row; the extra column takes the ends of spans that reach the edge.
    change = np.zeros((grid.height, grid.width + 1), np.int32)
    size = change.size
    for runs in spans(Triangles.of(display_list, grid)):
        begin = runs.row * (grid.width + 1) + runs.first
        change.reshape(-1)[:] += np.bincount(begin, minlength=size).astype(np.int32)
        change.reshape(-1)[:] -= np.bincount(begin + runs.length, minlength=size).astype(np.int32)
    return np.cumsum(change[:, :-1], axis=1, dtype=np.int32)
