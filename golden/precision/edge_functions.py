"""Edge functions of triangles in whatever arithmetic they are given: float32, float64, rationals.

The integer models step edges; the two references that see a scene before it is
quantised (``unquantised``, ``float32_depth_buffer``) evaluate them afresh at
every pixel of a triangle's bounding box.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..reference.coverage import Spans

Array = NDArray[Any]


def box_rows(position: Array, width: int, height: int) -> Spans:
    """Every row of every triangle's bounding box, a pixel wider than it need be.

    ``position`` (n, 3, 2) in pixels.  ``Spans.triangle`` is the triangle's number.
    """
    size = np.array([width, height])
    # Held to the screen first: what is far outside it need not fit 64 bits.  By how much, and that
    # a pixel is to spare at either end, changes no picture.
    low = np.clip(np.floor(np.clip(position.min(axis=1), -2, size + 2)) - 1, 0, size)
    high = np.clip(np.ceil(np.clip(position.max(axis=1), -2, size + 2)) + 1, 0, size)
    first, rows = low.astype(np.int64), (high - low).astype(np.int64)
    rows[(rows <= 0).any(axis=1)] = 0
    triangle = np.repeat(np.arange(len(rows)), rows[:, 1])
    starts = np.cumsum(rows[:, 1]) - rows[:, 1]
    down = np.arange(len(triangle)) - starts.take(triangle)
    return Spans(triangle, first[:, 1].take(triangle) + down, first[:, 0].take(triangle),
                 rows[:, 0].take(triangle))


def edge_functions(corners: Array, x: Array, y: Array) -> tuple[Array, Array]:
    """Twice the signed areas between (x, y) and the edges, and the size of their terms.

    ``corners`` (m, 3, 2), ``x`` and ``y`` (m,), of one dtype; both results (m, 3).
    Entry k is of the edge opposite to corner k, the corners in their order;
    together they make the triangle's doubled area, which is positive where the
    corners run clockwise as seen (y points down).  In floating point with
    relative rounding u an entry is off by at most ``(3 + 16 u) u`` times the
    size of its terms (Shewchuk 1997, orient2d).
    """
    values, sizes = [], []
    for corner in range(3):
        begin, end = corners[:, (corner + 1) % 3], corners[:, (corner + 2) % 3]
        one = (end[:, 0] - begin[:, 0]) * (y - begin[:, 1])
        other = (end[:, 1] - begin[:, 1]) * (x - begin[:, 0])
        values.append(one - other)
        sizes.append(abs(one) + abs(other))
    return np.stack(values, axis=1), np.stack(sizes, axis=1)


def owned_edges(corners: Array, orientation: Array) -> NDArray[np.bool_]:
    """bool (m, 3): edge k, opposite to corner k, is a top or left one: centres on it are inside.

    ``corners`` (m, 3, 2); ``orientation`` (m,), positive where they run clockwise as seen.
    """
    owned = []
    for corner in range(3):
        begin, end = corners[:, (corner + 1) % 3], corners[:, (corner + 2) % 3]
        clockwise = orientation > 0
        up = np.where(clockwise, end[:, 1] < begin[:, 1], end[:, 1] > begin[:, 1])
        right = np.where(clockwise, end[:, 0] > begin[:, 0], end[:, 0] < begin[:, 0])
        owned.append(up | ((end[:, 1] == begin[:, 1]) & right))
    return np.stack(owned, axis=1).astype(np.bool_)
