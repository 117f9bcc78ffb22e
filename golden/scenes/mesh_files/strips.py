"""Triangle strips and fans to triangles."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray


def strip_triangles(
    corners: NDArray[np.int64], sizes: NDArray[np.int64], restart: int | None = None
) -> NDArray[np.int64]:
    """The triangles (t, 3) of strips, every second one turned round so that all face alike.

    ``corners`` holds the vertices of strip after strip, ``sizes`` how many each has; after
    a corner ``restart`` the strip begins anew.  A triangle that names a vertex twice only
    leads on to the next part of its strip and is dropped.
    """
    if len(corners) < 3:
        return np.zeros((0, 3), np.int64)
    begins = np.zeros(len(corners), np.bool_)
    begins[(np.cumsum(sizes) - sizes)[sizes > 0]] = True
    if restart is not None:
        begins[1:] |= corners[:-1] == restart
    place = np.arange(len(corners))
    since = place - np.maximum.accumulate(np.where(begins, place, 0))
    triangles = np.stack([corners[:-2], corners[1:-1], corners[2:]], axis=1)
    odd = since[2:] % 2 == 1
    triangles[odd] = triangles[odd][:, [1, 0, 2]]
    a, b, c = triangles.T
    drawn = (since[2:] >= 2) & (a != b) & (b != c) & (c != a)
    if restart is not None:
        drawn &= (triangles != restart).all(axis=1)
    return np.asarray(triangles[drawn], np.int64)


def fan_triangles(corners: NDArray[np.int64]) -> NDArray[np.int64]:
    """The triangles (t, 3) of one fan around its first corner."""
    if len(corners) < 3:
        return np.zeros((0, 3), np.int64)
    first = np.full(len(corners) - 2, corners[0])
    return np.stack([first, corners[1:-1], corners[2:]], axis=1)
