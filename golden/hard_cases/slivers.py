"""Triangles thinner than a pixel, whose slopes leave every range."""

from __future__ import annotations

from functools import partial
from typing import Final

import numpy as np

from ..specification.display_list import DisplayList
from .expectations import ANY_WINDING, covered_once, depths, pixels, winners
from .hard_case import HardCase
from .screen_lists import FARTHEST, fan, screen_list

#: One unit of the sub-pixel grid.
UNIT: Final = 1 / 256


def _fan_of_720() -> DisplayList:
    """180 slivers to each side of the square from 2 to 31, hub on the centre of pixel (16, 16)."""
    along = np.round(np.arange(180) / 180 * 29 * 256) / 256
    low, high = np.full(180, 2.0), np.full(180, 31.0)
    sides = [(2 + along, low), (high, 2 + along), (31 - along, high), (low, 31 - along)]
    ring = np.concatenate([np.stack(side, axis=1) for side in sides])
    return screen_list(fan([16.5, 16.5], ring))


def _area_of_one_unit() -> DisplayList:
    """The doubled area is 1, so no grid point but the vertices is on the triangle."""
    c, d = 8.5, 20.5
    return screen_list([
        [[c, c], [c + UNIT, c], [c, c + UNIT]],  # a top left corner on a centre
        [[d, c], [d - UNIT, c], [d, c + UNIT]],  # a top right corner
        [[c, d], [c + UNIT, d], [c, d - UNIT]],  # a bottom left corner
        [[d, d], [d - UNIT, d], [d, d - UNIT]],  # a bottom right corner
        # 4000 units long and one high at most: an obtuse corner on a centre, opening downwards.
        [[16.5, 14.5], [16.5 + 2000 * UNIT, 14.5 - UNIT], [16.5 - 1999 * UNIT, 14.5 + UNIT]],
    ], depth=[[9, 0, FARTHEST], [8] * 3, [7] * 3, [6] * 3, [FARTHEST - 5, 0, FARTHEST]],
        color=[[[255, 0, 128], [0, 255, 0], [0, 0, 255]]] * 5)


def _half_way_sliver() -> DisplayList:
    """An edge through 30 centres and a third vertex one unit off it: doubled area 7680.

    Per pixel of the diagonal the depth grows by 1/5 exactly, but by some 10**9
    per pixel to the right, and falls by as much per pixel downwards.
    """
    near = 5_000_000
    # The third vertex is beside the edge's grid point 2 units on from the first vertex.
    third = [1 + 3 * UNIT, 1 + 2 * UNIT]
    return screen_list([[[1, 1], [31, 31], third]], depth=[[near, near + 6, near + 4_000_000]])


CASES: Final = (
    HardCase(
        "sliver-horizontal",
        "searches for a start pixel and steps from there, so a span inside a row but not at the "
        "vertices is lost",
        partial(screen_list, [[[1, 5.25], [29, 5.25], [15, 5.75]]]),
        (winners(lambda x, y: np.where((y == 5) & (x >= 8) & (x < 22), 0, -1),
                 "at half its height it reaches from 8 to 22"), ANY_WINDING),
    ),
    HardCase(
        "sliver-vertical",
        "steps an inverse slope that is rounded, and misses the column of centres on some rows",
        partial(screen_list, [[[5.25, 1], [5.25, 29], [5.75, 15]]]),
        (winners(lambda x, y: np.where((x == 5) & (y >= 8) & (y < 22), 0, -1),
                 "at half its width it reaches from 8 to 22"), ANY_WINDING),
    ),
    HardCase(
        "sliver-diagonal-down",
        "skips rows on which the span is narrower than a pixel",
        partial(screen_list, [[[2, 1.75], [28, 27.75], [15, 15.5]]]),
        (winners(lambda x, y: np.where((x == y) & (x >= 6) & (x < 24), 0, -1),
                 "the diagonal is inside from 6 1/3 to 23 2/3"), ANY_WINDING),
    ),
    HardCase(
        "sliver-diagonal-up",
        "skips rows on which the span is narrower than a pixel, in the other direction",
        partial(screen_list, [[[30, 1.75], [4, 27.75], [17, 15.5]]]),
        (winners(lambda x, y: np.where((x + y == 31) & (y >= 6) & (y < 24), 0, -1),
                 "the diagonal is inside from 6 1/3 to 23 2/3"), ANY_WINDING),
    ),
    HardCase(
        "sliver-fan",
        "rounds 720 slopes on their own: around the hub, a vertex on a pixel centre, gaps and "
        "double hits add up, and the steep planes overflow",
        _fan_of_720,
        (covered_once(lambda x, y: (x >= 2) & (x < 31) & (y >= 2) & (y < 31),
                      "each pixel of the square once"),),
    ),
    HardCase(
        "double-area-one",
        "loses the smallest area there is in a rounded reciprocal, and its slopes, greater than "
        "any register, with it",
        _area_of_one_unit,
        (pixels({(8, 8): (0, 9, (255, 0, 128)),
                 (16, 14): (4, FARTHEST - 5, (255, 0, 128))},
                "the vertex is covered where the way right and a little down leads inside; its "
                "values are the vertex's own"), ANY_WINDING),
    ),
    HardCase(
        "sliver-half-way-depths",
        "truncates slopes instead of rounding them, and drifts below a depth that is exactly "
        "half-way between two values",
        _half_way_sliver,
        (winners(lambda x, y: np.where((x == y) & (x >= 1) & (x < 31), 0, -1),
                 "all centres on its left edge"),
         # 5000000 + (2k - 1) / 10, and a half more before the floor.
         depths(lambda x, y: 5_000_000 + (2 * x + 4) // 10, "a fifth per pixel, rounded half up")),
    ),
)
