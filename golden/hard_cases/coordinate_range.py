"""Coordinates as large as they can be, and triangles as large as the screen."""

from __future__ import annotations

from functools import partial
from typing import Final

import numpy as np

from ..specification.display_list import DisplayList, coordinate_bits
from .expectations import ANY_WINDING, NOTHING_DRAWN, Image, covered_once, depths, winners
from .hard_case import HardCase
from .screen_lists import SIDE, SUB_BITS, screen_list

#: The first and the last coordinate, in pixels.
LOW: Final = -(1 << (coordinate_bits(SIDE, SIDE, SUB_BITS) - 1 - SUB_BITS))
HIGH: Final = -LOW - 1 / (1 << SUB_BITS)

#: Legs along the upper and the left side of the screen, just long enough to cover all of it.
LEG: Final = 63.5
FULL_SCREEN: Final = [[0, 0], [LEG, 0], [0, LEG]]


def _outside() -> DisplayList:
    """One triangle beyond each side that touches it; one beyond each corner, whose box overlaps
    the screen."""
    side = SIDE
    return screen_list([
        [[0, 4], [0, 28], [-20, 16]], [[side, 4], [side, 28], [side + 20, 16]],
        [[4, 0], [28, 0], [16, -20]], [[4, side], [28, side], [16, side + 20]],
        [[-25, 8], [8, -25], [-25, -25]], [[57, 8], [24, -25], [57, -25]],
        [[-25, 24], [8, 57], [-25, 57]], [[57, 24], [24, 57], [57, 57]],
    ])


def _slope(x: Image, y: Image) -> Image:
    """11000000 + 3000001 right and - 4000003 down over 63.5 pixels, rounded half up."""
    doubled = 2 * (3_000_001 * (2 * x + 1) - 4_000_003 * (2 * y + 1)) + 127
    return 11_000_000 + doubled // 254


CASES: Final = (
    HardCase(
        "coordinate-ends",
        "gives an edge's column one bit too few, so an edge at the very end of the coordinates "
        "comes back at the other",
        partial(screen_list, [[[LOW, LOW], [HIGH, LOW], [HIGH, HIGH]],
                              [[LOW, LOW], [HIGH, HIGH], [LOW, HIGH]]]),
        (winners(lambda x, y: np.where(x >= y, 0, 1), "halves of the whole coordinate square"),
         covered_once(lambda x, y: 1, "the whole screen once"), ANY_WINDING),
    ),
    HardCase(
        "guard-band-cover",
        "throws away a triangle none of whose vertices is on the screen",
        partial(screen_list, [[[-63, -10], [63, -30], [20, 63.75]]]),
        (winners(lambda x, y: 0, "the whole screen"), ANY_WINDING),
    ),
    HardCase(
        "outside-eight-sides",
        "clamps vertices or boxes to the screen, and smears triangles beyond it along its rim",
        _outside,
        (NOTHING_DRAWN,),
    ),
    HardCase(
        "full-screen",
        "adds a rounded slope from pixel to pixel, and is off by many LSB at the far corner",
        partial(screen_list, [FULL_SCREEN], [[11_000_000, 14_000_001, 6_999_997]]),
        (winners(lambda x, y: 0, "the whole screen"),
         depths(_slope, "127ths, rounded half up"), ANY_WINDING),
    ),
)
