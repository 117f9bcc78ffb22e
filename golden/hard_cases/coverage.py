"""Which pixels: shared edges, edges and vertices on pixel centres, both windings, no area."""

from __future__ import annotations

from functools import partial
from typing import Final

import numpy as np

from ..scenes.built_in.random_numbers import RandomNumbers
from ..specification.display_list import DisplayList
from .expectations import (
    ANY_WINDING,
    NOTHING_DRAWN,
    Image,
    covered_once,
    in_pairs,
    winners,
)
from .hard_case import HardCase
from .screen_lists import fan, lattice, rectangle, screen_list


def _square(x: Image, y: Image) -> Image:
    return ((x >= 4) & (x < 28) & (y >= 4) & (y < 28)).astype(np.int64)


def _in_square(primitive: Image, x: Image, y: Image) -> Image:
    return np.where(_square(x, y), primitive, -1)


def _half_pixel_grid() -> DisplayList:
    """A square cut into 6 by 6 cells, their corners moved by up to a pixel in half pixels."""
    points = np.stack(np.meshgrid(np.arange(7.0), np.arange(7.0)), axis=2) * 4 + 4
    points[1:-1, 1:-1] += (RandomNumbers(5).integers(5, 5, 5, 2) - 2) / 2
    return screen_list(lattice(points))


def _top_against_bottom(x: Image, y: Image) -> Image:
    """The sides are 2 across for 1 down: from (16, 4.5) out to (4, 10.5), in to (16, 16.5)."""
    above = (y < 10) & (abs(2 * x + 1 - 32) < 4 * (y - 4))
    below = (y >= 10) & (abs(2 * x + 1 - 32) < 4 * (16 - y))
    return np.where(above, 0, np.where(below, 1, -1))


def _triangles_around_centres(x: Image, y: Image) -> Image:
    """One of a lattice two pixels apart, row by row, at each even pixel."""
    return np.where((x % 2 == 0) & (y % 2 == 0), y // 2 * 16 + x // 2, -1)


_SQUARE: Final = covered_once(_square, "each pixel of the square once")

CASES: Final = (
    HardCase(
        "shared-edge",
        "tests all three edges with >= (or all with >), so the pixel centres on the shared "
        "diagonal are drawn twice (or not at all)",
        partial(screen_list, rectangle(4, 4, 28, 28)),
        (winners(lambda x, y: _in_square(np.where(x >= y, 0, 1), x, y),
                 "the diagonal's centres go to the triangle on its right"), _SQUARE, ANY_WINDING),
    ),
    HardCase(
        "reversed-winding",
        "takes the sign of an edge function for the inside, so the anticlockwise half vanishes, "
        "or swaps its fill rule and overlaps the other",
        partial(screen_list, [[[4, 4], [28, 4], [4, 28]], [[28, 4], [4, 28], [28, 28]]]),
        (winners(lambda x, y: _in_square(np.where(x + y < 31, 0, 1), x, y),
                 "the diagonal's centres go to the triangle on its right"), _SQUARE, ANY_WINDING),
    ),
    HardCase(
        "vertices-on-centres",
        "decides a vertex on a pixel centre edge by edge with rules that do not fit together, "
        "so the hub is drawn by none or by several",
        partial(screen_list, fan([12.5, 12.5], [[4.5, 4.5], [20.5, 4.5], [20.5, 20.5],
                                                [4.5, 20.5]])),
        (winners(lambda x, y: np.where(
            (x >= 4) & (x < 20) & (y >= 4) & (y < 20),
            np.where(x >= y, np.where(x + y < 24, 0, 1), np.where(x + y < 24, 3, 2)), -1),
            "left and top sides and the hub's pixel by the top-left rule"), ANY_WINDING),
    ),
    HardCase(
        "half-pixel-grid",
        "works as long as no edge meets a centre; on the half-pixel grid most do, and cracks "
        "and doubly drawn pixels appear",
        _half_pixel_grid,
        (_SQUARE, ANY_WINDING),
    ),
    HardCase(
        "top-against-bottom-edge",
        "treats both level edges alike, so the row of centres between the two triangles is "
        "drawn twice or stays empty",
        partial(screen_list, [[[4, 10.5], [16, 4.5], [28, 10.5]],
                              [[4, 10.5], [28, 10.5], [16, 16.5]]]),
        (winners(_top_against_bottom, "row 10 goes to the triangle that it is the top of"),),
    ),
    HardCase(
        "vertical-edges-on-centres",
        "rounds a span's two ends alike, so a column of centres on a common edge belongs to "
        "both neighbours or to none",
        partial(screen_list, [*rectangle(4.5, 4, 12.5, 28), *rectangle(12.5, 4, 20.5, 28),
                              *rectangle(20.5, 4, 28.5, 28)]),
        (winners(lambda x, y: np.where((y >= 4) & (y < 28) & (x >= 4) & (x < 28),
                                       (x - 4) // 8, -1),
                 "each column of centres goes to the strip on its right", group=in_pairs),),
    ),
    HardCase(
        "t-junction",
        "rounds the long edge differently from its two halves, so pixels leak at the vertex in "
        "its middle",
        partial(screen_list, [[[4, 4], [28, 28], [4, 28]], [[4, 4], [28, 4], [16, 16]],
                              [[16, 16], [28, 4], [28, 28]]]),
        (winners(lambda x, y: _in_square(np.where(x < y, 0, np.where(x + y < 31, 1, 2)), x, y),
                 "both halves meet the long edge without gap or overlap"), _SQUARE),
    ),
    HardCase(
        "t-junction-off-centre",
        "as t-junction, with a slope that a fixed-point edge cannot hold: 7 across for 24 down",
        partial(screen_list, [[[9, 4], [16, 28], [4, 28]], [[9, 4], [4, 28], [4, 4]],
                              [[9, 4], [28, 4], [10.75, 10]], [[10.75, 10], [28, 4], [28, 28]],
                              [[10.75, 10], [28, 28], [16, 28]]]),
        (_SQUARE,),
    ),
    HardCase(
        "one-pixel",
        "rounds the bounding box inwards or drops triangles smaller than a pixel, and loses "
        "meshes seen from afar",
        partial(screen_list, [[[x + 0.25, y + 0.25], [x + 1.25, y + 0.5], [x + 0.5, y + 1.25]]
                              for y in range(0, 32, 2) for x in range(0, 32, 2)]),
        (winners(_triangles_around_centres, "each covers the one centre it encloses"),),
    ),
    HardCase(
        "between-centres",
        "draws at least one pixel for every triangle, or every pixel it touches",
        partial(screen_list, [
            [[5.625, 5.625], [6.375, 5.625], [5.625, 6.375]],
            [[2, 7.5625], [30, 7.5625], [30, 8.4375]],
            [[10.5625, 10], [11.4375, 10], [11, 30]],
            [[20.5, 20.75], [21.25, 21.5], [21.25, 21.75]],  # its box encloses a centre
        ]),
        (NOTHING_DRAWN,),
    ),
    HardCase(
        "zero-area",
        "divides by the area, or draws the line that a triangle without area leaves under a "
        "rule that counts its edges as inside",
        partial(screen_list, [
            [[16.5, 16.5]] * 3,
            [[4.5, 4.5], [28.5, 4.5], [16.5, 4.5]],
            [[4.5, 4.5], [4.5, 28.5], [4.5, 28.5]],
            [[4.5, 4.5], [28.5, 28.5], [16.5, 16.5]],
            [[28.5, 4.5], [4.5, 28.5], [4.5, 28.5]],
            [[2.5, 8.5], [26.5, 14.5], [14.5, 11.5]],
            [[0, 0], [0, 63.5], [63.5, 0]],
        ], depth=[0, 0, 0, 0, 0, 0, 1000]),
        (winners(lambda x, y: 6, "only the triangle behind them is seen"),),
    ),
)
