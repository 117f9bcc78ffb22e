"""Coordinates and depths that are off the grid until they are quantised."""

from __future__ import annotations

from collections.abc import Callable
from fractions import Fraction
from math import floor
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

from ..scenes.built_in.random_numbers import RandomNumbers
from ..scenes.mesh_display_list import display_list_of_corners
from ..scenes.quantise import PictureFormat
from ..specification.display_list import DisplayList
from .expectations import (
    NOTHING_DRAWN,
    Image,
    covered_once,
    depths,
    in_pairs,
    winners,
)
from .hard_case import Draw, Expectation, HardCase
from .screen_lists import FARTHEST, SIDE, SUB_BITS, lattice, rectangle, shaded_colors

PICTURE: Final = PictureFormat(SIDE, SIDE)

Float64 = NDArray[np.float64]

#: The greatest number below a half: adding a half to it rounds up to 1.
BELOW_HALF: Final = 0.49999999999999994


def snapped_list(corners: Float64, depth: float = 0.5) -> DisplayList:
    """Corners (n, 3, 2) in pixels, on the grid or not, at a depth of 0 … 1."""
    count = len(corners)
    homogeneous = np.concatenate([
        corners, np.full((count, 3, 1), depth), np.ones((count, 3, 1)),
        shaded_colors(count).astype(np.float64)], axis=2)
    return display_list_of_corners(homogeneous, PICTURE)


def _snaps(make: Callable[[], Float64]) -> Expectation:
    """The positions are floor(256 v + 1/2) of the corners that ``make`` gives, in fractions."""

    def judge(display_list: DisplayList, draw: Draw) -> str | None:
        values = make().reshape(-1).tolist()
        expected = [floor(Fraction(value) * (1 << SUB_BITS) + Fraction(1, 2)) for value in values]
        got = display_list.position.reshape(-1).tolist()
        if len(got) != len(expected):
            return f"{len(got)} coordinates, not {len(expected)}"
        for number, (value, mine, wanted) in enumerate(zip(values, got, expected, strict=True)):
            if mine != wanted:
                return f"coordinate {number}, {value!r}, became {mine}, not {wanted}"
        return None

    return Expectation("positions rounded half up, by fractions", judge)


def _ties() -> Float64:
    """A square whose corners lie half a unit off the centres of pixels 4 and 20; slivers whose
    corners are ties on either side of 0 and as near to one as can be."""
    low, high = 4 + 128.5 / 256, 20 + 128.5 / 256
    minus = [-k - 0.5 for k in range(4)]
    return np.array([
        *rectangle(low, low, high, high),
        [[minus[0] / 256, minus[1] / 256], [minus[2] / 256, minus[3] / 256], [0.5 / 256, 9.0]],
        [[BELOW_HALF / 256, -BELOW_HALF / 256], [1.5 / 256, 2.5 / 256], [3.5 / 256, 9.0]],
    ])


def _moved_lattice(kind: Any) -> Float64:
    """A mesh over the whole screen whose vertices are random numbers of type ``kind``."""
    points = np.stack(np.meshgrid(np.arange(8.0), np.arange(8.0)), axis=2) * 5 - 1.5
    moved = (points + RandomNumbers(9).uniform(8, 8, 2) - 0.5).astype(kind).astype(np.float64)
    return np.asarray(lattice(moved))


def _off_grid_float32() -> Float64:
    return _moved_lattice(np.float32)


def _off_grid_float64() -> Float64:
    """A lattice, and a square in front whose sides are a hair short of a tie: float32 has no
    number between, so it would round them up, past the centres of pixels 4 and 20."""
    low, high = (4 + (128.5 - 2.0**-20) / 256, 20 + (128.5 - 2.0**-20) / 256)
    return np.concatenate([np.array(rectangle(low, low, high, high)), _moved_lattice(np.float64)])


def _short_of_a_tie(x: Image, y: Image) -> Image:
    return np.where((x >= 4) & (x < 20) & (y >= 4) & (y < 20), 0, 1)


def _square_or_lattice(winner: Image) -> Image:
    """The square has numbers 0 and 1, the lattice the rest."""
    return np.minimum(winner // 2, 1)


def _flattened() -> Float64:
    """Triangles less than half a unit high: on the grid their corners are in a line, on the
    centres."""
    hair = 0.4 / 256
    return np.array([
        [[4, 10.5], [28, 10.5], [16, 10.5 + hair]],
        [[14.5, 4], [14.5, 28], [14.5 + hair, 16]],
        [[4, 4], [28, 28], [16 + hair, 16]],
        [[20.5, 20.5], [20.5 + hair, 20.5], [20.5, 20.5 + hair]],
    ])


CASES: Final = (
    HardCase(
        "snap-ties",
        "rounds ties to even, away from zero or by floor(v + 1/2) in floating point, so sides on "
        "a tie come to lie on either side of a pixel centre",
        lambda: snapped_list(_ties()),
        (_snaps(_ties),
         winners(lambda x, y: np.where((x > 4) & (x <= 20) & (y > 4) & (y <= 20),
                                       np.where(x >= y, 0, 1), -1),
                 "half a unit off the centre is a whole unit right of it and below")),
    ),
    HardCase(
        "off-grid-float32",
        "snaps one triangle's copy of a vertex in another precision than its neighbour's, and "
        "opens cracks",
        lambda: snapped_list(_off_grid_float32()),
        (_snaps(_off_grid_float32), covered_once(lambda x, y: 1, "the whole screen once")),
    ),
    HardCase(
        "off-grid-float64",
        "passes coordinates through float32 before they are snapped, and moves sides across "
        "pixel centres",
        lambda: snapped_list(_off_grid_float64()),
        (_snaps(_off_grid_float64),
         winners(_short_of_a_tie, "the square covers pixels 4 to 19, the lattice the rest",
                 group=_square_or_lattice)),
    ),
    HardCase(
        "collinear-after-snap",
        "decides before the snap that a triangle has an area, and divides by it after",
        lambda: snapped_list(_flattened()),
        (NOTHING_DRAWN, _snaps(_flattened)),
    ),
    HardCase(
        "depth-of-the-background",
        "gives a vertex on the far plane the depth of the background, and loses whatever is "
        "there",
        lambda: snapped_list(np.array(rectangle(4, 4, 28, 28)), depth=1.0),
        (winners(lambda x, y: np.where((x >= 4) & (x < 28) & (y >= 4) & (y < 28), 0, -1),
                 "the square is seen", group=in_pairs),
         depths(lambda x, y: FARTHEST, "one less than the background's")),
    ),
)
