"""Balls on a sphere, as the proteins of a virus' shell: in place of the polio virus that Ellsworth
(1994) draws."""

from __future__ import annotations

import numpy as np

from ..mesh import Mesh
from .sphere import sphere_triangles, spheres_mesh

#: Of a ball, against the distance at which as many would touch, were they squares.
_OVERLAP = 0.7

#: By which a spiral of equal steps comes nowhere near itself: the golden angle.
_TURN = np.pi * (3 - np.sqrt(5))


def capsid_triangles(count: int, depth: int) -> int:
    return count * sphere_triangles(depth)


def capsid(count: int, depth: int) -> Mesh:
    """``count`` balls, evenly on a unit sphere along a spiral from its top to its bottom, so large
    that neighbours run into each other.  ``count=394,depth=4`` makes 806,912 triangles, the paper's
    virus has 806,640."""
    step = np.arange(count)
    height = 1 - (2 * step + 1) / count
    radius = np.sqrt(1 - height**2)
    centers = np.stack([radius * np.cos(_TURN * step), radius * np.sin(_TURN * step), height],
                       axis=1)
    size = _OVERLAP * np.sqrt(4 * np.pi / count)
    colors = 150 + 25 * np.stack([step % 3, (step + 1) % 4, (step + 2) % 5], axis=1)
    return spheres_mesh(centers, np.full(count, size), depth, colors.astype(np.uint8))
