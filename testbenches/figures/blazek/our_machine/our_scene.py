"""The spheres as objects of a machine: one mesh, moved by whole pixels, so that all are alike."""

from __future__ import annotations

from functools import cache

import numpy as np

from .....golden.scenes.built_in.random_numbers import RandomNumbers
from .....golden.scenes.built_in.sphere import sphere_triangles, unit_sphere
from .....golden.scenes.quantise import PictureFormat, round_half_up
from .....golden.scenes.scene_files.object_list import ObjectList, ObjectMesh
from ..scenes.spheres import Size, sphere_places, sphere_radius

#: How often the octahedron is cut: 8 · 4³ triangles a sphere.
CUTS = 3
TRIANGLES = sphere_triangles(CUTS)

#: Of all depths, a sphere's radius.
DEPTH = 0.05

#: Added to a seed for colours and depths, which places do not depend on.
OTHER_NUMBERS = 1000


def our_objects(size: Size, seed: int, spheres: int) -> ObjectList:
    """The spheres that his machine has of that seed; fewer are the first of many."""
    picture = PictureFormat(*size)
    numbers = RandomNumbers(seed + OTHER_NUMBERS).uniform(spheres, 4)
    room = picture.depth_limit * (1 - 2 * DEPTH)
    depth = np.floor(picture.depth_limit * DEPTH + room * numbers[:, 0]).astype(np.int64)
    place = sphere_places(size, seed, spheres) << picture.sub_bits
    color = 64 + np.floor(192 * numbers[:, 1:]).astype(np.int64)
    return ObjectList(picture, (0, 0, 0), (sphere_mesh(size),), np.zeros(spheres, np.int64),
                      np.concatenate([place, depth[:, np.newaxis]], axis=1),
                      color.astype(np.uint8))


@cache
def sphere_mesh(size: Size) -> ObjectMesh:
    """Front and back, flat shaded by a light at the eye."""
    picture = PictureFormat(*size)
    vertices, faces = unit_sphere(CUTS)
    along = sphere_radius(size) * (1 << picture.sub_bits)
    steps = round_half_up(vertices * [along, -along, -picture.depth_limit * DEPTH])[faces]
    middle = vertices[faces].mean(axis=1)
    light = np.abs(middle[:, 2]) / np.linalg.norm(middle, axis=1)
    shade = np.broadcast_to(round_half_up(55 + 200 * light)[:, np.newaxis, np.newaxis],
                            (len(faces), 3, 3)).astype(np.uint8)
    return ObjectMesh(steps[..., :2], steps[..., 2], shade)
