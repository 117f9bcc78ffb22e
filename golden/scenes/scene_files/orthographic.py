"""An orthographic scene as objects of integers (``ObjectList``), which is what it is."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ..built_in.random_numbers import RandomNumbers
from ..camera import View, seen_from
from ..lighting import Lighting, Shading
from ..mesh import UP_Y, Mesh, corner_normals, dot, face_normals, normalised
from ..quantise import PictureFormat, round_half_up
from .description import Color, SceneDescription
from .object_list import ObjectList, ObjectMesh
from .placed_objects import DARKEST, PlacedObjects, rotated, turned

Float64 = NDArray[np.float64]
Int64 = NDArray[np.int64]

#: Of the random numbers that say where stars are.
STAR_SEED = 0


def object_list(description: SceneDescription, placed: PlacedObjects, picture: PictureFormat, *,
                view: View, lighting: Lighting, shading: Shading, background: Color,
                cull: bool = False) -> ObjectList:
    """Quantise every mesh about its own origin, and every place by itself; stars come first, the
    overlay last.

    ``view`` turns the whole scene, and its zoom makes it larger.
    """
    axes = _axes(view)
    pixels = min(picture.width, picture.height) / 2.0 * view.zoom
    seen = [turned(mesh, axes) for mesh in placed.meshes]
    places = rotated(placed.position, axes)
    depths = _depths_a_unit(seen, placed.mesh, places, picture)
    meshes = [_quantised(mesh, pixels, depths, picture, lighting, shading) for mesh in seen]
    if cull:
        meshes = [mesh.facing() for mesh in meshes]
    middle = [picture.width << picture.sub_bits - 1, picture.height << picture.sub_bits - 1,
              picture.depth_limit // 2]
    offset = _steps(places, pixels, depths, picture) + middle
    # Of a mesh that faces away altogether there is nothing to place.
    drawn = np.array([mesh.triangles > 0 for mesh in meshes], bool)[placed.mesh]
    objects = ObjectList(picture, background, tuple(meshes), placed.mesh[drawn], offset[drawn],
                         placed.color[drawn])
    return _with_overlay(_with_stars(objects, description.percent), description.overlay)


def _axes(view: View) -> Float64:
    """Unit vectors right, up, and towards the eye."""
    if view.direction is None:
        return np.eye(3)
    towards, up = seen_from(UP_Y, *view.direction)
    return np.stack([np.cross(up, towards), up, towards])


def _depths_a_unit(meshes: list[Mesh], number: Int64, places: Float64,
                   picture: PictureFormat) -> float:
    """Depths from z to z + 1, such that all objects lie between the first and the last.

    A vertex and a place are each rounded by half a step at most, so two of a half of all depths are
    kept free.
    """
    reach = np.array([np.abs(mesh.vertices[:, 2]).max() for mesh in meshes])
    furthest = float((reach[number] + np.abs(places[:, 2])).max())
    return max(0.0, picture.depth_limit / 2.0 - 2.0) / (furthest or 1.0)


def _steps(points: Float64, pixels: float, depths: float, picture: PictureFormat) -> Int64:
    """Points (…, 3) in steps of the grid: x to the right, y down, depth away from the eye."""
    along = pixels * (1 << picture.sub_bits)
    return round_half_up(points * [along, -along, -depths])


def _quantised(mesh: Mesh, pixels: float, depths: float, picture: PictureFormat,
               lighting: Lighting, shading: Shading) -> ObjectMesh:
    steps = _steps(mesh.vertices, pixels, depths, picture)[mesh.faces]
    return ObjectMesh(steps[..., :2], steps[..., 2], _shade(mesh, lighting, shading))


def _shade(mesh: Mesh, lighting: Lighting, shading: Shading) -> NDArray[np.uint8]:
    """Ambient light and Lambert's law on the side that is seen, times the mesh's own colours."""
    facets = face_normals(mesh)
    normals = (corner_normals(mesh) if shading == "gouraud"
               else np.repeat(facets[:, np.newaxis], 3, axis=1))
    normals = np.where((facets[:, 2] < 0.0)[:, np.newaxis, np.newaxis], -normals, normals)
    light = np.broadcast_to(normalised(np.array([lighting.direction]))[0], normals.shape)
    intensity = (lighting.ambient
                 + (1.0 - lighting.ambient) * np.maximum(dot(normals, light), 0.0))[..., np.newaxis]
    own = np.full((1, 1, 3), 255.0) if mesh.colors is None else mesh.colors.astype(np.float64)
    if shading == "flat":
        own = own.mean(axis=1, keepdims=True)
    return np.broadcast_to(round_half_up(own * intensity),
                           (mesh.triangles, 3, 3)).astype(np.uint8)


def _with_stars(objects: ObjectList, percent: float) -> ObjectList:
    """A star on so many of the pixels, behind everything: a triangle that holds one pixel's
    centre."""
    picture = objects.picture
    width, height = picture.width, picture.height
    count = round(percent / 100.0 * width * height)
    if not count:
        return objects
    numbers = RandomNumbers(STAR_SEED)
    pixel = np.argsort(numbers.uniform(width * height), kind="stable")[:count]
    color = DARKEST + numbers.integers(256 - DARKEST, count, 3)
    side = 3 << picture.sub_bits - 1
    star = ObjectMesh(np.array([[[0, 0], [side, 0], [0, side]]]), np.zeros((1, 3), np.int64),
                      np.full((1, 3, 3), 255, np.uint8))
    offset = np.stack([pixel % width << picture.sub_bits, pixel // width << picture.sub_bits,
                       np.full(count, picture.depth_limit)], axis=1)
    return ObjectList(
        picture, objects.background, (star, *objects.meshes),
        np.concatenate([np.zeros(count, np.int64), objects.mesh + 1]),
        np.concatenate([offset, objects.offset]),
        np.concatenate([color.astype(np.uint8), objects.color]))


def _with_overlay(objects: ObjectList, color: Color | None) -> ObjectList:
    """A frame one pixel wide, before everything."""
    if color is None:
        return objects
    picture = objects.picture
    width, height = picture.width, picture.height
    sides = [(0, 0, width, 1), (0, height - 1, width, height), (0, 0, 1, height),
             (width - 1, 0, width, height)]
    position = np.array([corners for left, top, right, bottom in sides for corners in (
        [(left, top), (right, top), (right, bottom)], [(left, top), (right, bottom),
                                                       (left, bottom)])]) << picture.sub_bits
    frame = ObjectMesh(position, np.zeros((8, 3), np.int64), np.full((8, 3, 3), 255, np.uint8))
    return ObjectList(
        picture, objects.background, (*objects.meshes, frame),
        np.append(objects.mesh, len(objects.meshes)), np.vstack([objects.offset, [[0, 0, 0]]]),
        np.vstack([objects.color, np.array([color], np.uint8)]))
