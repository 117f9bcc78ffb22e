"""Triangle set-up, bit for bit: what a machine is told about each triangle.

Per triangle: the rows and columns it may touch, three edges, and per interpolant a
start and two increments, rounded half up at ``2**-fraction_bits`` and kept modulo a
power of two.  An edge is known as a quotient and a remainder; a machine carries it in
fixed point, with as many fraction bits as make every column exact (``carry_edges``).

Widths at which every triangle fits (``widths``, and below), b the display list's coordinate
bits, s its sub-pixel bits:

    edge column      ``edge_column_bits``      b - s + 1, signed
    edge height      ``edge_height_bits``      b, unsigned; an edge's remainder as well
    edge word        column bits + ``edge_fraction_bits``
    depth word       ``depth_word_bits``       depth bits + guard + fraction bits
    colour word      ``color_word_bits``       8 + guard + fraction bits

The guard is for the highest resolution, at whatever resolution the machine draws.  A machine
that needs none (``fixed_point.stays_in_range``), or is for one scene (``scene_needs``), has
narrower words: it keeps the low bits of these.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..specification import fixed_point
from ..specification.display_list import DisplayList, Shading, shading_for
from ..specification.ranges import CHANNEL_BITS
from ..specification.sampling_grid import Grid

Int64 = NDArray[np.int64]

def depth_word_bits(depth_bits: int, fraction_bits: int, width: int, height: int) -> int:
    """Width of carried depth at which every triangle of a ``width`` x ``height`` screen fits."""
    guard = fixed_point.guard_bits(depth_bits, fraction_bits, width + height - 2)
    return depth_bits + guard + fraction_bits


def color_word_bits(fraction_bits: int, width: int, height: int) -> int:
    """Width of a carried colour channel at which every triangle of the screen fits."""
    return depth_word_bits(CHANNEL_BITS, fraction_bits, width, height)


@dataclass(frozen=True, eq=False)
class Edges:
    """One edge of each triangle, as stepped downwards; int64 (n,) each.

    On the first row of its part ``column`` is the first pixel whose centre does
    not lie left of the edge.  From row to row::

        column += column_step; remainder += remainder_step
        if remainder >= denominator: remainder -= denominator; column += 1

    ``column`` is signed and not held to the screen; on rows of the edge's part
    it fits ``edge_column_bits``.  ``column_step`` of an edge less than two rows
    high may be larger, but then no step's result is used: a machine keeps it
    modulo ``2**edge_column_bits``.  0 <= remainder, remainder_step < denominator.
    An edge without rows has column, remainder and steps 0 and denominator 1.
    """

    column: Int64
    remainder: Int64
    column_step: Int64
    remainder_step: Int64
    denominator: Int64


@dataclass(frozen=True, eq=False)
class CarriedEdges:
    """The same edges as a machine carries them; int64 (n,), modulo ``2**word_bits``.

    The column on the edge's row r, counted from its first, is
    ``start + r * step`` modulo ``2**word_bits``, its fraction bits dropped, read as signed.
    """

    start: Int64
    step: Int64
    word_bits: int


@dataclass(frozen=True, eq=False)
class Planes:
    """One interpolant of each triangle: object arrays (n,) of ints in [0, 2**word_bits).

    The carried value at pixel (x, y) is
    ``start + (x - left) * step_x + (y - top) * step_y`` modulo ``2**word_bits``.
    """

    start: NDArray[Any]
    step_x: NDArray[Any]
    step_y: NDArray[Any]
    word_bits: int


@dataclass(frozen=True, eq=False)
class PreparedTriangles:
    """The triangles that may cover a pixel centre, in drawing order; arrays of n.

    ``primitive``       int32: index in the display list, increasing
    ``top`` ``middle`` ``bottom`` ``left`` ``right``   int64, 0 … height or width:
                        rows top … bottom-1 and columns left … right-1 hold every
                        covered pixel; top < bottom, left < right.  Rows top … middle-1
                        lie between ``long`` and ``upper``, middle … bottom-1
                        between ``long`` and ``lower``; ``long`` begins at ``top``.
    ``long_edge_left``  bool: the long edge bounds the span on the left.  A span
                        covers columns from the left edge's up to, without, the
                        right edge's, held to left … right; it may be empty.
    ``depth``           carried depth
    ``color``           carried red, green, blue, or None when shading is flat
    ``flat_color``      uint8 (n, 3), the first vertex's, or None when shading is Gouraud
    ``grid``            the machine's resolution
    ``fraction_bits``   F of every plane
    """

    primitive: NDArray[np.int32]
    top: Int64
    middle: Int64
    bottom: Int64
    left: Int64
    right: Int64
    long_edge_left: NDArray[np.bool_]
    long: Edges
    upper: Edges
    lower: Edges
    depth: Planes
    color: tuple[Planes, Planes, Planes] | None
    flat_color: NDArray[np.uint8] | None
    grid: Grid
    fraction_bits: int

    def __len__(self) -> int:
        return len(self.primitive)


@dataclass(frozen=True, eq=False)
class Boxes:
    """The triangles that have area and a box of pixel centres on the screen."""

    primitive: Int64
    position: Int64
    double_area: Int64
    clockwise: NDArray[np.bool_]
    left: Int64
    right: Int64
    top: Int64
    bottom: Int64

    @property
    def extent(self) -> Int64:
        """The greatest x + y within each box, from its corner."""
        return np.asarray(self.right - 1 - self.left + self.bottom - 1 - self.top)


@dataclass(frozen=True, eq=False)
class Outlines:
    """What ``PreparedTriangles`` says of the triangles' places; arrays of n in the same order.

    ``boxes`` has ``primitive``, ``left``, ``right``, ``top`` and ``bottom``.
    """

    boxes: Boxes
    middle: Int64
    long_edge_left: NDArray[np.bool_]
    long: Edges
    upper: Edges
    lower: Edges


def _doubled_area(position: Int64) -> Int64:
    """Twice the signed area, positive when clockwise as seen (y grows downwards)."""
    (x0, y0), (x1, y1), (x2, y2) = (position[:, vertex].T for vertex in range(3))
    # b bits a coordinate: differences b + 1, products 2b + 2 <= 46 bits.
    return np.asarray((x1 - x0) * (y2 - y0) - (x2 - x0) * (y1 - y0))


def _first_centre(coordinate: Int64, unit: int, limit: int) -> Int64:
    """The first pixel whose centre is not before ``coordinate``, held to 0 … limit."""
    return np.clip(fixed_point.ceil_divide(coordinate - unit // 2, unit), 0, limit)


def _boxes(display_list: DisplayList, grid: Grid) -> Boxes:
    position = display_list.position.astype(np.int64)
    area = _doubled_area(position)
    low, high = position.min(axis=1), position.max(axis=1)
    left = _first_centre(low[:, 0], grid.unit_x, grid.width)
    right = _first_centre(high[:, 0], grid.unit_x, grid.width)
    top = _first_centre(low[:, 1], grid.unit_y, grid.height)
    bottom = _first_centre(high[:, 1], grid.unit_y, grid.height)
    kept = np.flatnonzero((area != 0) & (left < right) & (top < bottom))
    return Boxes(kept, position[kept], abs(area[kept]), area[kept] > 0,
                  left[kept], right[kept], top[kept], bottom[kept])  # fmt: skip


def scene_fraction_bits(display_list: DisplayList, *, x_shift: int = 0, y_shift: int = 0) -> int:
    """The fewest fraction bits at which every triangle of the list is exact; 0 for none."""
    boxes = _boxes(display_list, Grid.of(display_list, x_shift, y_shift))
    return int(fixed_point.exact_fraction_bits(boxes.double_area, boxes.extent).max(initial=0))


def _edges(begin: Int64, end: Int64, row: Int64, rows: Int64, grid: Grid) -> Edges:
    """The edge from ``begin`` down to ``end`` (both (n, 2)), first used on ``row``."""
    used = rows > 0
    x, y = begin.T
    run, height = end[:, 0] - x, end[:, 1] - y
    # Where the edge has rows its height is positive; elsewhere anything will do.
    height = np.where(used, height, 1)
    half_x, half_y = grid.unit_x // 2, grid.unit_y // 2
    # The boundary is ceil(m / (unit_x * height)), m growing by unit_y * run a
    # row.  unit_y is unit_x times 1 or 2, so ceil(m / unit_x) grows by a whole
    # number a row, and the two ceilings may be taken one after the other.
    # Twice b + 1 bits, summed: 48 bits at most.
    distance = row * grid.unit_y + half_y - y
    numerator = fixed_point.ceil_divide((x - half_x) * height + distance * run, grid.unit_x)
    step = run << (grid.y_shift - grid.x_shift)
    # ceil(t / height) = floor((t + height - 1) / height) leaves a remainder to carry.
    column, remainder = np.divmod(numerator + height - 1, height)
    column_step, remainder_step = np.divmod(step, height)
    zero = np.int64(0)
    return Edges(
        column=np.where(used, column, zero),
        remainder=np.where(used, remainder, zero),
        column_step=np.where(used, column_step, zero),
        remainder_step=np.where(used, remainder_step, zero),
        denominator=height,
    )


def carry_edges(edges: Edges, *, column_bits: int, fraction_bits: int) -> CarriedEdges:
    """Edges in fixed point: the column and the middle of its remainder's slot, and the step.

    column + (remainder + 1/2) / denominator floors to the column, and so it does after
    every step, as long as rounding moves it by less than half a slot.  Both numbers are
    rounded half up at ``2**-fraction_bits``; ``column_bits`` are kept above the point.
    ``column_bits`` + ``fraction_bits`` is at most 61.
    """
    word_bits = column_bits + fraction_bits

    def rounded(quotient: Int64, doubled_remainder: Int64) -> Int64:
        # floor(y + 1/2) = (floor(2y) + 1) >> 1, with floor(2y) from the part below the
        # denominator and the part above it: below 2**61, and modulo 2**(word_bits + 1).
        fraction = (doubled_remainder << fraction_bits) // edges.denominator
        whole = fixed_point.wrap(quotient, column_bits) << (fraction_bits + 1)
        return np.asarray(fixed_point.wrap((whole + fraction + 1) >> 1, word_bits))

    return CarriedEdges(
        start=rounded(edges.column, 2 * edges.remainder + 1),
        step=rounded(edges.column_step, 2 * edges.remainder_step),
        word_bits=word_bits,
    )


class _PlaneSolver:
    """Turns three vertex values of each triangle into start and increments."""

    def __init__(self, boxes: Boxes, grid: Grid, fraction_bits: int) -> None:
        x, y = boxes.position[:, :, 0], boxes.position[:, :, 1]
        sign = np.where(boxes.clockwise, 1, -1)
        self._x1, self._x2 = (sign * (x[:, vertex] - x[:, 0]) for vertex in (1, 2))
        self._y1, self._y2 = (sign * (y[:, vertex] - y[:, 0]) for vertex in (1, 2))
        half_x, half_y = grid.unit_x // 2, grid.unit_y // 2
        self._offset_x = (boxes.left * grid.unit_x + half_x - x[:, 0]).astype(object)
        self._offset_y = (boxes.top * grid.unit_y + half_y - y[:, 0]).astype(object)
        self._area = boxes.double_area.astype(object)
        self._grid = grid
        self._fraction_bits = fraction_bits

    def solve(self, value: Int64, word_bits: int) -> Planes:
        """The planes through ``value`` (n, 3), numerators over the doubled area."""
        rise1, rise2 = value[:, 1] - value[:, 0], value[:, 2] - value[:, 0]
        # Depth and coordinate differences, one product and a sum: 33 + 23 + 1 bits.
        slope_x = (rise1 * self._y2 - rise2 * self._y1).astype(object)
        slope_y = (rise2 * self._x1 - rise1 * self._x2).astype(object)
        # Numerators of 2b + d + 2 bits, doubled and scaled 2b + d + 3 + F: Python ints.
        area = self._area
        numerator = (value[:, 0].astype(object) * area
                     + slope_x * self._offset_x + slope_y * self._offset_y)  # fmt: skip
        # The value to be floored is (numerator + floor(area/2)) / area, a multiple
        # of 1/area; carry it half such a step higher, so that errors either way
        # below half a step floor alike.
        biased = 2 * numerator + 2 * (area // 2) + 1

        def rounded(dividend: NDArray[Any], divisor: NDArray[Any]) -> NDArray[Any]:
            scaled = dividend << self._fraction_bits
            return fixed_point.wrap(fixed_point.round_half_up_divide(scaled, divisor), word_bits)

        return Planes(
            start=rounded(biased, 2 * area),
            step_x=rounded(slope_x * self._grid.unit_x, area),
            step_y=rounded(slope_y * self._grid.unit_y, area),
            word_bits=word_bits,
        )


def outline(display_list: DisplayList, grid: Grid) -> Outlines:
    """Boxes and edges of every triangle that may cover a pixel centre of ``grid``."""
    boxes = _boxes(display_list, grid)
    order = np.argsort(boxes.position[:, :, 1], axis=1, kind="stable")
    by_height = np.take_along_axis(boxes.position, order[:, :, None], axis=1)
    upper_vertex, middle_vertex, lower_vertex = (by_height[:, vertex] for vertex in range(3))
    middle = _first_centre(middle_vertex[:, 1], grid.unit_y, grid.height)
    top, bottom = boxes.top, boxes.bottom
    return Outlines(
        boxes=boxes,
        middle=middle,
        # The middle vertex lies right of the long edge: the turn is clockwise.
        long_edge_left=_doubled_area(by_height) > 0,
        long=_edges(upper_vertex, lower_vertex, top, bottom - top, grid),
        upper=_edges(upper_vertex, middle_vertex, top, middle - top, grid),
        lower=_edges(middle_vertex, lower_vertex, middle, bottom - middle, grid),
    )


def prepare(
    display_list: DisplayList,
    *,
    fraction_bits: int,
    shading: Shading = "gouraud",
    x_shift: int = 0,
    y_shift: int = 0,
) -> PreparedTriangles:
    """Set up every triangle that may cover a pixel centre of the machine's grid.

    Triangles without area, or whose box holds no pixel centre, are left out.
    Raises ``InputError`` for fraction bits or shifts out of range, or unknown shading.
    """
    fixed_point.check_fraction_bits(fraction_bits)
    grid = Grid.of(display_list, x_shift, y_shift)
    outlines = outline(display_list, grid)
    boxes = outlines.boxes

    solver = _PlaneSolver(boxes, grid, fraction_bits)
    # Wide enough for every machine: one that lost memory units draws fewer pixels
    # in words as wide, one for a single scene keeps the low bits that it has.
    screen = display_list.width, display_list.height
    word_bits = depth_word_bits(display_list.depth_bits, fraction_bits, *screen)
    color: tuple[Planes, Planes, Planes] | None = None
    flat_color: NDArray[np.uint8] | None = None
    vertex_color = display_list.color[boxes.primitive]
    if shading_for(display_list, shading) == "gouraud":
        channels = vertex_color.astype(np.int64)
        red, green, blue = (
            solver.solve(channels[:, :, channel], color_word_bits(fraction_bits, *screen))
            for channel in range(3)
        )
        color = red, green, blue
    else:
        flat_color = vertex_color[:, 0]
    return PreparedTriangles(
        primitive=boxes.primitive.astype(np.int32),
        top=boxes.top,
        middle=outlines.middle,
        bottom=boxes.bottom,
        left=boxes.left,
        right=boxes.right,
        long_edge_left=outlines.long_edge_left,
        long=outlines.long,
        upper=outlines.upper,
        lower=outlines.lower,
        depth=solver.solve(display_list.depth[boxes.primitive], word_bits),
        color=color,
        flat_color=flat_color,
        grid=grid,
        fraction_bits=fraction_bits,
    )


def in_finer_words(prepared: PreparedTriangles, fraction_bits: int) -> PreparedTriangles:
    """The same planes with more fraction bits, which are zero.

    A machine with ``fraction_bits`` draws them as one with ``prepared.fraction_bits`` would,
    value for value: sums of multiples of a power of two are such multiples.
    """
    more = fraction_bits - prepared.fraction_bits
    if more < 0:
        raise ValueError(f"{prepared.fraction_bits} fraction bits do not fit in {fraction_bits}")

    def finer(planes: Planes) -> Planes:
        return Planes(planes.start << more, planes.step_x << more, planes.step_y << more,
                      planes.word_bits + more)

    color = prepared.color
    return replace(
        prepared,
        depth=finer(prepared.depth),
        color=None if color is None else (finer(color[0]), finer(color[1]), finer(color[2])),
        fraction_bits=fraction_bits,
    )

