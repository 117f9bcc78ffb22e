"""A scene in perspective: one mesh of all objects, and a camera where the file puts the eye."""

from __future__ import annotations

import math

import numpy as np

from ...specification.errors import InputError
from ..camera import Camera, View, seen_from
from ..mesh import UP_Y, Mesh
from .description import SceneDescription
from .placed_objects import PlacedObjects


def scene_mesh(placed: PlacedObjects) -> Mesh:
    """All objects at their places, each in its colour."""
    vertices, faces, colors = [], [], []
    first = 0
    for number, place, color in zip(placed.mesh.tolist(), placed.position, placed.color,
                                    strict=True):
        mesh = placed.meshes[number]
        vertices.append(mesh.vertices + place)
        faces.append(mesh.faces + first)
        first += len(mesh.vertices)
        own = 1.0 if mesh.colors is None else mesh.colors / 255.0
        colors.append(np.broadcast_to(np.round(own * color), (mesh.triangles, 3, 3)))
    return Mesh(np.concatenate(vertices), np.concatenate(faces),
                np.concatenate(colors).astype(np.uint8), up=UP_Y)


def scene_camera(description: SceneDescription, view: View) -> Camera:
    """The camera of the file; ``view`` moves the eye about what it looks at, and zooms."""
    eye, target, up = description.eye, description.target, description.up
    if view.direction is not None:
        towards, upwards = seen_from(UP_Y, *view.direction)
        moved = np.array(target) + towards * math.dist(eye, target)
        eye = float(moved[0]), float(moved[1]), float(moved[2])
        up = float(upwards[0]), float(upwards[1]), float(upwards[2])
    half = math.tan(math.radians(description.field_of_view) / 2.0) / view.zoom
    field_of_view = max(1.0, math.degrees(2.0 * math.atan(half)))
    try:
        return Camera(eye, target, up, description.field_of_view if view.zoom == 1.0
                      else field_of_view)
    except InputError as error:
        raise InputError(f"{description.path}: {error}") from None
