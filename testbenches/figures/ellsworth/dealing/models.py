"""The models that the figures turn, in place of the paper's, and their triangles frame by frame."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from .....golden.reference.coverage import Triangles
from .....golden.scene_display_list import LoadedScene, make_display_list, read_scene
from .....golden.scenes.camera import View, framing_camera, transform
from .....golden.scenes.mesh import Mesh
from .....golden.scenes.mesh_display_list import display_list_of_corners
from .....golden.scenes.quantise import PictureFormat
from .....golden.specification.display_list import DisplayList
from .....golden.specification.errors import InputError
from .....golden.specification.sampling_grid import Grid
from ....atlas.points.atlas_scene import AtlasScene
from ....machine_options import MachineOptions

Size = tuple[int, int]


@dataclass(frozen=True)
class FigureModel:
    """What turns by ``turn`` degrees a frame about what is up.

    ``scene``       a scene's name or file, as for any command; a mesh or a scene file
    ``zoom``        how much larger than framed it is seen
    ``best_ratio``  what the paper finds best for the model in whose place it is, if it is in one's
    """

    name: str
    scene: str
    frames: int
    turn: float
    zoom: float = 1.0
    best_ratio: int | None = None

    def views(self, first: int, count: int, loaded: LoadedScene) -> Iterator[View]:
        """Of so many frames; those before the first, which go on backwards, as well."""
        assert loaded.direction is not None
        azimuth, elevation = loaded.direction
        for frame in range(first, first + count):
            yield View((azimuth + self.turn * frame, elevation), self.zoom)

    def lists(self, size: Size, first: int, count: int, *, lit: bool = False
              ) -> Iterator[DisplayList]:
        """Of such frames, back faces left out; a mesh without colours unless ``lit``, which takes
        most of the time.  Raises ``InputError`` for a scene that does not turn."""
        loaded = self.load()
        width, height = size
        mesh = loaded.mesh
        faces = None if mesh is None else mesh.faces[~mesh.degenerate()]
        for view in self.views(first, count, loaded):
            if lit or mesh is None or faces is None:
                yield make_display_list(loaded, width=width, height=height, view=view,
                                        shading="flat", cull=True).display_list
            else:
                yield _unlit(mesh, faces, view, PictureFormat(width, height))

    def load(self) -> LoadedScene:
        loaded = read_scene(self.scene)
        if loaded.direction is None:
            raise InputError(f"--model: {self.scene} is no mesh and cannot be turned; take a mesh")
        return loaded

    def identity(self, size: Size) -> str:
        """Of the files that it is made from, so that nothing is kept under a changed one's name.
        Raises ``InputError``."""
        return AtlasScene.of(self.scene, size, MachineOptions()).identity


def _unlit(mesh: Mesh, faces: NDArray[np.int64], view: View, picture: PictureFormat
           ) -> DisplayList:
    """Of the faces that have area."""
    matrix = framing_camera(mesh, view).matrix(picture, mesh.vertices)
    corners = np.zeros((len(faces), 3, 7))
    corners[..., :4] = transform(matrix, mesh.vertices)[faces]
    return display_list_of_corners(corners, picture, cull=True)


def figure_models(frames: int | None = None, turn: float = 4.5) -> list[FigureModel]:
    """In place of the paper's head, of 59,592 triangles, and of its polio virus, of 806,640, which
    is so near that its triangles are as large as the paper's; ``frames`` of each, or as many as a
    few minutes allow."""
    return [
        FigureModel("head", "head:tessellation=86", frames or 80, turn, best_ratio=12),
        FigureModel("virus", "capsid:count=394,depth=4", frames or 24, turn, 1.7, best_ratio=4)]


def triangles_of(display_list: DisplayList) -> Triangles:
    """Those that may cover a pixel."""
    return Triangles.of(display_list, Grid.of(display_list))


def mean_box(triangles: Triangles, sub_bits: int) -> tuple[float, float]:
    """Width and height of a triangle's box in pixels, exact ones, not of pixel centres."""
    width, height = (float(np.ptp(each, axis=0).mean()) / (1 << sub_bits) if len(triangles) else 0.0
                     for each in (triangles.x, triangles.y))
    return width, height
