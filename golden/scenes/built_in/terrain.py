"""A terrain: the fault at Jacksboro, Tennessee, from the elevations that matplotlib brings along.

``jacksboro_fault_dem.npz``, 344 rows from north to south by 403 columns of whole metres, 3 seconds
of arc apart (United States Geological Survey, public domain).
"""

from __future__ import annotations

from functools import cache
from typing import Final

import numpy as np
from numpy.typing import NDArray

from ..mesh import Mesh

ROWS: Final = 344
COLUMNS: Final = 403

#: Metres in 3 seconds of arc, from north to south, and from west to east at its latitude, 36.6°.
NORTH_SOUTH: Final = 92.5
WEST_EAST: Final = 74.4


@cache
def elevations() -> NDArray[np.float64]:
    """float64 (ROWS, COLUMNS): metres, the first row in the north, the first column in the west."""
    from matplotlib.cbook import get_sample_data  # takes longer than the other scenes

    path = str(get_sample_data("jacksboro_fault_dem.npz", asfileobj=False))
    with np.load(path, allow_pickle=False) as data:
        return np.asarray(data["elevation"], np.float64)


def _posts(step: int) -> tuple[int, int]:
    return -(-ROWS // step), -(-COLUMNS // step)


def terrain_triangles(step: int, relief: float) -> int:
    rows, columns = _posts(step)
    return 2 * (rows - 1) * (columns - 1)


def terrain(step: int, relief: float) -> Mesh:
    """Every ``step``-th elevation of each row and column, ``relief`` times as high as it is, two
    triangles to a square, from north to south; seen from the south, in kilometres."""
    height = elevations()[::step, ::step] * relief
    rows, columns = height.shape
    row, column = np.mgrid[:rows, :columns]
    vertices = np.stack([column * (WEST_EAST * step), -row * (NORTH_SOUTH * step), height],
                        axis=-1).reshape(-1, 3) / 1000
    corner = (row * columns + column)[:-1, :-1].reshape(-1)
    north_west, north_east = corner, corner + 1
    south_west, south_east = corner + columns, corner + columns + 1
    faces = np.stack([np.stack([north_west, south_west, south_east], axis=1),
                      np.stack([north_west, south_east, north_east], axis=1)], axis=1)
    return Mesh(vertices, faces.reshape(-1, 3).astype(np.int64), eye_direction=(0.2, -1.0, 0.45))
