"""Display lists for the hard cases, given in pixels."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..scenes.built_in.random_numbers import RandomNumbers
from ..scenes.mesh_display_list import DEFAULT_BACKGROUND
from ..specification.display_list import DisplayList

Int64 = NDArray[np.int64]

#: Most cases have this width and height, so that one machine draws them all.
SIDE = 32
SUB_BITS = 8
DEPTH_BITS = 24

#: The greatest depth that a vertex may have.
FARTHEST = (1 << DEPTH_BITS) - 2


def screen_list(
    corners: Any,
    depth: Any = None,
    color: Any = None,
    *,
    width: int = SIDE,
    height: int = SIDE,
) -> DisplayList:
    """A display list from corners in pixels.

    ``corners``  (n, 3, 2), whole multiples of 1/256 pixel, else ``ValueError``
    ``depth``    (n, 3), or (n,) for triangles of one depth; None: random, so steep
    ``color``    (n, 3, 3), or (n, 3) for triangles of one colour; None: shaded from
                 a random one, a different one each
    """
    units = np.asarray(corners, np.float64).reshape(-1, 3, 2) * (1 << SUB_BITS)
    position = units.astype(np.int32)
    if not np.array_equal(position, units):
        raise ValueError("the corners are off the sub-pixel grid")
    count = len(position)
    if depth is None:
        depth = RandomNumbers(count).integers(FARTHEST + 1, count, 3)
    depth = np.asarray(depth, np.int64)
    color = shaded_colors(count) if color is None else np.asarray(color, np.uint8)
    return DisplayList(
        width=width,
        height=height,
        position=position,
        depth=_for_each_corner(depth, (count, 3)),
        color=_for_each_corner(color, (count, 3, 3)),
        sub_bits=SUB_BITS,
        depth_bits=DEPTH_BITS,
        background=DEFAULT_BACKGROUND,
    )


def _for_each_corner(values: NDArray[Any], shape: tuple[int, ...]) -> NDArray[Any]:
    """``values`` of ``shape``; where they lack the axis of the corners, the same at each."""
    if values.size and values.ndim < len(shape):
        values = np.repeat(values[:, None], 3, axis=1)
    return values.reshape(shape)


def shaded_colors(count: int) -> NDArray[np.uint8]:
    """uint8 (n, 3, 3): a random bright colour at the first corner, darker at the others."""
    bright = 96 + RandomNumbers(count + 1).integers(160, count, 1, 3)
    return np.asarray(bright * np.array([[4], [3], [2]]) // 4, np.uint8)


def rectangle(left: float, top: float, right: float, bottom: float) -> list[list[list[float]]]:
    """Two triangles, cut from the upper left corner to the lower right one."""
    a, b, c, d = [left, top], [right, top], [right, bottom], [left, bottom]
    return [[a, b, c], [a, c, d]]


def fan(hub: Sequence[float], ring: Any) -> NDArray[np.float64]:
    """(n, 3, 2): triangles from ``hub`` to each side of the closed ``ring`` (n, 2)."""
    ring = np.asarray(ring, np.float64)
    centre = np.broadcast_to(np.asarray(hub, np.float64), ring.shape)
    return np.stack([centre, ring, np.roll(ring, -1, axis=0)], axis=1)


def lattice(points: NDArray[np.floating[Any]]) -> NDArray[np.float64]:
    """(2 (r-1) (c-1), 3, k): the cells of a grid of points (r, c, k), each cut in two."""
    a, b = points[:-1, :-1], points[:-1, 1:]
    d, c = points[1:, :-1], points[1:, 1:]
    triangles = np.stack([np.stack([a, b, c], axis=2), np.stack([a, c, d], axis=2)], axis=2)
    return triangles.reshape(-1, 3, points.shape[2]).astype(np.float64)
