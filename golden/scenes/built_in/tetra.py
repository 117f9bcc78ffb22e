"""The Sierpinski tetrahedron: ``tetra`` of the Standard Procedural Databases (Haines 1987)."""

from __future__ import annotations

import numpy as np

from ..mesh import Mesh


def tetra_triangles(depth: int) -> int:
    """Four faces for each of the 4^depth tetrahedra."""
    return 1 << (2 * depth + 2)


def tetra(depth: int) -> Mesh:
    """4^depth regular tetrahedra, each a 2^-depth copy of the whole at one of its corners.

    The whole has its corners on alternate corners of the cube from -1 to 1, so
    every coordinate is exact, and is shown standing on a face.
    """
    corners = np.array([[1, 1, 1], [-1, -1, 1], [-1, 1, -1], [1, -1, -1]], np.float64)
    faces = np.array([[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]], np.int64)
    centers = np.zeros((1, 3))
    for level in range(depth):
        step = corners * 0.5 ** (level + 1)
        centers = (centers[:, None] + step[None]).reshape(-1, 3)
    vertices = centers[:, None] + corners[None] * 0.5**depth
    first = 4 * np.arange(len(centers), dtype=np.int64)
    return Mesh(
        vertices.reshape(-1, 3),
        (faces[None] + first[:, None, None]).reshape(-1, 3),
        smooth=False,
        up=(1.0, 1.0, 1.0),
        eye_direction=(0.92, -0.36, -0.12),  # an edge towards the eye: one face lit, one in shade
    )
