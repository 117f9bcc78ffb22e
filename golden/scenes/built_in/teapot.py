"""The Utah teapot from Newell's 32 Bézier patches (Newell 1975; Crow, IEEE CG&A 7(1), 1987).

Six of the ten different patches belong to surfaces of revolution and stand four
times about the z axis; the other four, halves of handle and spout, stand twice,
mirrored in the plane y = 0.  The proportions are Blinn's, the ones in common
use (Newell's own teapot is 1.3 times as tall).  The bottom is Crow's.
"""

from __future__ import annotations

from typing import Final

import numpy as np
from numpy.typing import NDArray

from ..mesh import Mesh, cross, length, normalised

_Profile = tuple[tuple[float, float, float], ...]

#: Surfaces of revolution: four rows of (radius, tangent length, height), outside to the left
#: on the way down.  A quarter turn's control points are (r, 0), (r, -t), (t, -r), (0, -r).
_RIM: Final[_Profile] = (
    (1.4, 0.784, 2.4), (1.3375, 0.749, 2.53125), (1.4375, 0.805, 2.53125), (1.5, 0.84, 2.4),
)  # fmt: skip
_UPPER_BODY: Final[_Profile] = (
    (1.5, 0.84, 2.4), (1.75, 0.98, 1.875), (2.0, 1.12, 1.35), (2.0, 1.12, 0.9),
)  # fmt: skip
_LOWER_BODY: Final[_Profile] = (
    (2.0, 1.12, 0.9), (2.0, 1.12, 0.45), (1.5, 0.84, 0.225), (1.5, 0.84, 0.15),
)  # fmt: skip
_BOTTOM: Final[_Profile] = (
    (1.5, 0.84, 0.15), (1.5, 0.84, 0.075), (1.425, 0.798, 0.0), (0.0, 0.0, 0.0),
)  # fmt: skip
_KNOB: Final[_Profile] = (
    (0.0, 0.0, 3.15), (0.8, 0.45, 3.15), (0.0, 0.0, 2.85), (0.2, 0.112, 2.7),
)  # fmt: skip
_LID: Final[_Profile] = (
    (0.2, 0.112, 2.7), (0.4, 0.224, 2.55), (1.3, 0.728, 2.55), (1.3, 0.728, 2.4),
)  # fmt: skip

_Half = tuple[tuple[tuple[float, float], tuple[float, float], float], ...]

#: Handle and spout: four rows of ((x, z) of the inner curve, (x, z) of the outer, half width).
#: A half's control points are inner at y = 0, inner at -w, outer at -w, outer at y = 0.
_UPPER_HANDLE: Final[_Half] = (
    ((-1.6, 2.025), (-1.5, 2.25), 0.3), ((-2.3, 2.025), (-2.5, 2.25), 0.3),
    ((-2.7, 2.025), (-3.0, 2.25), 0.3), ((-2.7, 1.8), (-3.0, 1.8), 0.3),
)  # fmt: skip
_LOWER_HANDLE: Final[_Half] = (
    ((-2.7, 1.8), (-3.0, 1.8), 0.3), ((-2.7, 1.575), (-3.0, 1.35), 0.3),
    ((-2.5, 1.125), (-2.65, 0.9375), 0.3), ((-2.0, 0.9), (-1.9, 0.6), 0.3),
)  # fmt: skip
_LOWER_SPOUT: Final[_Half] = (
    ((1.7, 1.425), (1.7, 0.6), 0.66), ((2.6, 1.425), (3.1, 0.825), 0.66),
    ((2.3, 2.1), (2.4, 2.025), 0.25), ((2.7, 2.4), (3.3, 2.4), 0.25),
)  # fmt: skip
_UPPER_SPOUT: Final[_Half] = (
    ((2.7, 2.4), (3.3, 2.4), 0.25), ((2.8, 2.475), (3.525, 2.49375), 0.25),
    ((2.9, 2.475), (3.45, 2.5125), 0.15), ((2.8, 2.4), (3.2, 2.4), 0.15),
)  # fmt: skip


def _quarters(profile: _Profile) -> list[NDArray[np.float64]]:
    """The four patches (4, 4, 3) of a surface of revolution."""
    quarter = np.array(
        [[(r, 0, z), (r, -t, z), (t, -r, z), (0, -r, z)] for r, t, z in profile], np.float64
    )
    patches = [quarter]
    for _ in range(3):
        x, y, z = np.moveaxis(patches[-1], 2, 0)
        patches.append(np.stack([y, -x, z], axis=2))
    return patches


def _halves(rows: _Half) -> list[NDArray[np.float64]]:
    """The two patches (4, 4, 3) of a piece of handle or spout."""
    half = np.array(
        [
            [(inner[0], 0, inner[1]), (inner[0], -w, inner[1]),
             (outer[0], -w, outer[1]), (outer[0], 0, outer[1])]
            for inner, outer, w in rows
        ],
        np.float64,
    )  # fmt: skip
    return [half, half[:, ::-1] * np.array([1.0, -1.0, 1.0])]


def teapot_parts() -> list[NDArray[np.float64]]:
    """Control points (patches, 4, 4, 3) of body with bottom, handle, spout and lid: 32 patches.

    A part is a surface without gaps; the parts only touch or pierce each other.
    """
    body = [patch for p in (_RIM, _UPPER_BODY, _LOWER_BODY, _BOTTOM) for patch in _quarters(p)]
    handle = _halves(_UPPER_HANDLE) + _halves(_LOWER_HANDLE)
    spout = _halves(_LOWER_SPOUT) + _halves(_UPPER_SPOUT)
    lid = _quarters(_KNOB) + _quarters(_LID)
    return [np.stack(part) + 0.0 for part in (body, handle, spout, lid)]


def teapot_triangles(tessellation: int) -> int:
    """Two for each step of each patch, less one at each step along the eight poles' edges."""
    return 64 * tessellation**2 - 8 * tessellation


def teapot(tessellation: int) -> Mesh:
    """The teapot, standing on z = 0, spout towards +x; ``tessellation`` steps a patch side.

    Patches of one part share the vertices on their common boundaries, so a part
    is watertight but for the openings it is meant to have.
    """
    all_vertices, all_normals, all_faces = [], [], []
    first = 0
    for patches in teapot_parts():
        vertices, normals, faces = _tessellated(patches, tessellation)
        all_vertices.append(vertices)
        all_normals.append(normals)
        all_faces.append(faces + first)
        first += len(vertices)
    return Mesh(
        np.concatenate(all_vertices),
        np.concatenate(all_faces),
        normals=np.concatenate(all_normals),
    )


def _tessellated(
    patches: NDArray[np.float64], steps: int
) -> tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.int64]]:
    """Vertices, normals and faces of one part, equal positions merged."""
    points, normals = _evaluated(patches, steps)
    row = np.arange(steps)
    corner = (row[:, None] * (steps + 1) + row[None]).reshape(-1)
    below, right, both = corner + steps + 1, corner + 1, corner + steps + 2
    two = np.stack([np.stack([corner, both, below], 1), np.stack([corner, right, both], 1)], 1)
    offset = np.arange(len(patches))[:, None, None] * (steps + 1) ** 2
    faces = (two.reshape(-1, 3)[None] + offset).reshape(-1, 3)

    merged, place = np.unique(points.reshape(-1, 3) + 0.0, axis=0, return_inverse=True)
    place = place.reshape(-1)
    total = np.zeros_like(merged)
    np.add.at(total, place, normals.reshape(-1, 3))
    faces = place[faces].astype(np.int64)
    a, b, c = faces.T
    return merged, normalised(total), faces[(a != b) & (b != c) & (c != a)]


def _evaluated(
    patches: NDArray[np.float64], steps: int
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Points and unit normals (patches, steps + 1, steps + 1, 3) on a grid of parameters."""
    basis, slope = _bernstein(steps)
    along = _blend(patches.swapaxes(1, 2), basis).swapaxes(1, 2)  # (p, 4, steps + 1, 3)
    # A coordinate that is constant along a row stays so exactly: a pole must be one point.
    level = (patches == patches[:, :, :1]).all(axis=2, keepdims=True)
    along = np.where(level, patches[:, :, :1], along)
    along_slope = _blend(patches.swapaxes(1, 2), slope).swapaxes(1, 2)
    points = _blend(along, basis)
    down = _blend(along, slope)
    across = _blend(along_slope, basis)
    # At a pole the row has shrunk to a point and `across` vanishes; the normal's limit is
    # found from how fast it grows on the way from the pole.
    twist = _blend(along_slope, slope)
    pole = length(across) < 1e-12
    at_end = np.zeros((1, steps + 1, 1, 1))
    at_end[:, -1] = 1.0  # the last row is reached from the other side
    twist = np.where(at_end == 1.0, -twist, twist)
    across = np.where(pole[..., None], twist, across)
    return points, normalised(cross(across, down))


def _bernstein(steps: int) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Cubic Bernstein polynomials and their derivatives at k / steps, (steps + 1, 4) each."""
    t = np.arange(steps + 1) / steps
    s = np.arange(steps, -1, -1) / steps
    basis = np.stack([s * s * s, 3 * s * s * t, 3 * s * t * t, t * t * t], axis=1)
    slope = np.stack(
        [-3 * s * s, 3 * s * s - 6 * s * t, 6 * s * t - 3 * t * t, 3 * t * t], axis=1
    )
    return basis, slope


def _blend(control: NDArray[np.float64], weights: NDArray[np.float64]) -> NDArray[np.float64]:
    """Sum of four control points (p, 4, m, 3) by weights (k, 4): (p, k, m, 3).

    Term by term, so that a boundary, where the weights are zeros and ones, is
    the same bits from both patches that share it.
    """
    w = weights[None, :, :, None, None]
    c = control[:, None]
    total: NDArray[np.float64] = (
        c[:, :, 0] * w[:, :, 0]
        + c[:, :, 1] * w[:, :, 1]
        + c[:, :, 2] * w[:, :, 2]
        + c[:, :, 3] * w[:, :, 3]
    )
    return total
