"""From a mesh, or triangles already projected, to a display list."""

from __future__ import annotations

from typing import Final

import numpy as np
from numpy.typing import NDArray

from ..specification.display_list import DisplayList
from .camera import Camera, framing_camera, transform
from .clipping import clip
from .lighting import DEFAULT_LIGHTING, Lighting, Shading, lit_corners
from .mesh import Mesh
from .quantise import PictureFormat, quantise_colors, quantise_depths, quantise_positions

Color = tuple[int, int, int]

DEFAULT_BACKGROUND: Final[Color] = (28, 32, 48)


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
    corners = corners_of_mesh(mesh, picture, shading=shading, camera=camera, lighting=lighting)
    return display_list_of_corners(corners, picture, background=background, cull=cull)


def corners_of_mesh(
    mesh: Mesh,
    picture: PictureFormat,
    *,
    shading: Shading = "gouraud",
    camera: Camera | None = None,
    lighting: Lighting = DEFAULT_LIGHTING,
) -> NDArray[np.float64]:
    """Transform and light the faces that have area, for ``display_list_of_corners``."""
    camera = framing_camera(mesh) if camera is None else camera
    colors = lit_corners(mesh, camera, shading, lighting)
    homogeneous = transform(camera.matrix(picture, mesh.vertices[np.unique(mesh.faces)]),
                            mesh.vertices)
    corners = np.concatenate([homogeneous[mesh.faces], colors], axis=2)
    return np.asarray(corners[~mesh.degenerate()], np.float64)


def display_list_of_corners(
    corners: NDArray[np.float64],
    picture: PictureFormat,
    *,
    background: Color = DEFAULT_BACKGROUND,
    cull: bool = False,
) -> DisplayList:
    """Clip and quantise triangles given in homogeneous pixels.

    ``corners`` float64 (n, 3, 7): X, Y, Z, w of each corner (the pixel is X/w, Y/w; Z/w
    runs from 0 at the near plane to 1 at the far one), then red, green and blue, 0 … 255.
    ``cull`` leaves out what faces away from the eye.
    """
    clipped = clip(corners, picture).corners
    position = quantise_positions(clipped[..., :4], picture)
    depth = quantise_depths(clipped[..., :4], picture)
    color = quantise_colors(clipped[..., 4:])
    if cull:
        keep = facing(position)
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


def facing(position: NDArray[np.int32]) -> NDArray[np.bool_]:
    """True where corners run counter-clockwise as seen in the picture, whose y points down."""
    a, b, c = (position[:, i].astype(np.int64) for i in range(3))
    return np.asarray(
        (b[:, 0] - a[:, 0]) * (c[:, 1] - a[:, 1]) < (c[:, 0] - a[:, 0]) * (b[:, 1] - a[:, 1])
    )
