"""The camera: where the eye is, and the matrix from world space to homogeneous pixels."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Final

import numpy as np
from numpy.typing import NDArray

from ..specification.errors import InputError
from .mesh import UP_Z, Mesh, Vector
from .quantise import PictureFormat

#: Three-quarter view: so far to the right of straight on, and so far above.
AZIMUTH_DEGREES: Final = 25.0
ELEVATION_DEGREES: Final = 30.0

FIELD_OF_VIEW_DEGREES: Final = 35.0

#: Of the middle of the picture; such that a field of view is one that ``Camera`` takes.
ZOOM_RANGE: Final = (0.05, 30.0)

#: Room around the bounding sphere, also before the near plane and behind the far one.
MARGIN: Final = 1.01

#: An eye inside the scene sees from this fraction of the greatest distance on.
NEAREST_FRACTION: Final = 1.0 / 1024.0


@dataclass(frozen=True)
class Camera:
    """A perspective camera in world space.

    ``eye``, ``target``  positions; the target is in the middle of the picture
    ``up``               any direction but the line of sight: up in the picture
    ``field_of_view``    degrees, 1 … 170, across the smaller side of the picture
    ``near``             distance of the near plane along the line of sight; None: fits the scene
    ``far``              distance of depth 1; None, or nearer than the scene's end: at that end

    Raises ``InputError`` where a number cannot be used.
    """

    eye: Vector
    target: Vector
    up: Vector = UP_Z
    field_of_view: float = FIELD_OF_VIEW_DEGREES
    near: float | None = None
    far: float | None = None

    def __post_init__(self) -> None:
        for field in ("eye", "target", "up"):
            value = getattr(self, field)
            if len(value) != 3 or not all(math.isfinite(c) for c in value):
                raise InputError(f"camera: {field}: {value!r} is not three finite numbers")
        if not 1.0 <= self.field_of_view <= 170.0:
            raise InputError(f"camera: field_of_view: {self.field_of_view!r} is not from 1 to "
                             "170 degrees")
        for field in ("near", "far"):
            value = getattr(self, field)
            if value is not None and not (math.isfinite(value) and value > 0.0):
                raise InputError(f"camera: {field}: {value!r} is not a distance above 0")
        sight = np.subtract(self.target, self.eye)
        if not np.linalg.norm(sight) > 0.0:
            raise InputError("camera: target: is where the eye is; move one of them")
        sideways = np.linalg.norm(np.cross(sight, self.up))
        if not sideways > 1e-9 * np.linalg.norm(sight) * np.linalg.norm(self.up):
            raise InputError("camera: up: is along the line of sight; choose another direction")

    def axes(self) -> NDArray[np.float64]:
        """Unit vectors right, up and towards the eye, the rows of a float64 (3, 3)."""
        backward = _unit(np.subtract(self.eye, self.target))
        right = _unit(np.cross(self.up, backward))
        return np.stack([right, np.cross(backward, right), backward])

    def view_matrix(self) -> NDArray[np.float64]:
        """World to eye space: x right, y up, the eye looking along -z."""
        matrix = np.eye(4)
        matrix[:3, :3] = self.axes()
        matrix[:3, 3] = -self.axes() @ np.array(self.eye)
        return matrix

    def projection_matrix(
        self, picture: PictureFormat, near: float, far: float
    ) -> NDArray[np.float64]:
        """Eye space to homogeneous pixels X, Y, Z, w: y down, Z/w from 0 at near to 1 at far."""
        smaller = min(picture.width, picture.height)
        focal = smaller / 2.0 / math.tan(math.radians(self.field_of_view) / 2.0)
        depth = far / (far - near)
        return np.array(
            [
                [focal, 0.0, -picture.width / 2.0, 0.0],
                [0.0, -focal, -picture.height / 2.0, 0.0],
                [0.0, 0.0, -depth, -depth * near],
                [0.0, 0.0, -1.0, 0.0],
            ]
        )

    def depth_range(self, vertices: NDArray[np.float64]) -> tuple[float, float]:
        """Distances of the near and far planes for a scene: nothing is lost behind the far one."""
        distances = -transform(self.view_matrix()[2:3], vertices)[:, 0]
        farthest = float(distances.max(initial=0.0))
        far = max(farthest, self.far or 0.0)
        near = self.near
        if near is None:
            nearest = float(distances.min(initial=math.inf))
            near = max(min(nearest, far) / MARGIN, far * NEAREST_FRACTION)
        if near <= 0.0:  # all of the scene is behind the eye
            near = 1.0
        # A scene at one distance still needs a range, and stays nearest.
        return near, far if far > near else near * 2.0

    def matrix(
        self, picture: PictureFormat, vertices: NDArray[np.float64]
    ) -> NDArray[np.float64]:
        """World space to homogeneous pixels, (4, 4), for ``transform``."""
        near, far = self.depth_range(vertices)
        return self.projection_matrix(picture, near, far) @ self.view_matrix()


@dataclass(frozen=True)
class View:
    """How a mesh is looked at that a camera frames.

    ``direction``  azimuth and elevation of the eye in degrees: so far to the right of straight on,
                   any number, and so far above, -90 … 90; None: as the mesh asks to be seen, or
                   else a three-quarter view from above
    ``zoom``       how many times larger than framed the middle of the picture is

    Raises ``InputError`` where a number cannot be used.
    """

    direction: tuple[float, float] | None = None
    zoom: float = 1.0

    def __post_init__(self) -> None:
        if self.direction is not None:
            azimuth, elevation = self.direction
            if not math.isfinite(azimuth):
                raise InputError(f"view: azimuth: {azimuth!r} is not a number of degrees")
            if not -90.0 <= elevation <= 90.0:
                raise InputError(f"view: elevation: {elevation!r} is not from -90 to 90 degrees")
        if not ZOOM_RANGE[0] <= self.zoom <= ZOOM_RANGE[1]:
            raise InputError(f"zoom: {self.zoom!r} is not from {ZOOM_RANGE[0]} to {ZOOM_RANGE[1]}")

    @property
    def field_of_view(self) -> float:
        """Degrees, as of ``Camera``."""
        if self.zoom == 1.0:
            return FIELD_OF_VIEW_DEGREES
        half = math.tan(math.radians(FIELD_OF_VIEW_DEGREES) / 2.0) / self.zoom
        return 2.0 * math.degrees(math.atan(half))


FRAMED: Final = View()


def framing_camera(mesh: Mesh, view: View = FRAMED) -> Camera:
    """The camera that sees all of a mesh: its bounding sphere fills the picture, or a zoom's share
    of it.

    What is up follows the mesh.  A z-up scene is seen from -y with x to the right, a y-up scene
    from +z with x to the right.
    """
    used = mesh.vertices[np.unique(mesh.faces)]
    low, high = used.min(axis=0), used.max(axis=0)
    center = low / 2.0 + high / 2.0
    radius = float(np.sqrt(((used - center) ** 2).sum(axis=1)).max())
    if radius == 0.0:  # one point: nothing to frame, yet a camera must exist
        radius = 1.0
    # The eye must not coincide with the target by rounding.
    radius = max(radius, 1e-12 * float(np.abs(center).max()), 1e-100) * MARGIN
    distance = radius / math.sin(math.radians(FIELD_OF_VIEW_DEGREES) / 2.0)
    up: Vector = mesh.up
    if view.direction is not None:
        direction, upwards = seen_from(mesh.up, *view.direction)
        up = (float(upwards[0]), float(upwards[1]), float(upwards[2]))
    elif mesh.eye_direction is None:
        direction, _ = seen_from(mesh.up, AZIMUTH_DEGREES, ELEVATION_DEGREES)
    else:
        direction = _unit(np.array(mesh.eye_direction))
    eye = center + direction * distance
    return Camera(
        eye=(float(eye[0]), float(eye[1]), float(eye[2])),
        target=(float(center[0]), float(center[1]), float(center[2])),
        up=up,
        field_of_view=view.field_of_view,
        near=distance - radius,
        far=distance + radius,
    )


def seen_direction(mesh: Mesh) -> tuple[float, float]:
    """Azimuth and elevation in degrees, as in ``View``, from where a mesh asks to be seen."""
    if mesh.eye_direction is None:
        return AZIMUTH_DEGREES, ELEVATION_DEGREES
    return direction_of(np.array(mesh.eye_direction), mesh.up)


def direction_of(towards: NDArray[np.float64], upwards: Vector) -> tuple[float, float]:
    """Azimuth and elevation of a direction towards the eye, where ``upwards`` is up."""
    right, front, up = (float(axis @ _unit(towards)) for axis in _level_axes(upwards))
    return (math.degrees(math.atan2(right, front)),
            math.degrees(math.asin(min(1.0, max(-1.0, up)))))


def _level_axes(up: Vector) -> NDArray[np.float64]:
    """Unit vectors right, to the front, and up, of a scene with that direction up."""
    upwards = _unit(np.array(up))
    across = np.array([1.0, 0.0, 0.0]) if abs(upwards[0]) < 0.9 else np.array([0.0, 1.0, 0.0])
    right = _unit(across - upwards * float(across @ upwards))
    return np.stack([right, np.cross(right, upwards), upwards])


def seen_from(up: Vector, azimuth_degrees: float, elevation_degrees: float
               ) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Unit vectors towards the eye, and up in the picture, also from straight above."""
    right, front, upwards = _level_axes(up)
    azimuth, elevation = math.radians(azimuth_degrees), math.radians(elevation_degrees)
    level = right * math.sin(azimuth) + front * math.cos(azimuth)
    towards = level * math.cos(elevation) + upwards * math.sin(elevation)
    return towards, upwards * math.cos(elevation) - level * math.sin(elevation)


def _unit(vector: NDArray[np.float64]) -> NDArray[np.float64]:
    return np.asarray(vector / np.linalg.norm(vector), np.float64)


def transform(matrix: NDArray[np.float64], points: NDArray[np.float64]) -> NDArray[np.float64]:
    """Rows of a matrix (r, 4) applied to points (n, 3): float64 (n, r).

    Written out term by term: equal points give equal bits wherever they stand,
    which a matrix routine does not promise, and on which watertightness rests.
    """
    x, y, z = points.T
    return np.stack([m[0] * x + m[1] * y + m[2] * z + m[3] for m in matrix], axis=1)
