"""A scene file, read: looked at as often as wanted."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from pathlib import Path

import numpy as np

from ...specification.display_list import DisplayList
from ...specification.errors import InputError
from ..camera import FRAMED, View, direction_of
from ..lighting import DEFAULT_LIGHTING, Lighting, Shading
from ..mesh import UP_Y, Mesh
from ..mesh_display_list import Color, display_list_of_mesh
from ..quantise import PictureFormat
from .description import SceneDescription
from .object_list import ObjectList
from .orthographic import object_list
from .parse import read_scene_file
from .perspective import scene_camera, scene_mesh
from .placed_objects import PlacedObjects, placed_objects

DEFAULT_BACKGROUND: Color = (0, 0, 0)


@dataclass(frozen=True, eq=False)
class SceneFile:
    """What a scene file says, with its objects in their places."""

    description: SceneDescription
    placed: PlacedObjects

    @classmethod
    def read(cls, path: Path, most_triangles: int) -> SceneFile:
        """Raises ``InputError`` for whatever cannot be used."""
        description = read_scene_file(path)
        return cls(description, placed_objects(description, most_triangles))

    @property
    def notes(self) -> tuple[str, ...]:
        """Warnings of one line each, of the meshes that it names."""
        return tuple(note for mesh in self.placed.meshes for note in mesh.notes)

    @property
    def direction(self) -> tuple[float, float]:
        """Azimuth and elevation in degrees from where it is seen if nothing is said."""
        if self.orthographic:
            return 0.0, 0.0
        return direction_of(np.subtract(self.description.eye, self.description.target), UP_Y)

    @property
    def orthographic(self) -> bool:
        return self.description.projection == "orthographic"

    def display_list(self, picture: PictureFormat, *, view: View = FRAMED,
                     lighting: Lighting = DEFAULT_LIGHTING, shading: Shading = "gouraud",
                     background: Color | None = None, cull: bool = False) -> DisplayList:
        """The scene, as its file says or as is asked for."""
        if self.orthographic:
            return self.objects(picture, view=view, lighting=lighting, shading=shading,
                                background=background, cull=cull).display_list()
        return display_list_of_mesh(
            self._mesh, picture, shading=shading, camera=scene_camera(self.description, view),
            background=self._background(background), lighting=self._lighting(lighting), cull=cull)

    def objects(self, picture: PictureFormat, *, view: View = FRAMED,
                lighting: Lighting = DEFAULT_LIGHTING, shading: Shading = "gouraud",
                background: Color | None = None, cull: bool = False) -> ObjectList:
        """The same as objects.  ``InputError`` in perspective, where every object has a shape of
        its own."""
        if not self.orthographic:
            raise InputError(f"{self.description.path}: projection: objects are sent whole only in "
                             "orthographic pictures; leave perspective out, or send triangles")
        return object_list(
            self.description, self.placed, picture, view=view, lighting=self._lighting(lighting),
            shading=shading, background=self._background(background), cull=cull)

    @cached_property
    def _mesh(self) -> Mesh:
        return scene_mesh(self.placed)

    def _lighting(self, asked: Lighting) -> Lighting:
        """The file's, but for what is asked for."""
        described = self.description
        ambient = DEFAULT_LIGHTING.ambient
        if described.ambient is not None:
            ambient = described.ambient / 100.0
        direction = asked.direction
        if described.light is not None and direction == DEFAULT_LIGHTING.direction:
            direction = described.light
        return Lighting(ambient, direction)

    def _background(self, asked: Color | None) -> Color:
        if asked is not None:
            return asked
        return self.description.background or DEFAULT_BACKGROUND
