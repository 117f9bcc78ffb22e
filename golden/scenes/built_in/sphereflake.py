"""The sphereflake: ``balls`` of the Standard Procedural Databases (Haines 1987)."""

from __future__ import annotations

import math
from typing import Final

import numpy as np
from numpy.typing import NDArray

from ..mesh import Mesh, cross
from .sphere import sphere_triangles, spheres_mesh

#: Radius of a child relative to its parent.
SHRINK: Final = 1.0 / 3.0

ROOT_RADIUS: Final = 0.5


def sphereflake_spheres(depth: int) -> int:
    """Number of spheres: the sum of 9^k for k from 0 to ``depth``."""
    return int((9 ** (depth + 1) - 1) // 8)


def sphereflake_triangles(depth: int, tessellation: int) -> int:
    return sphereflake_spheres(depth) * sphere_triangles(tessellation)


def child_directions() -> NDArray[np.float64]:
    """Where the nine children sit on a parent whose own parent is below (-z), unit (9, 3).

    Three at 120° intervals on the upper hemisphere, arcsin √(2/3) above the
    equator; six at 60° intervals on the equator, 30° to either side of each.
    """
    sine, cosine = math.sqrt(2.0 / 3.0), math.sqrt(1.0 / 3.0)
    directions = []
    for k in range(3):
        azimuth = math.radians(45 + 120 * k)
        directions.append([cosine * math.cos(azimuth), cosine * math.sin(azimuth), sine])
        for side in (-30, 30):
            on_equator = math.radians(45 + 120 * k + side)
            directions.append([math.cos(on_equator), math.sin(on_equator), 0.0])
    return np.array(directions)


def sphereflake_layout(depth: int) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Centres (n, 3) and radii (n,), generation by generation.

    The root has radius 1/2 at the origin.  A child touches its parent from
    outside and is a third of its size; its own upward direction is the one it
    grew in, the shortest rotation from +z.
    """
    centers, radii = np.zeros((1, 3)), np.array([ROOT_RADIUS])
    up = np.array([[0.0, 0.0, 1.0]])
    all_centers, all_radii = [centers], [radii]
    children = child_directions()
    for _ in range(depth):
        up = _turned(children, up).reshape(-1, 3)
        reach = np.repeat(radii * (1.0 + SHRINK), len(children))
        centers = np.repeat(centers, len(children), axis=0) + up * reach[:, None]
        radii = np.repeat(radii * SHRINK, len(children))
        all_centers.append(centers)
        all_radii.append(radii)
    return np.concatenate(all_centers), np.concatenate(all_radii)


def _turned(vectors: NDArray[np.float64], up: NDArray[np.float64]) -> NDArray[np.float64]:
    """(n, m, 3): the m ``vectors`` under the shortest rotation of +z to each of the n ``up``.

    Rodrigues' formula with the axis a = cross(z, up) left unnormalised:
    v cos + cross(a, v) + a dot(a, v) / (1 + cos).  Straight down: half a turn about y.
    """
    cosine = up[:, 2][:, None, None]
    axis = np.stack([-up[:, 1], up[:, 0], np.zeros(len(up))], axis=1)[:, None]
    v = np.broadcast_to(vectors, (len(up), len(vectors), 3))
    along = (axis * v).sum(axis=2, keepdims=True)
    down = cosine <= -1.0 + 1e-12
    turned = v * cosine + cross(np.broadcast_to(axis, v.shape), v)
    turned = turned + axis * along / np.where(down, 1.0, 1.0 + cosine)
    return np.asarray(np.where(down, v * np.array([-1.0, 1.0, -1.0]), turned), np.float64)


def sphereflake(depth: int, tessellation: int) -> Mesh:
    """The flake alone, without the floor of the original, seen from where the original is."""
    centers, radii = sphereflake_layout(depth)
    return spheres_mesh(centers, radii, tessellation, eye_direction=(2.1, 1.3, 1.7))
