"""From a scene's name or file to its display list: the front end of every command."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Any, Final

from .hard_cases.catalogue import hard_case
from .scene_argument import (
    TRIANGLE_LIMIT,
    BuiltInScene,
    DescribedScene,
    DisplayListScene,
    HardCaseScene,
    MeshFileScene,
    Scene,
    parse_scene,
)
from .scenes.built_in.random_triangles import random_display_list
from .scenes.camera import FRAMED, Camera, View, framing_camera, seen_direction
from .scenes.lighting import DEFAULT_LIGHTING, Lighting, Shading, check_shading
from .scenes.mesh import Mesh
from .scenes.mesh_display_list import DEFAULT_BACKGROUND, Color, display_list_of_mesh
from .scenes.mesh_files.load_mesh import load_mesh
from .scenes.quantise import PictureFormat
from .scenes.scene_files.description import SceneDescription
from .scenes.scene_files.parse import read_scene_file
from .scenes.scene_files.scene_file import SceneFile
from .specification.display_list import DisplayList
from .specification.errors import InputError

DEFAULT_SIZE: Final = 64


@dataclass(frozen=True)
class SceneDisplayList:
    """A display list, the ``name`` of its scene, and ``notes``: warnings of one line each."""

    display_list: DisplayList
    name: str
    notes: tuple[str, ...] = ()


@dataclass(frozen=True, eq=False)
class LoadedScene:
    """A scene whose mesh or scene file is there, to be looked at several times; see
    ``read_scene``."""

    scene: Scene
    mesh: Mesh | None
    file: SceneFile | None = None

    @property
    def direction(self) -> tuple[float, float] | None:
        """Azimuth and elevation from where it is seen if nothing is said; None: it cannot be
        turned."""
        if self.file is not None:
            return self.file.direction
        return None if self.mesh is None else seen_direction(self.mesh)

    @property
    def size(self) -> tuple[int, int]:
        """Pixels of its picture, where nothing is said of them."""
        asked = None if self.file is None else self.file.description.size
        return asked or (DEFAULT_SIZE, DEFAULT_SIZE)


def read_scene(scene: str | Path) -> LoadedScene:
    """Read or make a scene's mesh, if it has one, or read its file.  Raises ``InputError``."""
    chosen = parse_scene(scene)
    if isinstance(chosen, DescribedScene):
        return LoadedScene(chosen, None, SceneFile.read(chosen.path, TRIANGLE_LIMIT))
    return LoadedScene(chosen, mesh_of_scene(chosen))


def description_of(scene: str | Path) -> SceneDescription | None:
    """What a scene file says besides its picture; None for any other scene.  Raises
    ``InputError``."""
    chosen = parse_scene(scene)
    return read_scene_file(chosen.path) if isinstance(chosen, DescribedScene) else None


def make_display_list(
    scene: str | Path | LoadedScene,
    *,
    width: int | None = None,
    height: int | None = None,
    sub_bits: int | None = None,
    depth_bits: int | None = None,
    shading: str = "gouraud",
    camera: Camera | None = None,
    view: View = FRAMED,
    background: Color | None = None,
    lighting: Lighting = DEFAULT_LIGHTING,
    cull: bool = False,
) -> SceneDisplayList:
    """The display list of a built-in scene, a mesh or scene file, a hard case or a saved list.

    ``width``, ``height``     pixels; None: 64, or the scene file's or the list's own
    ``sub_bits``              None: 8, or the list's own
    ``depth_bits``            None: 24, or the list's own
    ``shading``               ``gouraud`` or ``flat``
    ``camera``                None: frames the scene, as ``view`` says
    ``background``            red, green, blue; None: dark blue, or the list's own
    ``cull``                  leave out the triangles that face away from the eye

    A saved list is replayed as it is, and a hard case is one: ``shading`` does not touch it.
    Raises ``InputError`` for a scene, file or number that cannot be used, and for whatever such a
    list, or triangles that are made on the screen, cannot be asked for any more.

    >>> import cardcage
    >>> teapot = cardcage.make_display_list("teapot:tessellation=2", width=64, height=64)
    >>> teapot.name, teapot.display_list.triangles
    ('teapot:tessellation=2', 240)
    """
    loaded = scene if isinstance(scene, LoadedScene) else read_scene(scene)
    chosen = loaded.scene
    if isinstance(chosen, DisplayListScene | HardCaseScene):
        given = {"width": width, "height": height, "sub_bits": sub_bits, "depth_bits": depth_bits}
        _refuse(chosen, "a display list is already projected and lit", camera, view, lighting, cull)
        return _replay(chosen, given, background)
    size = loaded.size
    picture = PictureFormat(
        size[0] if width is None else width,
        size[1] if height is None else height,
        PictureFormat.sub_bits if sub_bits is None else sub_bits,
        PictureFormat.depth_bits if depth_bits is None else depth_bits,
    )
    shade = check_shading(shading)
    if loaded.file is not None:
        return _described(loaded.file, chosen, picture, camera, view=view, lighting=lighting,
                          shading=shade, background=background, cull=cull)
    behind = DEFAULT_BACKGROUND if background is None else background
    mesh = loaded.mesh
    if mesh is None:
        assert isinstance(chosen, BuiltInScene)
        _refuse(chosen, "its triangles are made on the screen", camera, view, lighting, cull)
        return _random(chosen, picture, behind, shade)
    if camera is None:
        camera = framing_camera(mesh, view)
    elif view != FRAMED:
        raise InputError("view: the camera says where the eye is; leave one of them out")
    display_list = display_list_of_mesh(
        mesh, picture, shading=shade, camera=camera, background=behind, lighting=lighting, cull=cull
    )
    return SceneDisplayList(display_list, chosen.name, _notes(mesh, display_list))


def _described(file: SceneFile, chosen: Scene, picture: PictureFormat, camera: Camera | None,
               **looking: Any) -> SceneDisplayList:
    """What a scene file says, looked at so."""
    if camera is not None:
        raise InputError(f"{chosen.name}: camera: the file says where the eye is; leave it out")
    display_list = file.display_list(picture, **looking)
    empty = () if display_list.triangles else ("nothing is in view: the picture is empty",)
    return SceneDisplayList(display_list, chosen.name, (*file.notes, *empty))


def mesh_of_scene(scene: Scene) -> Mesh | None:
    """The mesh of a file or a built-in scene; None for triangles that are made on the screen."""
    if isinstance(scene, MeshFileScene):
        return load_mesh(scene.path)
    if isinstance(scene, BuiltInScene) and scene.built_in.mesh is not None:
        return scene.built_in.mesh(**scene.arguments)
    return None


def _notes(mesh: Mesh, display_list: DisplayList) -> tuple[str, ...]:
    degenerate = int(mesh.degenerate().sum())
    faces = mesh.triangles
    if degenerate == faces:
        which = "the only face is" if faces == 1 else f"all {faces} faces are"
        return (*mesh.notes, f"{which} degenerate: the picture is empty")
    notes = list(mesh.notes)
    if degenerate:
        notes.append(f"{degenerate} of {faces} faces are degenerate and draw nothing")
    if display_list.triangles == 0:
        notes.append("no face is in view: the picture is empty")
    return tuple(notes)


def _refuse(chosen: Scene, reason: str, camera: Camera | None, view: View, lighting: Lighting,
            cull: bool) -> None:
    """``InputError`` for what only a mesh can be asked."""
    asked = {"camera": camera is not None, "view": view.direction is not None,
             "zoom": view.zoom != FRAMED.zoom, "light": lighting != DEFAULT_LIGHTING, "cull": cull}
    for name, given in asked.items():
        if given:
            raise InputError(f"{chosen.name}: {name}: {reason}; leave it out, or take a mesh")


def _random(
    chosen: BuiltInScene,
    picture: PictureFormat,
    background: Color,
    shading: Shading,
) -> SceneDisplayList:
    arguments = chosen.arguments
    display_list = random_display_list(
        picture,
        background,
        gouraud=shading == "gouraud",
        n=int(arguments["n"]),
        size=float(arguments["size"]),
        seed=int(arguments["seed"]),
    )
    return SceneDisplayList(display_list, chosen.name)


def _replay(
    chosen: DisplayListScene | HardCaseScene,
    given: dict[str, int | None],
    background: Color | None,
) -> SceneDisplayList:
    """A display list as it is; ``InputError`` for whatever it contradicts."""
    if isinstance(chosen, HardCaseScene):
        source, display_list = chosen.name, hard_case(chosen.case).make()
    else:
        source, display_list = str(chosen.path), DisplayList.load(chosen.path)
    for field, value in given.items():
        own = getattr(display_list, field)
        if value is not None and value != own:
            raise InputError(f"{source}: {field}: the display list was made for {own}, not "
                             f"{value}; leave it out, or make the list again from its scene")
    if background is not None and background != display_list.background:
        raise InputError(f"{source}: background: the display list has {display_list.background}, "
                         f"not {background}; leave it out, or make the list again")
    return SceneDisplayList(display_list, chosen.name)
