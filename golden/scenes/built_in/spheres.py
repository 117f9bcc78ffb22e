"""Uniformly random spheres of one size: the test scenes of Blazek (1991, chapter V).

The thesis says "uniformly random distributed spheres of identical size", 1 to
2048 of them, each tessellated by recursive subdivision of an octahedron; its
sample scene file gives a sphere scale 0.15 and a random colour.  It prints 5102
polygons for a sphere, which is no 8 · 4^depth; 512 (depth 3) is the nearest.
The region is not stated: the cube from -1 to 1 is used.
"""

from __future__ import annotations

import numpy as np

from ..mesh import Mesh
from .random_numbers import RandomNumbers
from .sphere import sphere_triangles, spheres_mesh


def spheres_triangles(count: int, depth: int, radius: float, seed: int) -> int:
    return count * sphere_triangles(depth)


def spheres(count: int, depth: int, radius: float, seed: int) -> Mesh:
    """``count`` spheres of ``radius``, centres uniform in the cube from -1 to 1."""
    numbers = RandomNumbers(seed)
    centers = 2.0 * numbers.uniform(count, 3) - 1.0
    # From 64 up, so that no sphere is lost in a dark background.
    colors = (64 + numbers.integers(192, count, 3)).astype(np.uint8)
    return spheres_mesh(centers, np.full(count, radius), depth, colors)
