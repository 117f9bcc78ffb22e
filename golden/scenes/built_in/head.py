"""A head, in place of the Graphics Performance Committee's that Ellsworth (1994) turns."""

from __future__ import annotations

from itertools import product
from typing import Final

import numpy as np
from numpy.typing import NDArray

from ..mesh import Mesh, Vector, normalised

#: The skull: half its width, depth and height.
_SKULL: Final[Vector] = (0.78, 0.95, 1.1)

#: What stands out of it, or is sunk into it: degrees east and north of the face, how far, and how
#: narrow.
_FEATURES: Final = (
    (0.0, -6.0, 0.24, 90.0), (0.0, -14.0, 0.1, 160.0),  # nose
    (-19.0, 8.0, -0.07, 70.0), (19.0, 8.0, -0.07, 70.0),  # eyes
    (0.0, 20.0, 0.04, 25.0), (0.0, -33.0, 0.05, 90.0), (0.0, -52.0, 0.14, 30.0),  # brow to chin
    (-90.0, 0.0, 0.2, 80.0), (90.0, 0.0, 0.2, 80.0),  # ears
    (180.0, -74.0, 0.45, 6.0),  # neck
)  # fmt: skip


def head_triangles(tessellation: int) -> int:
    return 8 * tessellation**2


def head(tessellation: int) -> Mesh:
    """The head, upright and closed, its face towards -y: an octahedron whose edges are cut into
    ``tessellation`` parts, each vertex moved to the surface; so it is finest about nose and ears.
    ``tessellation=86`` makes 59,168 triangles, the paper's head has 59,592."""
    lattice, faces = _octahedron(tessellation)
    direction = normalised(lattice.astype(np.float64))
    distance = np.ones(len(direction))
    for east, north, height, narrowness in _FEATURES:
        middle = _direction(np.radians(east), np.radians(north))
        distance += height * np.exp(narrowness * ((direction * middle).sum(axis=1) - 1))
    return Mesh(direction * distance[:, None] * np.array(_SKULL), faces,
                eye_direction=(0.0, -1.0, 0.1))


def _direction(east: float, north: float) -> NDArray[np.float64]:
    """A unit vector, of radians."""
    return np.array([np.cos(north) * np.sin(east), -np.cos(north) * np.cos(east), np.sin(north)])


def _octahedron(parts: int) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """Vertices (v, 3), whose coordinates add up to ``parts`` but for their signs, and faces,
    counter-clockwise from outside."""
    i, j = (index.reshape(-1) for index in np.mgrid[:parts, :parts])
    upright, hanging = i + j < parts, i + j < parts - 1
    corners = np.concatenate([
        np.stack([[i, i + 1, i], [j, j, j + 1]])[..., upright],
        np.stack([[i + 1, i + 1, i], [j, j + 1, j + 1]])[..., hanging]], axis=2)
    of_octant = np.stack([*corners, parts - corners.sum(axis=0)]).transpose(2, 1, 0)
    octants = []
    for signs in product((1, -1), repeat=3):
        octant = of_octant * np.array(signs)
        # Mirrored an odd number of times, faces run the other way.
        octants.append(octant if np.prod(signs) > 0 else octant[:, ::-1])
    vertices, place = np.unique(np.concatenate(octants).reshape(-1, 3), axis=0,
                                return_inverse=True)
    return vertices, place.reshape(-1, 3).astype(np.int64)
