"""Blazek's primitives, each closed, by recursive subdivision: a triangle becomes four."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from ..built_in.sphere import split_in_four, unit_sphere
from ..mesh import UP_Y, Mesh

Float64 = NDArray[np.float64]
Int64 = NDArray[np.int64]

#: How often a triangle becomes four, where nothing is said.
USUAL_RECURSION = {"sphere": 3, "cylinder": 3, "cone": 3, "cube": 0, "pyramid": 0}

#: A point belongs to a surface that it is so near to.
NEAR = 1e-9

#: Seen from above, a square, in the order in which it is walked with the inside to the left.
_SQUARE = ((1.0, 0.0), (0.0, -1.0), (-1.0, 0.0), (0.0, 1.0))


def primitive(kind: str, recursion: int) -> Mesh:
    """The primitive of that kind, from -1 to 1 on each axis, its faces counter-clockwise from
    outside."""
    if kind == "sphere":
        vertices, faces = unit_sphere(recursion)
        return Mesh(vertices, faces, normals=vertices, up=UP_Y)
    vertices, faces, radius = _STARTS[kind]()
    for _ in range(recursion):
        vertices, faces = _subdivided(vertices, faces, radius)
    return Mesh(vertices, faces, up=UP_Y)


def triangles_of(kind: str, recursion: int) -> int:
    """Faces of it."""
    return {"sphere": 8, "cube": 12, "cylinder": 16, "cone": 8, "pyramid": 6}[kind] << 2 * recursion


#: Distance from the y axis of a surface of revolution, at each y; None: all faces stay flat.
Radius = Callable[[Float64], Float64] | None


def _cylinder() -> tuple[Float64, Int64, Radius]:
    rim = [(x, y, z) for y in (1.0, -1.0) for x, z in _SQUARE]
    vertices = np.array([*rim, (0.0, 1.0, 0.0), (0.0, -1.0, 0.0)])
    faces = []
    for side in range(4):
        after = (side + 1) % 4
        faces += [(side, side + 4, after + 4), (side, after + 4, after),
                  (8, side, after), (9, after + 4, side + 4)]
    return vertices, _outward(vertices, faces), np.ones_like


def _cone() -> tuple[Float64, Int64, Radius]:
    vertices = np.array([*((x, -1.0, z) for x, z in _SQUARE), (0.0, 1.0, 0.0), (0.0, -1.0, 0.0)])
    faces = []
    for side in range(4):
        after = (side + 1) % 4
        faces += [(4, side, after), (5, after, side)]
    return vertices, _outward(vertices, faces), lambda y: (1.0 - y) / 2.0


def _pyramid() -> tuple[Float64, Int64, Radius]:
    corners = ((1.0, 1.0), (1.0, -1.0), (-1.0, -1.0), (-1.0, 1.0))
    vertices = np.array([*((x, -1.0, z) for x, z in corners), (0.0, 1.0, 0.0)])
    faces = [(4, side, (side + 1) % 4) for side in range(4)] + [(0, 1, 2), (0, 2, 3)]
    return vertices, _outward(vertices, faces), None


def _cube() -> tuple[Float64, Int64, Radius]:
    vertices = np.array([(x, y, z) for x in (-1.0, 1.0) for y in (-1.0, 1.0) for z in (-1.0, 1.0)])
    quads = [(0, 1, 3, 2), (4, 5, 7, 6), (0, 1, 5, 4), (2, 3, 7, 6), (0, 2, 6, 4), (1, 3, 7, 5)]
    faces = [face for a, b, c, d in quads for face in ((a, b, c), (a, c, d))]
    return vertices, _outward(vertices, faces), None


_STARTS: dict[str, Callable[[], tuple[Float64, Int64, Radius]]] = {
    "cylinder": _cylinder, "cone": _cone, "pyramid": _pyramid, "cube": _cube}


def _outward(vertices: Float64, faces: list[tuple[int, int, int]]) -> Int64:
    """The faces of a convex body about its middle, each turned so that it is counter-clockwise from
    outside."""
    turned = []
    middle = vertices.mean(axis=0)
    for a, b, c in faces:
        normal = np.cross(vertices[b] - vertices[a], vertices[c] - vertices[a])
        outside = float(normal @ (vertices[a] - middle)) > 0
        turned.append((a, b, c) if outside else (a, c, b))
    return np.array(turned, np.int64)


def _subdivided(vertices: Float64, faces: Int64, radius: Radius) -> tuple[Float64, Int64]:
    """Each triangle in four; the middle of an edge whose ends lie on the surface of revolution is
    moved out to it."""
    pairs, faces = split_in_four(faces, len(vertices))
    new = (vertices[pairs[:, 0]] + vertices[pairs[:, 1]]) / 2.0
    if radius is not None:
        out = _on_surface(vertices, radius)
        moved = out[pairs].all(axis=1)
        away = np.hypot(new[:, 0], new[:, 2])
        moved &= away > NEAR
        factor = np.where(moved, radius(new[:, 1]) / np.where(moved, away, 1.0), 1.0)
        new[:, [0, 2]] *= factor[:, np.newaxis]
    return np.concatenate([vertices, new]), faces


def _on_surface(vertices: Float64, radius: Callable[[Float64], Float64]) -> NDArray[np.bool_]:
    away = np.hypot(vertices[:, 0], vertices[:, 2])
    return np.asarray(np.abs(away - radius(vertices[:, 1])) < NEAR)
