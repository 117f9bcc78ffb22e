"""From a scene's name or file to its display list: the front end of every command."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Final

import numpy as np
from numpy.typing import NDArray

from .camera import Camera, framing_camera, transform
from .clipping import clip
from .display_list import DisplayList
from .errors import InputError
from .lighting import DEFAULT_LIGHTING, Lighting, Shading, check_shading, lit_corners
from .mesh import Mesh
from .mesh_files import load_mesh
from .quantise import PictureFormat, quantise_colors, quantise_depths, quantise_positions
from .scenes.random_triangles import random_display_list
from .scenes.registry import BuiltInScene, DisplayListScene, MeshFileScene, parse_scene

Color = tuple[int, int, int]

DEFAULT_SIZE: Final = 64
DEFAULT_BACKGROUND: Final[Color] = (28, 32, 48)


@dataclass(frozen=True)
class SceneDisplayList:
    """A display list, the ``name`` of its scene, and ``notes``: warnings of one line each."""

    display_list: DisplayList
    name: str
    notes: tuple[str, ...] = ()


def make_display_list(
    scene: str | Path,
    *,
    width: int | None = None,
    height: int | None = None,
    sub_bits: int | None = None,
    depth_bits: int | None = None,
    shading: str = "gouraud",
    camera: Camera | None = None,
    background: Color | None = None,
    lighting: Lighting = DEFAULT_LIGHTING,
    cull: bool = False,
) -> SceneDisplayList:
    """The display list of a built-in scene, a mesh file or a saved display list.

    ``width``, ``height``     pixels; None: 64, or the saved list's
    ``sub_bits``              None: 8, or the saved list's
    ``depth_bits``            None: 24, or the saved list's
    ``shading``               ``gouraud`` or ``flat``
    ``camera``                None: frames the scene
    ``background``            red, green, blue; None: dark blue, or the saved list's
    ``cull``                  leave out the triangles that face away from the eye

    A saved list is replayed as it is: ``shading``, ``lighting`` and ``cull`` do
    not touch it.  Raises ``InputError`` for a scene, file or number that cannot
    be used, and for a size or camera that a saved list contradicts.
    """
    chosen = parse_scene(scene)
    if isinstance(chosen, DisplayListScene):
        given = {"width": width, "height": height, "sub_bits": sub_bits, "depth_bits": depth_bits}
        return _replay(chosen, given, camera, background)
    picture = PictureFormat(
        DEFAULT_SIZE if width is None else width,
        DEFAULT_SIZE if height is None else height,
        PictureFormat.sub_bits if sub_bits is None else sub_bits,
        PictureFormat.depth_bits if depth_bits is None else depth_bits,
    )
    shade = check_shading(shading)
    behind = DEFAULT_BACKGROUND if background is None else background
    if isinstance(chosen, MeshFileScene):
        mesh = load_mesh(chosen.path)
    elif chosen.built_in.mesh is not None:
        mesh = chosen.built_in.mesh(**chosen.arguments)
    else:
        return _random(chosen, picture, behind, shade, camera)
    listed = display_list_of_mesh(
        mesh, picture, shading=shade, camera=camera, background=behind, lighting=lighting, cull=cull
    )
    return SceneDisplayList(listed, chosen.name, _notes(mesh, listed))


def display_list_of_mesh(
    mesh: Mesh,
    picture: PictureFormat,
    *,
    shading: Shading = "gouraud",
    camera: Camera | None = None,
    background: Color = DEFAULT_BACKGROUND,
    lighting: Lighting = DEFAULT_LIGHTING,
    cull: bool = False,
) -> DisplayList:
    """Transform, light, clip, project and quantise a mesh, in the order of its faces.

    Left out is what has no area (rounded to the grid it could gain some) and
    what lies wholly outside the screen or before the near plane; what remains
    of a clipped face takes its place.
    """
    view = framing_camera(mesh) if camera is None else camera
    colors = lit_corners(mesh, view, shading, lighting)
    homogeneous = transform(view.matrix(picture, mesh.vertices[np.unique(mesh.faces)]),
                            mesh.vertices)
    corners = np.concatenate([homogeneous[mesh.faces], colors], axis=2)
    clipped = clip(corners[~mesh.degenerate()], picture).corners
    position = quantise_positions(clipped[..., :4], picture)
    depth = quantise_depths(clipped[..., :4], picture)
    color = quantise_colors(clipped[..., 4:])
    if cull:
        keep = _facing(position)
        position, depth, color = position[keep], depth[keep], color[keep]
    return DisplayList(
        width=picture.width,
        height=picture.height,
        position=position,
        depth=depth,
        color=color,
        sub_bits=picture.sub_bits,
        depth_bits=picture.depth_bits,
        background=background,
    )


def _facing(position: NDArray[np.int32]) -> NDArray[np.bool_]:
    """True where corners run counter-clockwise as seen in the picture, whose y points down."""
    a, b, c = (position[:, i].astype(np.int64) for i in range(3))
    return np.asarray(
        (b[:, 0] - a[:, 0]) * (c[:, 1] - a[:, 1]) < (c[:, 0] - a[:, 0]) * (b[:, 1] - a[:, 1])
    )


def _notes(mesh: Mesh, listed: DisplayList) -> tuple[str, ...]:
    degenerate = int(mesh.degenerate().sum())
    faces = mesh.triangles
    if degenerate == faces:
        which = "the only face is" if faces == 1 else f"all {faces} faces are"
        return (f"{which} degenerate: the picture is empty",)
    notes = []
    if degenerate:
        notes.append(f"{degenerate} of {faces} faces are degenerate and draw nothing")
    if listed.triangles == 0:
        notes.append("no face is in view: the picture is empty")
    return tuple(notes)


def _random(
    chosen: BuiltInScene,
    picture: PictureFormat,
    background: Color,
    shading: Shading,
    camera: Camera | None,
) -> SceneDisplayList:
    if camera is not None:
        raise InputError(f"{chosen.name}: camera: the triangles are made on the screen; "
                         "leave the camera out")
    arguments = chosen.arguments
    listed = random_display_list(
        picture,
        background,
        gouraud=shading == "gouraud",
        n=int(arguments["n"]),
        size=float(arguments["size"]),
        seed=int(arguments["seed"]),
    )
    return SceneDisplayList(listed, chosen.name)


def _replay(
    chosen: DisplayListScene,
    given: dict[str, int | None],
    camera: Camera | None,
    background: Color | None,
) -> SceneDisplayList:
    listed = DisplayList.load(chosen.path)
    for field, value in given.items():
        saved = getattr(listed, field)
        if value is not None and value != saved:
            raise InputError(f"{chosen.path}: {field}: the display list was made for {saved}, not "
                             f"{value}; leave it out, or make the list again from its scene")
    if camera is not None:
        raise InputError(f"{chosen.path}: camera: a display list is already projected; leave the "
                         "camera out, or make the list again from its scene")
    if background is not None and background != listed.background:
        raise InputError(f"{chosen.path}: background: the display list has {listed.background}, "
                         f"not {background}; leave it out, or make the list again")
    return SceneDisplayList(listed, chosen.name)
