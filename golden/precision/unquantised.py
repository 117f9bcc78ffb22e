"""The picture of a scene before it is quantised: what a viewer would see of an ideal machine.

Vertices are as projection left them, in float64, and no number is rounded to a
grid.  Coverage and winners are those of rational arithmetic on these vertices:
float64 decides where its error bound leaves no doubt, ``fractions`` elsewhere.
"""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..reference.coverage import FRAGMENT_LIMIT
from ..scene_argument import parse_scene
from ..scene_display_list import mesh_of_scene
from ..scenes.camera import FRAMED, View, framing_camera
from ..scenes.clipping import clip
from ..scenes.lighting import DEFAULT_LIGHTING, Lighting, Shading
from ..scenes.mesh import Mesh
from ..scenes.mesh_display_list import corners_of_mesh, facing
from ..scenes.quantise import PictureFormat, quantise_colors, quantise_depths, quantise_positions
from ..specification.display_list import DisplayList
from ..specification.picture import NO_PRIMITIVE
from .edge_functions import Array, box_rows, edge_functions, owned_edges

Float64 = NDArray[np.float64]
Int64 = NDArray[np.int64]

#: The most an edge function is off, relative to the size of its terms (``edge_functions``).
_EDGE_ERROR = 3.4 * 2.0**-53
#: A depth or colour that float64 may have farther off than this share of its range is computed in
#: fractions.
_VALUE_ERROR = 2.0**-44


@dataclass(frozen=True, eq=False)
class ScreenTriangles:
    """Triangles in pixels of a picture of ``width`` by ``height``, float64, n of them.

    ``position`` (n, 3, 2): x right, y down, pixel (i, j) centred at (i + 1/2, j + 1/2);
    ``depth`` (n, 3) from 0 at the near plane to 1; ``color`` (n, 3, 3), 0 … 255.
    """

    position: Float64
    depth: Float64
    color: Float64
    width: int
    height: int
    background: tuple[int, int, int]


@dataclass(frozen=True, eq=False)
class UnquantisedScene:
    """Clipped triangles in homogeneous pixels, as display lists are made from.

    ``corners`` float64 (n, 3, 7): X, Y, Z, w, red, green, blue, as ``clipping`` has them, for
    a picture of ``width`` by ``height``.
    """

    corners: Float64
    width: int
    height: int
    background: tuple[int, int, int]

    @classmethod
    def of_mesh(cls, mesh: Mesh, display_list: DisplayList, shading: Shading, *,
                view: View = FRAMED, lighting: Lighting = DEFAULT_LIGHTING, cull: bool = False
                ) -> UnquantisedScene:
        """What ``display_list``, which was made from ``mesh`` seen so, was before it was quantised.
        """
        picture = PictureFormat(display_list.width, display_list.height, display_list.sub_bits,
                                display_list.depth_bits)
        corners = clip(corners_of_mesh(mesh, picture, shading=shading, lighting=lighting,
                                       camera=framing_camera(mesh, view)), picture).corners
        if cull:  # as the list does it: by the quantised vertices
            corners = corners[facing(quantise_positions(corners[..., :4], picture))]
        return cls(corners, picture.width, picture.height, display_list.background)

    @classmethod
    def of_display_list(cls, display_list: DisplayList) -> UnquantisedScene:
        """A display list whose vertices are taken as they are: all there is of its scene."""
        position = display_list.position / float(1 << display_list.sub_bits)
        depth = display_list.depth / float(display_list.depth_limit)
        corners = np.concatenate([position, depth[..., None], np.ones((*depth.shape, 1)),
                                  display_list.color.astype(np.float64)], axis=2)  # fmt: skip
        return cls(corners, display_list.width, display_list.height, display_list.background)

    def display_list(self, sub_bits: int, depth_bits: int) -> DisplayList:
        """The triangles quantised: the same numbers of primitives whatever the formats."""
        picture = PictureFormat(self.width, self.height, sub_bits, depth_bits)
        homogeneous = self.corners[..., :4]
        return DisplayList(
            width=self.width,
            height=self.height,
            position=quantise_positions(homogeneous, picture),
            depth=quantise_depths(homogeneous, picture),
            color=quantise_colors(self.corners[..., 4:]),
            sub_bits=sub_bits,
            depth_bits=depth_bits,
            background=self.background,
        )

    def on_screen(self, x_shift: int = 0, y_shift: int = 0) -> ScreenTriangles:
        """Projected, in pixels of the resolution that ``Grid.of`` gives for these shifts."""
        pixel = np.array([1 << x_shift, 1 << y_shift])  # powers of two: exact
        w = self.corners[..., 3:4]
        return ScreenTriangles(
            position=self.corners[..., :2] / w / pixel,
            depth=np.clip(self.corners[..., 2] / w[..., 0], 0.0, 1.0),
            color=np.clip(self.corners[..., 4:], 0.0, 255.0),
            width=-(-self.width >> x_shift),
            height=-(-self.height >> y_shift),
            background=self.background,
        )


def unquantised_scene(scene: str | Path, display_list: DisplayList,
                      shading: Shading = "gouraud", **looking: Any) -> UnquantisedScene:
    """What ``display_list``, which ``make_display_list`` made of ``scene``, was made from.

    ``looking``: the same ``view``, ``lighting`` and ``cull``.  A saved list, a hard case or random
    triangles exist as integers only, and are taken as they are.
    """
    mesh = mesh_of_scene(parse_scene(scene))
    if mesh is None:
        return UnquantisedScene.of_display_list(display_list)
    return UnquantisedScene.of_mesh(mesh, display_list, shading, **looking)


@dataclass(frozen=True, eq=False)
class UnquantisedPicture:
    """``depth`` float64 (h, w), 0 … 1 where drawn; ``color`` float64 (h, w, 3);
    ``winner`` int32 (h, w), ``NO_PRIMITIVE`` where nothing was drawn."""

    depth: Float64
    color: Float64
    winner: NDArray[np.int32]


def draw(triangles: ScreenTriangles) -> UnquantisedPicture:
    """The picture: top-left rule, the winner the least (depth, primitive).

    Coverage and winners are exact for the float64 vertices; depths and colours
    are off by less than 2**-43 of their range.
    """
    width, height = triangles.width, triangles.height
    geometry = _Geometry(triangles.position)
    least = np.full(height * width, np.inf)  # surely no farther than this
    kept = [_Fragments(np.zeros(0, np.int64), np.zeros(0, np.int64), np.zeros(0), np.zeros(0))]
    for runs in box_rows(triangles.position, width, height).chunks(FRAGMENT_LIMIT):
        span, column = runs.expand()
        triangle = runs.triangle.take(span)
        x, y = runs.first.take(span) + column, runs.row.take(span)
        covered = geometry.covered(triangle, x, y)
        triangle, x, y = triangle[covered], x[covered], y[covered]
        depth, error = geometry.interpolate(triangles.depth, triangle, x, y)
        pixel = y * width + x
        np.minimum.at(least, pixel, depth + error)
        kept.append(_Fragments(pixel, triangle, depth, error).nearest(least))
    fragments = _Fragments.joined(kept).nearest(least)
    fragments = fragments.only(_winners(geometry, triangles, fragments))

    picture = UnquantisedPicture(
        depth=np.ones((height, width)),
        color=np.full((height, width, 3), triangles.background, np.float64),
        winner=np.full((height, width), NO_PRIMITIVE, np.int32),
    )
    y, x = np.divmod(fragments.pixel, width)
    picture.depth[y, x] = fragments.depth
    picture.winner[y, x] = fragments.triangle
    for channel in range(3):
        picture.color[y, x, channel], _ = geometry.interpolate(
            triangles.color[:, :, channel], fragments.triangle, x, y)
    return picture


@dataclass(frozen=True, eq=False)
class _Fragments:
    """Covered pixels, (m,) each: pixel, triangle, depth, and how far off the depth may be."""

    pixel: Int64
    triangle: Int64
    depth: Float64
    error: Float64

    def only(self, which: NDArray[np.bool_] | Int64) -> _Fragments:
        return _Fragments(self.pixel[which], self.triangle[which], self.depth[which],
                          self.error[which])

    def nearest(self, least: Float64) -> _Fragments:
        """The fragments that may be the nearest of their pixel; ``least`` is an upper bound of its
        depth."""
        return self.only(self.depth - self.error <= least.take(self.pixel))

    @classmethod
    def joined(cls, parts: list[_Fragments]) -> _Fragments:
        return cls(
            np.concatenate([part.pixel for part in parts]),
            np.concatenate([part.triangle for part in parts]),
            np.concatenate([part.depth for part in parts]),
            np.concatenate([part.error for part in parts]),
        )


def _winners(geometry: _Geometry, triangles: ScreenTriangles, fragments: _Fragments) -> Int64:
    """The index of each pixel's winner among fragments any of which may be it."""
    contested = np.bincount(fragments.pixel)[fragments.pixel] > 1
    rivals = fragments.only(contested)
    exact: Array = rivals.depth.astype(object)
    inexact = np.flatnonzero(rivals.error > 0)
    y, x = np.divmod(rivals.pixel[inexact], triangles.width)
    exact[inexact] = geometry.exactly(triangles.depth, rivals.triangle[inexact], x, y)
    # By pixel, then depth, then drawing order: stable sorts, the last key first.
    order = np.argsort(rivals.triangle, kind="stable")
    order = order[np.argsort(exact[order], kind="stable")]
    order = order[np.argsort(rivals.pixel[order], kind="stable")]
    _, first = np.unique(rivals.pixel[order], return_index=True)
    return np.concatenate([np.flatnonzero(~contested), np.flatnonzero(contested)[order[first]]])


class _Geometry:
    """Triangles, in float64 and, where that is not enough, in fractions."""

    def __init__(self, position: Float64) -> None:
        self._position = position
        area, size = edge_functions(position, position[:, 0, 0], position[:, 0, 1])
        self._orientation = np.sign(area[:, 0])
        doubtful = np.flatnonzero(abs(area[:, 0]) <= _EDGE_ERROR * size[:, 0])
        corners = _fractions(position[doubtful])
        area, _ = edge_functions(corners, corners[:, 0, 0], corners[:, 0, 1])
        self._orientation[doubtful] = [(value > 0) - (value < 0) for value in area[:, 0]]

    def covered(self, triangle: Int64, x: Int64, y: Int64) -> NDArray[np.bool_]:
        """bool (m,): pixels (x, y) inside, or on a top or left edge."""
        corners = self._position.take(triangle, axis=0)
        orientation = self._orientation.take(triangle)
        edges, size = edge_functions(corners, x + 0.5, y + 0.5)
        edges *= orientation[:, None]
        unsure = abs(edges) <= _EDGE_ERROR * size
        inside = ((edges > 0) | unsure).all(axis=1) & (orientation != 0)
        doubtful = np.flatnonzero(inside & unsure.any(axis=1))
        exact = _fractions(corners[doubtful])
        edges, _ = edge_functions(exact, _fractions(x[doubtful] + 0.5),
                                  _fractions(y[doubtful] + 0.5))
        edges = edges * orientation[doubtful].astype(np.int64)[:, None]
        owned = owned_edges(corners[doubtful], orientation[doubtful])
        inside[doubtful] = np.where(owned, edges >= 0, edges > 0).all(axis=1)
        return np.asarray(inside)

    def interpolate(self, values: Float64, triangle: Int64, x: Int64, y: Int64
                    ) -> tuple[Float64, Float64]:
        """The planes through ``values`` (n, 3) at covered pixels, and how far off they may be."""
        corner = values.take(triangle, axis=0)
        edges, size = edge_functions(self._position.take(triangle, axis=0), x + 0.5, y + 0.5)
        orientation = self._orientation.take(triangle)[:, None]
        edges = edges * orientation
        area = edges.sum(axis=1)
        slack = _EDGE_ERROR * size.sum(axis=1)
        spread = corner.max(axis=1) - corner.min(axis=1)
        good = area > 4 * slack
        area = np.where(good, area, 1.0)
        # From the first corner, so that a level plane is exact.
        rise = corner - corner[:, :1]
        result = corner[:, 0] + (edges * rise).sum(axis=1) / area
        # Weights off by slack / area of the spread, twice since the area is their sum; rounding.
        error = np.where(spread == 0, 0.0, spread * (2 * slack / area + 2.0**-50)
                         + abs(result) * 2.0**-52)  # fmt: skip
        bad = np.flatnonzero(~good | (error > _VALUE_ERROR * values.max(initial=0.0)))
        result[bad] = self.exactly(values, triangle[bad], x[bad], y[bad]).astype(np.float64)
        error[bad] = abs(result[bad]) * 2.0**-52
        return result, error

    def exactly(self, values: Float64, triangle: Int64, x: Int64, y: Int64) -> Array:
        """The planes in fractions, object (m,)."""
        corners = _fractions(self._position.take(triangle, axis=0))
        edges, _ = edge_functions(corners, _fractions(x + 0.5), _fractions(y + 0.5))
        corner = _fractions(values.take(triangle, axis=0))
        return np.asarray((edges * corner).sum(axis=1) / edges.sum(axis=1), object)


def _fractions(values: Array) -> Array:
    """Object array of the same shape: each number as the fraction that it is."""
    exact = np.empty(values.shape, object)
    exact.reshape(-1)[:] = [Fraction(value) for value in values.reshape(-1).tolist()]
    return exact
