"""Meshes of integers, and objects that are one of them, moved: what an orthographic scene is."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ...specification.display_list import DisplayList
from ...specification.fixed_point import modulated
from ..mesh_display_list import display_list_of_corners, facing
from ..quantise import PictureFormat
from .description import Color

Int64 = NDArray[np.int64]


@dataclass(frozen=True, eq=False)
class ObjectMesh:
    """A mesh about its own origin; y points down.

    ``position``  int64 (f, 3, 2): in units of ``2**-sub_bits`` pixel
    ``depth``     int64 (f, 3)
    ``shade``     uint8 (f, 3, 3): by which the object's red, green and blue are ``modulated``
    """

    position: Int64
    depth: Int64
    shade: NDArray[np.uint8]

    @property
    def triangles(self) -> int:
        return len(self.depth)

    def facing(self) -> ObjectMesh:
        """Only what faces the eye, which is so wherever the object is."""
        keep = facing(self.position.astype(np.int32))
        return ObjectMesh(self.position[keep], self.depth[keep], self.shade[keep])


@dataclass(frozen=True, eq=False)
class ObjectList:
    """Objects in drawing order.

    ``mesh``    int64 (n,): which of ``meshes``
    ``offset``  int64 (n, 3): x, y and depth, added to each of its vertices
    ``color``   uint8 (n, 3)

    The display list is, object by object, its mesh's triangles plus its offset.  Only objects that
    do not lie in the guard band, ``clipped``, are clipped to it, triangle by triangle.
    """

    picture: PictureFormat
    background: Color
    meshes: tuple[ObjectMesh, ...]
    mesh: Int64
    offset: Int64
    color: NDArray[np.uint8]

    @property
    def clipped(self) -> NDArray[np.bool_]:
        """bool (n,): some vertex lies outside the guard band."""
        if not len(self.mesh):
            return np.zeros(0, bool)
        corners = [mesh.position.reshape(-1, 2) for mesh in self.meshes]
        low = np.array([corner.min(axis=0, initial=0) for corner in corners])
        high = np.array([corner.max(axis=0, initial=0) for corner in corners])
        band = self.picture.guard_band << self.picture.sub_bits
        place = self.offset[:, :2]
        return np.asarray(((place + low[self.mesh] < -band)
                           | (place + high[self.mesh] >= band)).any(axis=1))

    def display_list(self) -> DisplayList:
        """All triangles, one after another."""
        none = (np.zeros((0, 3, 2), np.int64), np.zeros((0, 3), np.int64),
                np.zeros((0, 3, 3), np.int64))
        position, depth, color = map(np.concatenate, zip(none, *(
            self._triangles(number, clipped)
            for number, clipped in enumerate(self.clipped.tolist())), strict=True))
        return DisplayList(
            self.picture.width, self.picture.height, position.astype(np.int32), depth,
            color.astype(np.uint8), self.picture.sub_bits, self.picture.depth_bits,
            self.background)

    def _triangles(self, number: int, clipped: bool) -> tuple[Int64, Int64, Int64]:
        """Positions, depths and colours of an object."""
        mesh, offset = self.meshes[self.mesh[number]], self.offset[number]
        position, depth = mesh.position + offset[:2], mesh.depth + offset[2]
        color = modulated(self.color[number].astype(np.int64), mesh.shade.astype(np.int64))
        return self._clipped(position, depth, color) if clipped else (position, depth, color)

    def _clipped(self, position: Int64, depth: Int64,
                 color: Int64) -> tuple[Int64, Int64, Int64]:
        pixels = position / float(1 << self.picture.sub_bits)
        corners = np.concatenate([
            pixels, (depth / max(1, self.picture.depth_limit))[..., np.newaxis],
            np.ones((*depth.shape, 1)), color.astype(np.float64)], axis=2)
        drawn = display_list_of_corners(corners, self.picture)
        return drawn.position.astype(np.int64), drawn.depth, drawn.color.astype(np.int64)
