"""Blazek's scenes: "uniformly random distributed spheres of identical size", 1 to 2,048 of them."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from .....golden.scenes.built_in.random_numbers import RandomNumbers

Int64 = NDArray[np.int64]
Size = tuple[int, int]

#: Nodes along the curves, and spheres of each curve.
NODES = (1, 2, 4, 8, 16, 32)
SPHERES = tuple(1 << power for power in range(12))

#: He does not print how large they are; his example of the language (figure 9) calls a sphere of
#: this scale small, where 1 is half of the screen.
SCALE = 0.15


def sphere_radius(size: Size, scale: float = SCALE) -> float:
    """In pixels."""
    return scale * min(size) / 2


def sphere_reach(radius: float) -> int:
    """Whole pixels from a centre, beyond which there is nothing of the sphere."""
    return math.ceil(radius)


def sphere_places(size: Size, seed: int, count: int, scale: float = SCALE) -> Int64:
    """int64 (count, 2): the centres, x and y, on corners of pixels, anywhere where the whole sphere
    is seen.  Fewer of a seed are the first of many."""
    reach = sphere_reach(sphere_radius(size, scale))
    room = np.array(size) - 2 * reach + 1
    places = reach + np.floor(RandomNumbers(seed).uniform(count, 2) * room)
    return np.asarray(places, np.int64)
