"""From what a scene file says to meshes and where they are, still in the scene's own units."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from ...specification.errors import InputError
from ..built_in.random_numbers import RandomNumbers
from ..mesh import UP_Y, UP_Z, Mesh, Vector, normalised
from ..mesh_files.load_mesh import load_mesh
from .description import ObjectDefinition, SceneDescription
from .language import MESH
from .primitives import USUAL_RECURSION, primitive, triangles_of

Float64 = NDArray[np.float64]
Int64 = NDArray[np.int64]

#: What makes a mesh: kind or file, how it is turned, its scale, its recursion.
MeshKey = tuple[str | Path, Vector, Vector, int]

WHITE = (255, 255, 255)

#: The least channel of a random colour, so that nothing is lost before a dark background.
DARKEST = 64


@dataclass(frozen=True, eq=False)
class PlacedObjects:
    """The objects of a scene, in the order of its file.

    ``meshes``    about their own origins, turned and scaled
    ``mesh``      int64 (n,): which of them
    ``position``  float64 (n, 3)
    ``color``     uint8 (n, 3)
    """

    meshes: tuple[Mesh, ...]
    mesh: Int64
    position: Float64
    color: NDArray[np.uint8]

    @property
    def triangles(self) -> int:
        return sum(self.meshes[number].triangles for number in self.mesh.tolist())


def placed_objects(description: SceneDescription, most_triangles: int) -> PlacedObjects:
    """Make every mesh once, and place the objects.  Raises ``InputError`` for a mesh file that
    cannot be used, and for more than ``most_triangles``."""
    numbers: dict[MeshKey, int] = {}
    meshes: list[Mesh] = []
    mesh, position, color = [], [], []
    triangles = 0
    for definition in description.objects:
        where = f"{description.path}: line {definition.line}, column {definition.column}"
        key = _mesh_key(definition)
        if key not in numbers:
            _check_triangles(where, triangles + _fewest(definition), most_triangles)
            numbers[key] = len(meshes)
            try:
                mesh_of_kind = _scaled(_unit_mesh(definition), np.array(definition.scale))
                meshes.append(turned(mesh_of_kind, _rotation(definition.rotation)))
            except InputError as error:
                raise InputError(f"{where}: {error}") from None
        triangles += definition.number * meshes[numbers[key]].triangles
        _check_triangles(where, triangles, most_triangles)
        mesh += [numbers[key]] * definition.number
        places, colors = _places_and_colors(definition)
        position.append(places)
        color.append(colors)
    return PlacedObjects(tuple(meshes), np.array(mesh, np.int64), np.concatenate(position),
                         np.concatenate(color))


def _check_triangles(where: str, triangles: int, most: int) -> None:
    if triangles > most:
        raise InputError(f"{where}: makes {triangles} triangles with those before it, more than "
                         f"{most}; take fewer objects, or a lower recursion")


def _mesh_key(definition: ObjectDefinition) -> MeshKey:
    return (definition.path or definition.kind, definition.rotation, definition.scale,
            _recursion(definition))


def _recursion(definition: ObjectDefinition) -> int:
    if definition.recursion is not None:
        return definition.recursion
    return USUAL_RECURSION.get(definition.kind, 0)


def _fewest(definition: ObjectDefinition) -> int:
    """Triangles that are known before a mesh is made."""
    if definition.kind == MESH:
        return 0
    return definition.number * triangles_of(definition.kind, _recursion(definition))


def _unit_mesh(definition: ObjectDefinition) -> Mesh:
    if definition.path is None:
        return primitive(definition.kind, _recursion(definition))
    return _fitted(load_mesh(definition.path))


def _fitted(mesh: Mesh) -> Mesh:
    """What is up along y, and as large as it can be from -1 to 1."""
    def turn(vectors: Float64) -> Float64:
        return vectors[:, [0, 2, 1]] * [1.0, 1.0, -1.0] if mesh.up == UP_Z else vectors

    vertices = turn(mesh.vertices)
    used = vertices[np.unique(mesh.faces)]
    low, high = used.min(axis=0), used.max(axis=0)
    half = float((high / 2.0 - low / 2.0).max())
    vertices = (vertices - (low / 2.0 + high / 2.0)) / (half or 1.0)
    # What no face uses may lie anywhere.
    vertices = np.clip(vertices, -1.0, 1.0)
    normals = None if mesh.normals is None else turn(mesh.normals)
    return Mesh(vertices, mesh.faces, mesh.colors, normals, mesh.smooth, UP_Y, notes=mesh.notes)


def rotated(vectors: Float64, axes: Float64) -> Float64:
    """``vectors`` (n, 3) along the rows of ``axes``: sums written out, which are the same on every
    machine."""
    x, y, z = (vectors[:, axis, np.newaxis] for axis in range(3))
    return np.asarray(x * axes[:, 0] + y * axes[:, 1] + z * axes[:, 2])


def _rotation(angles: Vector) -> Float64:
    """About x, then y, then z, radians."""
    axes = np.eye(3)
    for axis, angle in enumerate(angles):
        cosine, sine = math.cos(angle), math.sin(angle)
        a, b = (axis + 1) % 3, (axis + 2) % 3
        turn = np.eye(3)
        turn[a, a], turn[a, b], turn[b, a], turn[b, b] = cosine, -sine, sine, cosine
        axes = rotated(axes.T, turn).T
    return axes


def turned(mesh: Mesh, axes: Float64) -> Mesh:
    """Along the rows of ``axes``, up being y."""
    normals = None if mesh.normals is None else rotated(mesh.normals, axes)
    return replace(mesh, vertices=rotated(mesh.vertices, axes), normals=normals, up=UP_Y)


def _scaled(mesh: Mesh, scale: Float64) -> Mesh:
    normals = None if mesh.normals is None else normalised(mesh.normals / scale)
    return replace(mesh, vertices=mesh.vertices * scale, normals=normals)


def _places_and_colors(definition: ObjectDefinition) -> tuple[Float64, NDArray[np.uint8]]:
    """Positions and colours of the objects of one line."""
    numbers, count = RandomNumbers(definition.seed), definition.number
    if definition.position is None:
        position = 2.0 * numbers.uniform(count, 3) - 1.0
    else:
        position = np.tile(np.array(definition.position), (count, 1))
    if definition.color == "random":
        return position, (DARKEST + numbers.integers(256 - DARKEST, count, 3)).astype(np.uint8)
    return position, np.tile(np.array(definition.color or WHITE, np.uint8), (count, 1))
