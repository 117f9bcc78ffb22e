"""A sphere by recursive subdivision of an octahedron, and meshes of many such spheres."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ..mesh import Mesh, Vector, normalised


def sphere_triangles(depth: int) -> int:
    """Faces of ``unit_sphere(depth)``: 8 · 4^depth."""
    return 1 << (2 * depth + 3)


def unit_sphere(depth: int) -> tuple[NDArray[np.float64], NDArray[np.int64]]:
    """Vertices and faces of a unit sphere, closed, faces counter-clockwise from outside.

    A regular octahedron on the sphere, each triangle replaced ``depth`` times by
    four, the new vertices at the middles of its edges moved out to the sphere
    (Blazek 1991, chapter II, "Tessellation").
    """
    vertices = np.array(
        [[1, 0, 0], [-1, 0, 0], [0, 1, 0], [0, -1, 0], [0, 0, 1], [0, 0, -1]], np.float64
    )
    faces = np.array(
        [
            [0, 2, 4], [2, 1, 4], [1, 3, 4], [3, 0, 4],
            [2, 0, 5], [1, 2, 5], [3, 1, 5], [0, 3, 5],
        ],
        np.int64,
    )  # fmt: skip
    return subdivided_sphere(vertices, faces, depth)


def subdivided_sphere(
    vertices: NDArray[np.float64], faces: NDArray[np.int64], depth: int
) -> tuple[NDArray[np.float64], NDArray[np.int64]]:
    """A closed mesh with its vertices on the unit sphere, each face ``depth`` times made four, the
    new vertices moved out to the sphere."""
    for _ in range(depth):
        pairs, faces = split_in_four(faces, len(vertices))
        new = normalised(vertices[pairs[:, 0]] + vertices[pairs[:, 1]])
        vertices = np.concatenate([vertices, new])
    return vertices, faces


def split_in_four(
    faces: NDArray[np.int64], vertices: int
) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """Each face (f, 3) becomes four, by the middles of its edges.

    Returns the ends of every edge, int64 (e, 2), and the new faces, int64 (4 f, 3), which
    name the middle of edge i ``vertices`` + i.  Faces that share an edge share its middle, so
    what is closed stays so.
    """
    edges = np.stack([faces, np.roll(faces, -1, axis=1)], axis=2)
    edges.sort(axis=2)  # both faces of an edge name it alike, and share its middle
    pairs, index = np.unique(edges.reshape(-1, 2), axis=0, return_inverse=True)
    a, b, c = faces.T
    ab, bc, ca = (vertices + index.reshape(-1, 3)).T
    split = [np.stack(corners, axis=1) for corners in (
        (a, ab, ca), (ab, b, bc), (ca, bc, c), (ab, bc, ca))]
    return pairs, np.stack(split, axis=1).reshape(-1, 3)


def spheres_mesh(
    centers: NDArray[np.float64],
    radii: NDArray[np.float64],
    depth: int,
    colors: NDArray[np.uint8] | None = None,
    eye_direction: Vector | None = None,
) -> Mesh:
    """One mesh of spheres, in order: ``centers`` (n, 3), ``radii`` (n,), ``colors`` (n, 3)."""
    vertices, faces = unit_sphere(depth)
    count = len(centers)
    first = np.arange(count, dtype=np.int64) * len(vertices)
    placed = vertices[None] * radii[:, None, None] + centers[:, None]
    corner_colors = None
    if colors is not None:
        shape = (count, len(faces), 3, 3)
        corner_colors = np.broadcast_to(colors[:, None, None], shape).reshape(-1, 3, 3).copy()
    return Mesh(
        placed.reshape(-1, 3),
        (faces[None] + first[:, None, None]).reshape(-1, 3),
        corner_colors,
        np.tile(vertices, (count, 1)),
        eye_direction=eye_direction,
    )
