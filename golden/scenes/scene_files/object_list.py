"""Meshes of integers, and objects that are one of them, moved: what an orthographic scene is."""

from __future__ import annotations

from dataclasses import dataclass, fields, replace
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from ...specification.display_list import DisplayList
from ...specification.errors import InputError
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

    @property
    def box(self) -> tuple[int, int, int, int]:
        """Left, top, right and bottom about its own origin, both ends included; of a mesh without
        triangles its origin."""
        corners = self.position.reshape(-1, 2)
        if not len(corners):
            return 0, 0, 0, 0
        (left, top), (right, bottom) = corners.min(axis=0).tolist(), corners.max(axis=0).tolist()
        return left, top, right, bottom

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
        """bool (n,): some vertex lies outside the guard band; of a mesh without triangles, its
        origin.  Of others that may lie anywhere: an offset is added modulo the fields of a vertex,
        and sums that fit there are exact."""
        low, high = self.boxes
        band = self.picture.guard_band << self.picture.sub_bits
        return np.asarray(((low < -band) | (high >= band)).any(axis=1))

    @property
    def boxes(self) -> tuple[Int64, Int64]:
        """int64 (n, 2) each: left and top, right and bottom of every object where it is, both ends
        included."""
        boxes = np.array([mesh.box for mesh in self.meshes], np.int64).reshape(-1, 4)[self.mesh]
        place = self.offset[:, :2]
        return boxes[:, :2] + place, boxes[:, 2:] + place

    def in_sub_bits(self, sub_bits: int) -> ObjectList:
        """The same objects in units of ``2**-sub_bits`` pixel.  ``InputError`` where a vertex of a
        mesh or an offset would move."""
        more = sub_bits - self.picture.sub_bits
        if more == 0:
            return self
        if sub_bits < (needed := self.fewest_sub_bits):
            raise InputError(f"objects: sub_bits {needed}, the machine is built for {sub_bits}: "
                             "export a machine for this scene")

        def moved(steps: Int64) -> Int64:
            return steps << more if more > 0 else steps >> -more

        offset = self.offset.copy()
        offset[:, :2] = moved(offset[:, :2])
        return replace(self, picture=replace(self.picture, sub_bits=sub_bits), offset=offset,
                       meshes=tuple(replace(mesh, position=moved(mesh.position))
                                    for mesh in self.meshes))

    @property
    def fewest_sub_bits(self) -> int:
        """Sub-pixel bits that are left, at least one, when the coordinates of meshes and offsets
        are all halved while even."""
        steps = [self.offset[:, :2], *(mesh.position for mesh in self.meshes)]
        together = int(np.bitwise_or.reduce([np.bitwise_or.reduce(each, axis=None, initial=0)
                                             for each in steps]))
        zeros = ((together & -together).bit_length() - 1 if together
                 else self.picture.sub_bits)
        return self.picture.sub_bits - min(zeros, self.picture.sub_bits - 1)

    def display_list(self) -> ObjectDisplayList:
        """All triangles, one after another."""
        none = (np.zeros((0, 3, 2), np.int64), np.zeros((0, 3), np.int64),
                np.zeros((0, 3, 3), np.int64))
        each = [self._triangles(number, clipped)
                for number, clipped in enumerate(self.clipped.tolist())]
        position, depth, color = map(np.concatenate, zip(none, *each, strict=True))
        return ObjectDisplayList(
            self.picture.width, self.picture.height, position.astype(np.int32), depth,
            color.astype(np.uint8), self.picture.sub_bits, self.picture.depth_bits,
            self.background, self, np.array([len(depth) for _, depth, _ in each], np.int64))

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


@dataclass(frozen=True, eq=False)
class ObjectDisplayList(DisplayList):
    """The display list of objects, which it still knows.

    ``objects``  in the formats in which they were quantised, whatever the list's are now
    ``counts``   int64 (n,): triangles of each object
    """

    objects: ObjectList = None  # type: ignore[assignment]
    counts: Int64 = None  # type: ignore[assignment]

    @property
    def object_triangles(self) -> Int64:
        return self.counts

    @cached_property
    def object_of(self) -> Int64:
        """int64 (triangles,): the object of each."""
        return np.repeat(np.arange(len(self.counts)), self.counts)

    def chosen(self, triangles: Int64) -> DisplayList:
        return self._plain.chosen(triangles)

    def followed_by(self, *others: DisplayList) -> DisplayList:
        return self._plain.followed_by(*others)

    @property
    def _plain(self) -> DisplayList:
        """The same triangles, of nothing."""
        return DisplayList(**{field.name: getattr(self, field.name)
                              for field in fields(DisplayList)})
