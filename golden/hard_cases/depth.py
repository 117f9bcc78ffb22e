"""Depth and colour at a pixel: ties, planes in common, steep and level ones, ends of the range."""

from __future__ import annotations

from functools import partial
from typing import Any, Final

import numpy as np

from ..specification.display_list import DisplayList
from .expectations import ANY_ORDER, Image, colors, depths, in_pairs, pixels, winners
from .hard_case import HardCase
from .screen_lists import FARTHEST, rectangle, screen_list

MIDDLE: Final = 8_000_000

WHITE, BLACK = (255, 255, 255), (0, 0, 0)


def _half_up(numerator: Image, denominator: int) -> Image:
    return (2 * numerator + denominator) // (2 * denominator)


def _two_diagonals() -> DisplayList:
    """The plane MIDDLE + 1000 x + 700 y over a square of 27, cut both ways."""
    a, b, c, d = [2, 2], [29, 2], [29, 29], [2, 29]
    corners = [[a, b, c], [a, c, d], [a, b, d], [b, c, d]]
    return screen_list(corners, [[MIDDLE + 1000 * x + 700 * y for x, y in triangle]
                                 for triangle in corners])


def _nested() -> DisplayList:
    """Three triangles of the plane MIDDLE - 300 x + 1100 y; the middle one first."""
    corners = [[[8, 8], [8, 20], [20, 8]], [[2, 2], [2, 30], [30, 2]], [[10, 10], [14, 10],
                                                                       [10, 14]]]
    return screen_list(corners, [[MIDDLE - 300 * x + 1100 * y for x, y in triangle]
                                 for triangle in corners])


def _crossing(amount: int) -> DisplayList:
    """Two squares: depth falls and rises by ``amount`` from the middle down, and rightwards."""
    square = rectangle(0, 0, 32, 32)
    rows, columns = ([[MIDDLE + amount * (corner[axis] - 16) // 16 for corner in triangle]
                      for triangle in square] for axis in (1, 0))
    return screen_list([*square, *square], [*rows, *columns])


def _crossing_case(amount: int) -> HardCase:
    def winner(x: Image, y: Image) -> Image:
        down, right = _half_up(amount * (2 * y - 31), 32), _half_up(amount * (2 * x - 31), 32)
        return np.where(right < down, 1, 0)

    def depth(x: Image, y: Image) -> Image:
        return MIDDLE + _half_up(amount * np.minimum(2 * x - 31, 2 * y - 31), 32)

    return HardCase(
        f"crossing-{amount}-lsb",
        f"keeps slopes to a few bits and moves the line where two planes cross; here they part by "
        f"only {amount} LSB from the middle to the rim",
        partial(_crossing, amount),
        (winners(winner, "the least rounded depth, the first square on a tie", group=in_pairs),
         depths(depth, "the nearer plane, rounded half up"), ANY_ORDER),
    )


#: Covers the centre of pixel (x, y) alone, with weights 5/12, 1/3, 1/4 there.
def _within_pixel(x: int, y: int) -> list[list[float]]:
    return [[x + 0.25, y + 0.25], [x + 1, y + 0.25], [x + 0.25, y + 1.25]]


def _half_way() -> DisplayList:
    """Depth rises by 1/3 a column above the diagonal, and falls by 1/3 a row below it."""
    return screen_list([[[4, 4], [28, 4], [4, 28]], [[28, 4], [28, 28], [4, 28]]],
                       [[MIDDLE, MIDDLE + 8, MIDDLE], [MIDDLE, MIDDLE - 8, MIDDLE - 8]])


def _half_way_depth(x: Image, y: Image) -> Image:
    return MIDDLE + np.where(x + y < 31, _half_up(2 * (x - 4) + 1, 6), _half_up(7 - 2 * y, 6))


def _towards_the_ends() -> DisplayList:
    """Up to the farthest by 1/2 a column above the diagonal, down to 0 by 5/8 a row below it."""
    far = [[FARTHEST - 12, FARTHEST, FARTHEST - 12], [15, 0, 0]]
    return screen_list([[[4, 4], [28, 4], [4, 28]], [[28, 4], [28, 28], [4, 28]]], far,
                       [[[243] * 3, [255] * 3, [243] * 3], [[15] * 3, [0] * 3, [0] * 3]])


def _towards_the_ends_values(far: int) -> Any:
    return lambda x, y: np.where(x + y < 31, far - 12 + _half_up(2 * (x - 4) + 1, 4),
                                 15 - (5 * (2 * (y - 4) + 1) + 7) // 16)


CASES: Final = (
    HardCase(
        "other-diagonal",
        "gets the same plane from other vertices a little differently, so two squares cut along "
        "different diagonals show through each other (z-fighting)",
        _two_diagonals,
        (winners(lambda x, y: np.where((x >= 2) & (x < 29) & (y >= 2) & (y < 29), 0, -1),
                 "only the first square is seen", group=in_pairs),
         depths(lambda x, y: MIDDLE + 1000 * x + 700 * y + 850, "the plane at the centres"),
         ANY_ORDER),
    ),
    HardCase(
        "nested-coplanar",
        "as other-diagonal, for triangles inside one another: decals flicker",
        _nested,
        (winners(lambda x, y: np.where((x >= 8) & (y >= 8) & (x + y < 27), 0,
                                       np.where((x >= 2) & (y >= 2) & (x + y < 31), 1, -1)),
                 "the earlier one keeps its pixels"),
         depths(lambda x, y: MIDDLE - 300 * x + 1100 * y + 400, "the plane at the centres"),
         ANY_ORDER),
    ),
    *(_crossing_case(amount) for amount in (3, 30, 300)),
    HardCase(
        "equal-depth-ties",
        "lets the later of two equal depths win on one card and the earlier on another, so the "
        "picture depends on the order of the cards",
        partial(screen_list, [*rectangle(2, 2, 20, 20), *rectangle(8, 8, 30, 30),
                              *rectangle(4, 4, 28, 28), *rectangle(12, 0, 18, 32)],
                [MIDDLE] * 8),
        (winners(lambda x, y: np.select(
            [(x >= 2) & (x < 20) & (y >= 2) & (y < 20), (x >= 8) & (x < 30) & (y >= 8) & (y < 30),
             (x >= 4) & (x < 28) & (y >= 4) & (y < 28), (x >= 12) & (x < 18)], [0, 1, 2, 3], -1),
            "the first rectangle that covers a pixel", group=in_pairs), ANY_ORDER),
    ),
    HardCase(
        "near-to-far-in-a-pixel",
        "holds a slope in the word of a depth, where a plane through the whole range within one "
        "pixel overflows it",
        partial(screen_list, [_within_pixel(4, 4), _within_pixel(8, 4), _within_pixel(12, 4)],
                [[0, FARTHEST, 0], [FARTHEST, 0, 0], [0, FARTHEST, FARTHEST]], [WHITE] * 3),
        # 16777214 / 3 = 5592404 2/3, its 5/12 = 6990505 5/6, its 7/12 = 9786708 1/6.
        (pixels({(4, 4): (0, 5_592_405, WHITE), (8, 4): (1, 6_990_506, WHITE),
                 (12, 4): (2, 9_786_708, WHITE)}, "the weights at the centre are 5/12, 1/3, 1/4"),),
    ),
    HardCase(
        "color-0-to-255-in-a-pixel",
        "lets a steep colour plane leave 0 to 255 at the centre, and wraps it round",
        partial(screen_list, [_within_pixel(4, 4), _within_pixel(8, 4), _within_pixel(12, 4)],
                [5, 6, 7], [[WHITE, BLACK, BLACK], [BLACK, WHITE, BLACK],
                            [(255, 0, 0), (0, 255, 0), (0, 0, 255)]]),
        # 255 * 5/12 = 106 1/4, 255 / 3 = 85, 255 / 4 = 63 3/4.
        (pixels({(4, 4): (0, 5, (106, 106, 106)), (8, 4): (1, 6, (85, 85, 85)),
                 (12, 4): (2, 7, (106, 85, 64))}, "the weights at the centre are 5/12, 1/3, 1/4"),),
    ),
    HardCase(
        "nearest-and-farthest-depth",
        "compares signed, or adds half an LSB that carries into the background's value",
        partial(screen_list, [*rectangle(0, 0, 32, 32), *rectangle(4, 4, 28, 28)],
                [FARTHEST, FARTHEST, 0, 0], [WHITE, WHITE, BLACK, BLACK]),
        (winners(lambda x, y: np.where((x >= 4) & (x < 28) & (y >= 4) & (y < 28), 1, 0),
                 "the nearest before the farthest, no background", group=in_pairs),
         depths(lambda x, y: np.where((x >= 4) & (x < 28) & (y >= 4) & (y < 28), 0, FARTHEST),
                "a level plane has the depth of its vertices")),
    ),
    HardCase(
        "half-way-depths",
        "lets a slope rounded down decide a depth exactly half-way between two values",
        _half_way,
        (winners(lambda x, y: np.where((x >= 4) & (x < 28) & (y >= 4) & (y < 28),
                                       np.where(x + y < 31, 0, 1), -1), "the two halves"),
         depths(_half_way_depth, "thirds and sixths, rounded half up")),
    ),
    HardCase(
        "drift-past-both-ends",
        "wraps a depth or colour that rounding has carried past the end of its range, so the "
        "farthest becomes the nearest and white turns black",
        _towards_the_ends,
        (depths(_towards_the_ends_values(FARTHEST), "halves and sixteenths, rounded half up"),
         colors(lambda x, y: [_towards_the_ends_values(255)(x, y)] * 3,
                "the same slopes in every channel")),
    ),
)
