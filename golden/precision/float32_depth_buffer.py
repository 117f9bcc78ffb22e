"""A Z-buffer of the ordinary kind: everything in float32, as a plain software renderer has it.

No machine here works like this; it is measured beside them, so that one sees
what the usual arithmetic does to the same scene.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ..reference.coverage import FRAGMENT_LIMIT
from ..scenes.quantise import PictureFormat, quantise_colors, round_half_up
from ..specification.picture import NO_PRIMITIVE, Picture
from .edge_functions import box_rows, edge_functions, owned_edges
from .unquantised import ScreenTriangles

#: A fragment's key is the bits of its float32 depth, which from 0 on are in
#: numerical order, above its triangle's number.
_TRIANGLE_BITS = 31
_NOTHING = np.iinfo(np.int64).max

Float32 = NDArray[np.float32]
Int64 = NDArray[np.int64]


def draw(triangles: ScreenTriangles, depth_bits: int) -> Picture:
    """The picture of the triangles, their vertices rounded to float32.

    Edge functions of the vertices at each pixel centre, the top-left rule on
    exact zeros, weights by one reciprocal of the area, depth and colour as sums
    over the corners: all rounded to float32 at every step.  The least depth
    keeps the pixel, the earlier triangle on a tie, compared in float32; what is
    stored is rounded to ``depth_bits`` as vertices of a display list are.
    """
    width, height = triangles.width, triangles.height
    limit = PictureFormat(width, height, depth_bits=depth_bits).depth_limit
    position = triangles.position.astype(np.float32)
    depth, color = triangles.depth.astype(np.float32), triangles.color.astype(np.float32)
    least = np.full(height * width, _NOTHING)
    for runs in box_rows(position, width, height).chunks(FRAGMENT_LIMIT):
        span, column = runs.expand()
        triangle = runs.triangle.take(span)
        x, y = runs.first.take(span) + column, runs.row.take(span)
        weights, inside = _weights(position.take(triangle, axis=0), x, y)
        weights, triangle = weights[inside], triangle[inside]
        value = _sum(weights, depth.take(triangle, axis=0)).clip(0, 1)
        # Adding zero makes a negative zero, whose bits would be the greatest, positive.
        bits = (value + np.float32(0)).view(np.int32).astype(np.int64)
        np.minimum.at(least, (y * width + x)[inside], (bits << _TRIANGLE_BITS) | triangle)

    pixel = np.flatnonzero(least != _NOTHING)
    key = least.take(pixel)
    winner = key & ((1 << _TRIANGLE_BITS) - 1)
    nearest = (key >> _TRIANGLE_BITS).astype(np.int32).view(np.float32)
    y, x = np.divmod(pixel, width)
    weights, _ = _weights(position.take(winner, axis=0), x, y)
    channels = np.stack([_sum(weights, color[:, :, channel].take(winner, axis=0))
                         for channel in range(3)], axis=1)  # fmt: skip
    picture = Picture(
        color=np.full((height, width, 3), triangles.background, np.uint8),
        depth=np.full((height, width), limit + 1, np.int64),
        winner=np.full((height, width), NO_PRIMITIVE, np.int32),
    )
    picture.color[y, x] = quantise_colors(channels.astype(np.float64))
    picture.depth[y, x] = round_half_up(nearest.astype(np.float64) * limit)
    picture.winner[y, x] = winner
    return picture


def _weights(corners: Float32, x: Int64, y: Int64) -> tuple[Float32, NDArray[np.bool_]]:
    """float32 (m, 3) barycentric weights at pixels (x, y), and bool (m,): which are covered."""
    half = np.float32(0.5)
    edges, _ = edge_functions(corners, x.astype(np.float32) + half, y.astype(np.float32) + half)
    area = edge_functions(corners, corners[:, 0, 0], corners[:, 0, 1])[0][:, 0]
    toward = edges * np.sign(area)[:, None]
    inside = np.where(owned_edges(corners, area), toward >= 0, toward > 0).all(axis=1)
    with np.errstate(divide="ignore", over="ignore"):
        reciprocal = np.float32(1) / area
    drawn = np.isfinite(reciprocal)  # else without area, or with next to none
    weights = edges * np.where(drawn, reciprocal, np.float32(0))[:, None]
    return weights, inside & drawn


def _sum(weights: Float32, values: Float32) -> Float32:
    return np.asarray(weights[:, 0] * values[:, 0] + weights[:, 1] * values[:, 1]
                      + weights[:, 2] * values[:, 2], np.float32)  # fmt: skip
