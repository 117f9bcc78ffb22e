"""Scenes that have to be clipped: near plane, eye, guard band."""

from __future__ import annotations

from functools import partial
from typing import Final

import numpy as np
from numpy.typing import NDArray

from ..scenes.camera import Camera
from ..scenes.mesh import Mesh
from ..scenes.mesh_display_list import display_list_of_corners, display_list_of_mesh
from ..scenes.quantise import PictureFormat
from ..specification.display_list import DisplayList
from .expectations import Image, covered_once, depths
from .hard_case import HardCase
from .screen_lists import FARTHEST, SIDE, fan, shaded_colors

PICTURE: Final = PictureFormat(SIDE, SIDE)
FAR: Final = 16.0


def _ground(corners: list[tuple[float, float]], faces: list[list[int]], near: float) -> DisplayList:
    """Faces on the ground z = -1, seen from the origin along y with a field of 90 degrees.

    The point (x, y, -1) is seen at the pixel position (16 + 16 x/y, 16 + 16/y), so the ground at
    ``FAR`` in row 17, at distance 1 on the lower rim.
    """
    vertices = np.array([[x, y, -1.0] for x, y in corners])
    indices = np.array(faces, np.int64)
    mesh = Mesh(vertices, indices, shaded_colors(len(indices)), smooth=False)
    camera = Camera(eye=(0.0, 0.0, 0.0), target=(0.0, 1.0, 0.0), field_of_view=90.0, near=near,
                    far=FAR)
    return display_list_of_mesh(mesh, PICTURE, camera=camera)


def _road(x: Image, y: Image) -> NDArray[np.bool_]:
    """11/4 to either side: 44/distance = 11/4 (Y - 16) pixels."""
    return np.asarray((y >= 17) & (4 * abs(2 * x + 1 - 32) < 11 * (2 * y + 1 - 32)))


def _ground_depth(x: Image, y: Image) -> Image:
    """Near plane at 1: z/w = 16/15 (1 - 1/distance), and 1/distance = (y + 1/2 - 16) / 16."""
    return FARTHEST * (63 - 2 * y) // 30


def _trapezium(x: Image, y: Image) -> NDArray[np.bool_]:
    """The sides leave (16 ± 8, 17) by 4 pixels a row, since 64/distance = 4 (Y - 16)."""
    return np.asarray((y >= 17) & (abs(2 * x + 1 - 32) < 8 * y - 116))


def _spiked_fan() -> DisplayList:
    """A fan whose upper and lower triangle stay within the guard band while each of their
    neighbours reaches far beyond it; the vertices have w from 0.4 to 2.5."""
    ring = [(-3.1, -2.7), (35.2, -4.4), (391.7, 17.3), (36.3, 35.1), (-5.5, 34.9), (-287.9, 14.1)]
    w = np.array([0.4, 1.7, 0.9, 2.5, 0.6, 1.3])
    hub_w = 1.1
    pixels = fan((15.3, 16.7), ring)
    weight = np.stack([np.full(6, hub_w), w, np.roll(w, -1)], axis=1)
    z = np.broadcast_to(np.array([0.2, 0.5, 0.8]), weight.shape)
    corners = np.concatenate([
        pixels * weight[..., None], (z * weight)[..., None], weight[..., None],
        shaded_colors(6).astype(np.float64),
    ], axis=2)
    return display_list_of_corners(corners, PICTURE)


CASES: Final = (
    HardCase(
        "near-plane-crossing",
        "divides before it clips, so a road that reaches under the eye folds over",
        partial(_ground, [(-2.75, 0.25), (2.75, 0.25), (2.75, 16), (-2.75, 16)],
                [[0, 1, 2], [0, 2, 3]], near=1.0),
        (covered_once(_road, "a road that narrows towards row 17, each pixel once"),
         depths(_ground_depth, "linear in the row, to 2 LSB for the rounded vertices", within=2)),
    ),
    HardCase(
        "behind-the-eye",
        "projects a vertex behind the eye upside down, into the sky",
        partial(_ground, [(-8, 16), (8, 16), (0, -16)], [[0, 2, 1]], near=1.0),
        (covered_once(_trapezium, "a trapezium below row 17, its sides 4 pixels a row"),),
    ),
    HardCase(
        "w-near-zero",
        "divides by a w of a millionth, and converts a coordinate of 16 million pixels to an "
        "integer that cannot hold it",
        partial(_ground, [(-8, 16), (8, 16), (0, 2.0**-20)], [[0, 2, 1]], near=2.0**-30),
        (covered_once(lambda x, y: (y >= 17) & (x >= 8) & (x < 24),
                      "a strip from row 17 down: its sides meet at infinity"),
         depths(lambda x, y: FARTHEST, "all of it far beyond the near plane", within=1)),
    ),
    HardCase(
        "clipped-beside-unclipped",
        "computes the vertices of a clipped triangle anew, a bit off the ones its unclipped "
        "neighbour keeps, and tears the edge between them",
        _spiked_fan,
        (covered_once(lambda x, y: 1, "the whole screen once"),),
    ),
)
