"""What drawing a sphere consists of, whole or in a part of the screen, counted from one template.

All spheres are alike and their centres are on corners of pixels, so each is the same polygons,
lines and pixels, moved.  Counts in rectangles come from tables of sums, whatever the number of
spheres; nothing here loops over them.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .....golden.reference.coverage import Triangles, spans
from .....golden.scenes.built_in.sphere import subdivided_sphere
from .....golden.scenes.mesh import normalised
from .....golden.specification.display_list import DisplayList
from .....golden.specification.sampling_grid import Grid
from .spheres import sphere_reach

Float64 = NDArray[np.float64]
Int64 = NDArray[np.int64]

#: How often the icosahedron is cut: 20 · 4⁴ polygons.
CUTS = 4


@dataclass(frozen=True, eq=False)
class Work:
    """Arrays of one shape, int64: ``polygons`` of which some part is there, ``lines``, the runs of
    pixels that their scan lines are, and ``pixels``."""

    polygons: Int64
    lines: Int64
    pixels: Int64

    def __getitem__(self, index: Any) -> Work:
        return Work(self.polygons[index], self.lines[index], self.pixels[index])


def sphere_polygons(cuts: int = CUTS) -> Float64:
    """float64 (20 · 4**cuts, 3, 3): a unit sphere, an icosahedron whose faces become four again and
    again, the new vertices moved out to the sphere."""
    ratio = (1 + 5 ** 0.5) / 2
    vertices = normalised(np.array([
        corner for one in (-1.0, 1.0) for other in (-ratio, ratio)
        for corner in ((0.0, one, other), (one, other, 0.0), (other, 0.0, one))]))
    near = np.linalg.norm(vertices[:, None] - vertices[None], axis=2) < 1.1
    faces = np.array([(a, b, c) for a in range(12) for b in range(a + 1, 12)
                      for c in range(b + 1, 12) if near[a, b] and near[b, c] and near[a, c]])
    vertices, faces = subdivided_sphere(vertices, faces, cuts)
    return np.asarray(vertices[faces])


class SphereTemplate:
    """A sphere about the corner of a pixel, front and back: no method leaves the back out.

    ``polygons``  how many
    ``whole``     ``Work`` of each polygon by itself, (polygons,) each
    """

    def __init__(self, radius: float) -> None:
        self._reach = reach = sphere_reach(radius)
        corners = sphere_polygons()[..., :2] * radius + reach
        self.polygons = len(corners)
        low, high = (np.floor(ends).astype(np.int64)
                     for ends in (corners.min(axis=1), corners.max(axis=1)))
        self._first, self._last = (np.clip(ends, 0, 2 * reach - 1) for ends in (low, high))
        row, left, length, polygon = _covered(corners, 2 * reach)
        self._row, self._length, self._polygon = row, length, polygon
        self.whole = Work(np.ones(self.polygons, np.int64),
                          np.bincount(polygon, minlength=self.polygons),
                          np.bincount(polygon, length, self.polygons).astype(np.int64))
        side = 2 * reach
        ends = (left + length - 1)
        pixel_row = np.repeat(row, length)
        column = np.arange(len(pixel_row)) - np.repeat(np.cumsum(length) - length - left, length)
        self._pixels = _before(pixel_row, column, side)
        self._lines_from, self._lines_to = _before(row, left, side), _before(row, ends, side)
        (first_x, first_y), (last_x, last_y) = self._first.T, self._last.T
        self._boxes = {(y_end, x_end): _before(y, x, side)
                       for y_end, y in enumerate((first_y, last_y))
                       for x_end, x in enumerate((first_x, last_x))}

    def in_rectangles(self, left: Int64, top: Int64, right: Int64, bottom: Int64) -> Work:
        """Of the columns left … right - 1 and rows top … bottom - 1, counted from the centre;
        arrays of one shape."""
        x0, y0, x1, y1 = (np.clip(edge + self._reach, 0, 2 * self._reach)
                          for edge in (left, top, right, bottom))
        # A box meets the rows if its first one comes before their end and its last one does not
        # come before their beginning; likewise in columns.
        boxes = self._boxes
        polygons = (boxes[0, 0][y1, x1] - boxes[0, 1][y1, x0]
                    - boxes[1, 0][y0, x1] + boxes[1, 1][y0, x0])
        empty = (x0 >= x1) | (y0 >= y1)

        def within(table: Int64, x: Int64) -> Int64:
            return np.asarray(table[y1, x] - table[y0, x])

        lines = within(self._lines_from, x1) - within(self._lines_to, x0)
        pixels = within(self._pixels, x1) - within(self._pixels, x0)
        return Work(*(np.where(empty, 0, count) for count in (polygons, lines, pixels)))

    def in_lines(self, y: Int64, step: int) -> Work:
        """(len(y), step): of spheres whose centres are ``y`` rows down, in every ``step``-th line,
        from 0, from 1, …"""
        rows = 2 * self._reach
        first, last = self._first[:, 1], self._last[:, 1]
        # A polygon lies in at most ``step`` classes of lines, one each row from its first one on.
        high = np.minimum(last - first + 1, step)
        polygon = np.repeat(np.arange(self.polygons), high)
        offset = np.arange(len(polygon)) - np.repeat(np.cumsum(high) - high, high)
        of_class = Work(
            np.bincount((first[polygon] + offset) % step, minlength=step),
            np.bincount(self._row % step, minlength=step),
            np.bincount(self._row % step, self._length, step).astype(np.int64))
        # Line k of the screen is the template's k - y + reach.
        own = (np.arange(step) - y[:, None] + rows // 2) % step
        return of_class[own]


@cache
def sphere_template(radius: float) -> SphereTemplate:
    return SphereTemplate(radius)


def _covered(corners: Float64, side: int) -> tuple[Int64, Int64, Int64, Int64]:
    """Row, first column, length and polygon of every run of covered pixels."""
    sub_bits = 8
    position = np.round(corners * (1 << sub_bits)).astype(np.int32)
    count = len(position)
    listed = DisplayList(side, side, position, np.zeros((count, 3), np.int64),
                         np.zeros((count, 3, 3), np.uint8), sub_bits)
    triangles = Triangles.of(listed, Grid.of(listed))
    row, first, length, polygon = (np.concatenate(part) for part in zip(*(
        (found.row, found.first, found.length, triangles.primitive[found.triangle])
        for found in spans(triangles)), strict=True))
    return row, first, length, polygon


def _before(y: Int64, x: Int64, side: int) -> Int64:
    """int64 (side + 1, side + 1): at [j, i] how many have y < j and x < i."""
    table = np.zeros((side + 1, side + 1), np.int64)
    table[1:, 1:] = np.bincount(y * side + x, minlength=side * side).reshape(side, side)
    return np.asarray(table.cumsum(axis=0).cumsum(axis=1))
