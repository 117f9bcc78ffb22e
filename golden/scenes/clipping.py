"""Clipping of homogeneous triangles: watertight, and only where it is needed.

Everything here works on corners (n, 3, k): homogeneous pixels X, Y, Z, w (the
pixel is X/w, Y/w; Z/w runs from 0 at the near plane to 1), then any attributes
that are linear in them.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from .quantise import PictureFormat


@dataclass(frozen=True)
class Clipped:
    """``corners`` float64 (m, 3, k) and ``source`` int64 (m,), the triangle each comes from.

    ``source`` never decreases: what is left of a triangle stays at its place in
    the drawing order.
    """

    corners: NDArray[np.float64]
    source: NDArray[np.int64]


def clip(corners: NDArray[np.float64], picture: PictureFormat) -> Clipped:
    """Drop what is wholly outside the screen or before the near plane, clip the rest.

    The planes are the near plane and the four sides of the guard band.
    Triangles that cross none of them come back bit for bit.

    *Watertight:* a new vertex on an edge depends on the two end points alone,
    taken in an order of their own, not on the triangle or the direction; so two
    neighbours get the same bits and leave neither gap nor overlap.
    """
    source = np.flatnonzero(~_outside(corners, picture))
    distances = _distances(corners[source], picture)
    crossing = (distances < 0.0).any(axis=(1, 2))
    pieces = _clip_crossing(corners[source[crossing]], picture)
    merged = np.concatenate([corners[source[~crossing]], pieces.corners])
    origin = np.concatenate([source[~crossing], source[crossing][pieces.source]])
    order = np.argsort(origin, kind="stable")
    return Clipped(merged[order], origin[order])


def _outside(corners: NDArray[np.float64], picture: PictureFormat) -> NDArray[np.bool_]:
    """True where all three corners lie beyond one side of the screen or the near plane.

    Linear functions of homogeneous coordinates, so true of corners behind the
    eye as well.  A triangle that only touches a side covers no pixel centre,
    but one that touches the near plane may.
    """
    x, y, z, w = (corners[:, :, i] for i in range(4))
    return np.asarray(
        (x <= 0.0).all(axis=1)
        | (x >= w * picture.width).all(axis=1)
        | (y <= 0.0).all(axis=1)
        | (y >= w * picture.height).all(axis=1)
        | (z < 0.0).all(axis=1)
    )


def _distances(points: NDArray[np.float64], picture: PictureFormat) -> NDArray[np.float64]:
    """Signed distance to each of the five planes, inside positive: (…, k) to (…, 5)."""
    x, y, z, w = (points[..., i] for i in range(4))
    low, high = picture.guard_band, picture.guard_band_end
    return np.stack([z, x + w * low, w * high - x, y + w * low, w * high - y], axis=-1)


def _clip_crossing(corners: NDArray[np.float64], picture: PictureFormat) -> Clipped:
    """Sutherland and Hodgman's algorithm, one plane at a time, for all triangles at once."""
    polygons = corners
    count = np.full(len(corners), 3)
    for plane in range(5):
        distance = _distances(polygons, picture)[..., plane]
        polygons, count = _clip_plane(polygons, count, distance, z_is_zero=plane == 0)
    return _fans(polygons, count)


def _clip_plane(
    polygons: NDArray[np.float64],
    count: NDArray[np.int64],
    distance: NDArray[np.float64],
    *,
    z_is_zero: bool,
) -> tuple[NDArray[np.float64], NDArray[np.int64]]:
    """Keep the inside of convex polygons (n, m, k), of which the first ``count`` points exist."""
    rows, slots = distance.shape
    slot = np.arange(slots)
    exists = slot < count[:, None]
    following = np.where(slot + 1 == count[:, None], 0, np.minimum(slot + 1, slots - 1))
    next_point = np.take_along_axis(polygons, following[..., None], axis=1)
    next_distance = np.take_along_axis(distance, following, axis=1)
    inside, next_inside = distance >= 0.0, next_distance >= 0.0
    # A point on the plane itself is kept and ends its edge: nothing to compute.
    crosses = exists & (inside != next_inside) & (distance != 0.0) & (next_distance != 0.0)

    # Each point may be followed by the crossing on the edge that it begins.
    found = np.stack([exists & inside, crosses], axis=2).reshape(rows, 2 * slots)
    points = np.stack([polygons, np.zeros_like(polygons)], axis=2)
    new = intersections(
        polygons[crosses], next_point[crosses], distance[crosses], next_distance[crosses]
    )
    if z_is_zero:
        new[:, 2] = 0.0  # on the near plane by definition, whatever the rounding
    points[crosses, 1] = new
    points = points.reshape(rows, 2 * slots, polygons.shape[2])

    left = found.sum(axis=1)
    order = np.argsort(~found, axis=1, kind="stable")[:, : max(3, int(left.max(initial=0)))]
    return np.take_along_axis(points, order[..., None], axis=1), left


def intersections(
    start: NDArray[np.float64],
    end: NDArray[np.float64],
    start_distance: NDArray[np.float64],
    end_distance: NDArray[np.float64],
) -> NDArray[np.float64]:
    """The points (e, k) where edges (e, k) cross a plane, whichever way an edge is given.

    The end points are put in lexicographic order of X, Y, Z, w first; the
    distances must have opposite signs.
    """
    swap = np.zeros(len(start), np.bool_)
    equal = np.ones(len(start), np.bool_)
    for column in range(4):
        swap |= equal & (start[:, column] > end[:, column])
        equal &= start[:, column] == end[:, column]
    first = np.where(swap[:, None], end, start)
    second = np.where(swap[:, None], start, end)
    first_distance = np.where(swap, end_distance, start_distance)
    second_distance = np.where(swap, start_distance, end_distance)
    share = first_distance / (first_distance - second_distance)
    return np.asarray(first + (second - first) * share[:, None], np.float64)


def _fans(polygons: NDArray[np.float64], count: NDArray[np.int64]) -> Clipped:
    """Triangles (0, i, i + 1) of convex polygons, in order."""
    fans = max(polygons.shape[1] - 2, 0)
    step = np.arange(fans)
    exists = step + 2 < count[:, None]
    index = np.stack([np.zeros(fans, np.int64), step + 1, step + 2], axis=1)
    triangles = polygons[:, index]
    source = np.broadcast_to(np.arange(len(polygons))[:, None], exists.shape)
    return Clipped(triangles[exists], source[exists])
