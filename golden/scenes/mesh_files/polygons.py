"""Polygons to triangles.

A convex quadrangle is cut along its shorter diagonal.  Any other polygon is seen along its
normal and cut by ``mapbox_earcut``; convex ones of as many corners share one cut.  What has
no area, or crosses itself, has no triangles that would be right: it is left out, and counted.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache
from typing import Any, Final

import mapbox_earcut
import numpy as np
from numpy.typing import NDArray

from ..mesh import DEGENERATE_RATIO, cross, dot, length, normalised
from .reading import Reading, check_indices

#: A triangle below this part of the area of its polygon counts as none.
NO_AREA: Final = 1e-12

#: The triangles may differ from the area of the polygon by this part of it.
AREA_TOLERANCE: Final = 1e-9

#: Diagonals of a rectangle differ by rounding only.
SAME_LENGTH: Final = 1e-6

#: Corners worked on at a time, so that the arrays stay in the processor's cache.
STRETCH: Final = 1 << 16

_Triangles = NDArray[np.int64]


@dataclass(frozen=True)
class Cut:
    """Triangles of polygons; all None where every polygon is a triangle.

    ``corner`` int64 (t, 3): which corners of the polygons; ``polygon`` int64 (t,): of which.
    """

    corner: NDArray[np.int64] | None = None
    polygon: NDArray[np.int64] | None = None

    def of_corners(self, values: NDArray[np.int64]) -> NDArray[np.int64]:
        """What each corner has, int64 (c,), for the corners of the triangles, (t, 3)."""
        return values.reshape(-1, 3) if self.corner is None else values[self.corner]

    def of_polygons(self, values: NDArray[Any]) -> NDArray[Any]:
        """What each polygon has, (p, …), for the triangles, (t, …)."""
        return values if self.polygon is None else values[self.polygon]


def triangulate(
    vertices: NDArray[np.float64],
    corners: NDArray[np.int64],
    sizes: NDArray[np.int64],
    reading: Reading,
) -> Cut:
    """Cut polygons into triangles, in the order of the polygons; note those left out.

    ``corners`` int64 (c,) holds the vertex of each corner, polygon after polygon, and
    ``sizes`` int64 (p,) how many corners each has.  Raises ``InputError`` where a corner
    names a vertex that is not there.
    """
    check_indices(corners, len(vertices))
    if (sizes == 3).all():
        return Cut()
    starts = np.cumsum(sizes) - sizes
    few = int((sizes < 3).sum())
    cut, owners = [np.zeros((0, 3), np.int64)], [np.zeros(0, np.int64)]
    flat = crossing = 0
    for size in np.unique(sizes[sizes >= 3]).tolist():
        same = np.flatnonzero(sizes == size)
        for block in np.array_split(same, -(-len(same) * size // STRETCH)):
            corner = starts[block][:, None] + np.arange(size)
            triangles, owner, lost = _cut(vertices[corners[corner]])
            flat += lost[0]
            crossing += lost[1]
            cut.append(corner[owner[:, None], triangles])
            owners.append(block[owner])
    polygon = np.concatenate(owners)
    order = np.argsort(polygon, kind="stable")
    total = len(sizes)
    reading.note_count(few, f"1 of {total} faces has fewer than three corners and is left out",
                       f"{{}} of {total} faces have fewer than three corners and are left out")
    reading.note_count(flat, f"1 of {total} faces is a polygon without area and is left out",
                       f"{{}} of {total} faces are polygons without area and are left out")
    reading.note_count(crossing, f"1 of {total} faces is a polygon that crosses itself and is "
                       "left out", f"{{}} of {total} faces are polygons that cross themselves and "
                       "are left out")
    return Cut(np.concatenate(cut)[order], polygon[order])


def _cut(points: NDArray[np.float64]) -> tuple[_Triangles, NDArray[np.int64], tuple[int, int]]:
    """Triangles of polygons of n corners each, ``points`` (m, n, 3), and the polygon of each.

    Then how many have no area, and how many cross themselves.
    """
    count, size = points.shape[:2]
    every = np.arange(count)
    if size == 3:  # nothing to choose; a triangle without area is counted by the display list
        return np.tile(np.arange(3), (count, 1)), every, (0, 0)
    points = points - points[:, :1]
    extent = np.abs(points).max(axis=(1, 2), keepdims=True)
    points = points / np.where(extent > 0.0, extent, 1.0)
    normal = cross(points[:, 1:-1], points[:, 2:]).sum(axis=1)
    square = dot(normal, normal)[:, None]
    finite = np.isfinite(points).all(axis=(1, 2))  # others are refused when the mesh is made
    flat = finite & (length(normal) <= DEGENERATE_RATIO)
    cuts = _quadrangles(points) if size == 4 else np.tile(_cut_of_convex(size), (count, 1, 1))
    a, b, c = (points[every[:, None], cuts[:, :, i]] for i in range(3))
    area = dot(cross(b - a, c - a), normal[:, None])
    plain = ~flat & (area > NO_AREA * square).all(axis=1) & _convex(points, normal) | ~finite
    triangles = [cuts[plain].reshape(-1, 3)]
    owner = [np.repeat(every[plain], size - 2)]
    crossing = 0
    for index in np.flatnonzero(~plain & ~flat).tolist():
        parts = _cut_one(points[index], normal[index])
        crossing += parts is None
        if parts is not None:
            triangles.append(parts)
            owner.append(np.full(len(parts), index))
    return np.concatenate(triangles), np.concatenate(owner), (int(flat.sum()), crossing)


def _convex(points: NDArray[np.float64], normal: NDArray[np.float64]) -> NDArray[np.bool_]:
    """Seen along its normal, a polygon turns to one side only, and once around."""
    edges = np.roll(points, -1, axis=1) - points
    before = np.roll(edges, 1, axis=1)
    turn = dot(cross(before, edges), normalised(normal)[:, None])
    around = np.arctan2(turn, dot(before, edges)).sum(axis=1)
    return np.asarray((turn >= -NO_AREA).all(axis=1) & (around < 3.0 * np.pi), np.bool_)


def _quadrangles(points: NDArray[np.float64]) -> NDArray[np.int64]:
    """The two triangles of each quadrangle, (m, 2, 3): cut along its shorter diagonal.

    Where both are of one length, as in a rectangle, from the second to the fourth corner.
    """
    one, other = (length(points[:, i] - points[:, i + 2]) for i in (0, 1))
    from_first = one < other * (1.0 - SAME_LENGTH)
    return np.where(from_first[:, None, None], np.array([[0, 1, 2], [0, 2, 3]]),
                    np.array([[0, 1, 3], [1, 2, 3]]))


@cache
def _cut_of_convex(size: int) -> _Triangles:
    """How ``mapbox_earcut`` cuts each convex polygon of ``size`` corners."""
    angle = 2.0 * np.pi * np.arange(size) / size
    return _earcut(np.stack([np.cos(angle), np.sin(angle)], axis=1))


def _earcut(flat: NDArray[np.float64]) -> _Triangles:
    ends = np.array([len(flat)], np.uint32)
    return mapbox_earcut.triangulate_float64(flat, ends).reshape(-1, 3).astype(np.int64)


def _cut_one(points: NDArray[np.float64], normal: NDArray[np.float64]) -> _Triangles | None:
    """Triangles (t, 3) of one polygon, ``points`` (n, 3); None: it crosses itself."""
    # Seen along the axis nearest to the normal: no coordinate is rounded.
    axis = int(np.argmax(np.abs(normal)))
    flat = np.ascontiguousarray(points[:, [(axis + 1) % 3, (axis + 2) % 3]])
    if normal[axis] < 0.0:
        flat = np.ascontiguousarray(flat[:, ::-1])
    whole = float(_areas(flat, np.stack([np.zeros(len(flat) - 2, np.int64),
                                         np.arange(1, len(flat) - 1),
                                         np.arange(2, len(flat))], axis=1)).sum())
    cut = _earcut(flat)
    areas = _areas(flat, cut)
    if abs(float(np.abs(areas).sum()) - whole) > AREA_TOLERANCE * whole:
        return None
    cut[areas < 0.0] = cut[areas < 0.0][:, ::-1]
    return _with_all_corners(flat, cut[areas != 0.0])


def _with_all_corners(flat: NDArray[np.float64], cut: _Triangles) -> _Triangles:
    """Corners on a straight line, which the cut leaves out, put back into it.

    Other faces may meet there: without them a crack would open.
    """
    size = len(flat)
    there = np.isin(np.arange(size), cut)
    if there.all() or not there.any():
        return cut
    first = int(np.argmax(there))
    triangles: list[list[int]] = cut.tolist()
    last = first
    for corner in ((first + np.arange(1, size)) % size).tolist():
        if there[corner]:
            last = corner
            continue
        after = next(c for c in ((corner + np.arange(1, size)) % size).tolist() if there[c])
        here = flat[corner] - flat[last], flat[after] - flat[corner]
        if min(float(np.abs(side).max()) for side in here) == 0.0 or float(here[0] @ here[1]) < 0.0:
            continue  # the same point as its neighbour, or the tip of a line without area
        for number, (a, b, c) in enumerate(triangles):
            turned = next((t for t in ((a, b, c), (b, c, a), (c, a, b))
                           if t[:2] == (last, after)), None)
            if turned is not None:
                triangles[number] = [last, corner, turned[2]]
                triangles.append([corner, after, turned[2]])
                last = corner
                break
    return np.array(triangles, np.int64)


def _areas(flat: NDArray[np.float64], triangles: _Triangles) -> NDArray[np.float64]:
    """Twice the signed areas of triangles of points (n, 2)."""
    a, b, c = (flat[triangles[:, i]] for i in range(3))
    u, v = b - a, c - a
    return np.asarray(u[:, 0] * v[:, 1] - u[:, 1] * v[:, 0], np.float64)
