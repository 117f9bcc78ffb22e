"""A triangle mesh in world space, and the normals that lighting needs."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import numpy as np
from numpy.typing import NDArray

from ..specification.errors import InputError

Vector = tuple[float, float, float]

UP_Y: Final[Vector] = (0.0, 1.0, 0.0)
UP_Z: Final[Vector] = (0.0, 0.0, 1.0)

#: Where a mesh has no colour of its own: glazed earthenware.
BASE_COLOR: Final = (226, 178, 112)

#: Beyond this the cross products and squared lengths of lighting would overflow.
COORDINATE_LIMIT: Final = 1e30

#: Two faces that meet at a greater angle show an edge between them.
CREASE_COSINE: Final = 0.6427876096865394  # 50 degrees

#: A vertex shared by more corners than this is the tip of a fan: its faces stay faceted.
FAN_LIMIT: Final = 256

#: Twice the area over the longest edge squared, below which a face has no area.
DEGENERATE_RATIO: Final = 1e-14


@dataclass(frozen=True)
class Mesh:
    """Triangles in world space, in drawing order.

    ``vertices``       float64 (v, 3): finite, magnitude at most ``COORDINATE_LIMIT``
    ``faces``          int64 (f, 3): indices into ``vertices``, counter-clockwise from outside
    ``colors``         uint8 (f, 3, 3): red, green, blue at each corner of each face, or None:
                       ``BASE_COLOR`` everywhere
    ``normals``        float64 (v, 3) outward unit vectors, or None: they follow from the faces
    ``smooth``         False where the faces are meant to be seen as facets under Gouraud shading
    ``up``             the direction that is up in the picture
    ``eye_direction``  from the scene to the eye of the default camera; None: three-quarter view
    ``notes``          what a mesh file holds that is not in the mesh: warnings of one line each

    Raises ``InputError`` where an array has the wrong dtype, shape or range.
    """

    vertices: NDArray[np.float64]
    faces: NDArray[np.int64]
    colors: NDArray[np.uint8] | None = None
    normals: NDArray[np.float64] | None = None
    smooth: bool = True
    up: Vector = UP_Z
    eye_direction: Vector | None = None
    notes: tuple[str, ...] = ()

    def __post_init__(self) -> None:
        vertex_count = len(self.vertices) if self.vertices.ndim else 0
        face_count = len(self.faces) if self.faces.ndim else 0
        for field, array, dtype, shape in (
            ("vertices", self.vertices, np.float64, (vertex_count, 3)),
            ("faces", self.faces, np.int64, (face_count, 3)),
            ("colors", self.colors, np.uint8, (face_count, 3, 3)),
            ("normals", self.normals, np.float64, (vertex_count, 3)),
        ):
            if array is not None and (array.dtype != dtype or array.shape != shape):
                raise InputError(f"mesh: {field}: is {array.dtype} of shape {array.shape}, "
                                 f"needs {np.dtype(dtype)} of shape {shape}")
        if face_count == 0:
            raise InputError("mesh: faces: there are none; export the mesh with its triangles")
        # The least and the greatest tell of all, without arrays of as many in between.
        limits = (self.vertices.min(), self.vertices.max()) if vertex_count else (0.0, 0.0)
        if not np.isfinite(limits).all():
            index = int(np.flatnonzero(~np.isfinite(self.vertices).all(axis=1))[0])
            raise InputError(f"mesh: vertices: vertex {index} is not a number or infinite; "
                             "repair the mesh")
        if max(-limits[0], limits[1]) > COORDINATE_LIMIT:
            raise InputError(f"mesh: vertices: coordinates beyond {COORDINATE_LIMIT:g}; "
                             "scale the mesh down")
        if self.faces.view(np.uint64).max() >= vertex_count:  # a negative one is a great one
            bad = (self.faces < 0) | (self.faces >= vertex_count)
            face = int(np.flatnonzero(bad.any(axis=1))[0])
            raise InputError(f"mesh: faces: face {face} names vertex {self.faces[bad][0]}, but "
                             f"there are {vertex_count} vertices; repair the mesh")
        if self.normals is not None and not np.isfinite(self.normals).all():
            raise InputError("mesh: normals: not a number or infinite; repair the mesh")

    @property
    def triangles(self) -> int:
        return len(self.faces)

    def corners(self) -> NDArray[np.float64]:
        """The positions of the three corners of each face, float64 (f, 3, 3)."""
        return self.vertices[self.faces]

    def corner_colors(self) -> NDArray[np.uint8]:
        """The colour at each corner of each face, uint8 (f, 3, 3)."""
        if self.colors is not None:
            return self.colors
        return np.tile(np.array(BASE_COLOR, np.uint8), (self.triangles, 3, 1))

    def degenerate(self) -> NDArray[np.bool_]:
        """True for each face without area, bool (f,): it draws nothing."""
        edges = edge_vectors(self.corners())
        longest = np.abs(edges).max(axis=(1, 2))
        # Scaled to the size of the face, so that neither tiny nor huge units mislead.
        edges = edges / np.where(longest == 0.0, 1.0, longest)[:, None, None]
        return length(cross(edges[:, 0], -edges[:, 2])) <= DEGENERATE_RATIO


def edge_vectors(corners: NDArray[np.float64]) -> NDArray[np.float64]:
    """Edges 0→1, 1→2, 2→0 of triangles (f, 3, 3), same shape."""
    return np.roll(corners, -1, axis=1) - corners


def cross(a: NDArray[np.float64], b: NDArray[np.float64]) -> NDArray[np.float64]:
    """Cross product over the last axis, element by element.

    Written out: every element is rounded alike wherever it stands in the array,
    which a matrix routine does not promise, and equal vertices must stay equal.
    """
    return np.stack(
        (
            a[..., 1] * b[..., 2] - a[..., 2] * b[..., 1],
            a[..., 2] * b[..., 0] - a[..., 0] * b[..., 2],
            a[..., 0] * b[..., 1] - a[..., 1] * b[..., 0],
        ),
        axis=-1,
    )


def dot(a: NDArray[np.float64], b: NDArray[np.float64]) -> NDArray[np.float64]:
    """Scalar product over the last axis, element by element (see ``cross``)."""
    product: NDArray[np.float64] = (
        a[..., 0] * b[..., 0] + a[..., 1] * b[..., 1] + a[..., 2] * b[..., 2]
    )
    return product


def length(a: NDArray[np.float64]) -> NDArray[np.float64]:
    """Euclidean length over the last axis."""
    return np.sqrt(dot(a, a))


def normalised(a: NDArray[np.float64]) -> NDArray[np.float64]:
    """Unit vectors over the last axis; a zero vector stays zero."""
    # Scaled by the greatest component first: the square of a small vector underflows.
    greatest = np.abs(a).max(axis=-1, keepdims=True)
    scaled = a / np.where(greatest == 0.0, 1.0, greatest)
    size = length(scaled)[..., None]
    return np.asarray(scaled / np.where(size == 0.0, 1.0, size), np.float64)


def face_normals(mesh: Mesh) -> NDArray[np.float64]:
    """Outward unit normal of each face, float64 (f, 3); zero for a degenerate one."""
    edges = normalised(edge_vectors(mesh.corners()))
    normals = normalised(cross(edges[:, 0], -edges[:, 2]))
    normals[mesh.degenerate()] = 0.0
    return normals


def corner_normals(mesh: Mesh) -> NDArray[np.float64]:
    """Outward unit normal at each corner of each face, float64 (f, 3, 3).

    The mesh's own normals where it has them.  Otherwise, for a smooth mesh, the
    mean of the faces that meet at the corner's *position* within the crease
    angle, each weighted by its angle there; so the result does not depend on
    whether a file format shares vertices between faces or repeats them.
    """
    if mesh.normals is not None:
        return mesh.normals[mesh.faces]
    of_face = face_normals(mesh)
    faceted = np.repeat(of_face[:, None], 3, axis=1)
    return _creased(mesh, faceted) if mesh.smooth else faceted


def _creased(mesh: Mesh, faceted: NDArray[np.float64]) -> NDArray[np.float64]:
    edges = normalised(edge_vectors(mesh.corners()))
    incoming, outgoing = -np.roll(edges, 1, axis=1), edges
    angle = np.arctan2(length(cross(outgoing, incoming)), dot(outgoing, incoming))

    # -0.0 and 0.0 are one position; adding 0.0 makes them one bit pattern.
    _, place = np.unique(mesh.vertices + 0.0, axis=0, return_inverse=True)
    place_of_corner = place.reshape(-1)[mesh.faces].reshape(-1)
    order = np.argsort(place_of_corner, kind="stable")
    normal = faceted.reshape(-1, 3)[order]
    weight = angle.reshape(-1)[order]
    _, first, size = np.unique(place_of_corner[order], return_index=True, return_counts=True)
    start = np.repeat(first, size)
    count = np.repeat(size, size)

    # The r-th corner of each place in turn, so that all corners of a place add in one order.
    total = np.zeros_like(normal)
    active = np.flatnonzero(count <= FAN_LIMIT)
    rank = 0
    while len(active):
        other = start[active] + rank
        near = dot(normal[active], normal[other]) >= CREASE_COSINE
        chosen, other = active[near], other[near]
        total[chosen] += normal[other] * weight[other, None]
        rank += 1
        active = active[count[active] > rank]
    smooth = normalised(total)
    lost = length(smooth) == 0.0
    smooth[lost] = normal[lost]
    result = np.empty_like(smooth)
    result[order] = smooth
    return result.reshape(faceted.shape)
