"""Ambient and directional light: a colour for each corner of each face."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Final, Literal

import numpy as np
from numpy.typing import NDArray

from ..specification.errors import InputError
from .camera import Camera
from .mesh import Mesh, Vector, corner_normals, dot, face_normals, normalised

Shading = Literal["flat", "gouraud"]

SHADINGS: Final[tuple[Shading, ...]] = ("flat", "gouraud")


@dataclass(frozen=True)
class Lighting:
    """One distant light that moves with the camera, and light from everywhere.

    ``ambient``    the share, 0 … 1, that every surface gets; the rest follows Lambert's law
    ``direction``  towards the light, in camera axes: right, up, towards the eye

    The default shines over the left shoulder, so that any scene is modelled by
    it from any side.  Raises ``InputError`` where a number cannot be used.
    """

    ambient: float = 0.2
    direction: Vector = (-0.45, 0.65, 0.6)

    def __post_init__(self) -> None:
        if not 0.0 <= self.ambient <= 1.0:
            raise InputError(f"ambient: {self.ambient!r} is not from 0 to 1")
        if not 1e-9 <= math.hypot(*self.direction) <= 1e9:
            raise InputError(f"light: {self.direction!r} is no direction; take three numbers: "
                             "right, up, towards the eye")


DEFAULT_LIGHTING: Final = Lighting()


def check_shading(shading: str) -> Shading:
    """The shading of that name; ``InputError`` if there is none."""
    for known in SHADINGS:
        if shading == known:
            return known
    raise InputError(f"shading: {shading!r} is unknown; use one of {', '.join(SHADINGS)}")


def lit_corners(
    mesh: Mesh, camera: Camera, shading: Shading, lighting: Lighting = DEFAULT_LIGHTING
) -> NDArray[np.float64]:
    """Red, green, blue 0 … 255 at each corner of each face, float64 (f, 3, 3).

    ``flat``: one colour a face, its corners' mean under the face's own normal.
    ``gouraud``: each corner by its own normal.

    Both sides of a face are lit: its normal is taken on the side that the eye
    sees, so open or badly wound meshes look right.
    """
    normals = corner_normals(mesh) if shading == "gouraud" else _repeated(face_normals(mesh))
    normals = _towards_eye(normals, mesh, camera)
    light = normalised(np.array([lighting.direction]))[0]
    axes = camera.axes()
    towards_light = axes[0] * light[0] + axes[1] * light[1] + axes[2] * light[2]
    lambert = np.maximum(dot(normals, np.broadcast_to(towards_light, normals.shape)), 0.0)
    intensity = lighting.ambient + (1.0 - lighting.ambient) * lambert
    colors = mesh.corner_colors().astype(np.float64)
    if shading == "flat":
        colors = _repeated((colors[:, 0] + colors[:, 1] + colors[:, 2]) / 3.0)
    return np.asarray(colors * intensity[..., None], np.float64)


def _repeated(of_face: NDArray[np.float64]) -> NDArray[np.float64]:
    return np.repeat(of_face[:, None], 3, axis=1)


def _towards_eye(
    normals: NDArray[np.float64], mesh: Mesh, camera: Camera
) -> NDArray[np.float64]:
    """Corner normals (f, 3, 3) on the side of their *face* that the eye sees.

    Decided by the face: a corner on the outline of a rounded body may lean away
    from the eye a little, and turning it round would light it from behind.
    """
    facing = face_normals(mesh)
    away = dot(facing, mesh.corners()[:, 0] - np.array(camera.eye)) > 0.0
    facing = np.where(away[:, None], -facing, facing)
    turned = dot(normals, _repeated(facing)) < 0.0
    return np.where(turned[..., None], -normals, normals)
