"""The picture contract once more, in fractions, one pixel at a time.

Nothing here is shared with ``coverage``, ``exact`` or ``triangle_setup``: plain loops,
Python integers and ``Fraction``, slow and easy to believe.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from fractions import Fraction
from math import floor

from ..specification.display_list import DisplayList
from ..specification.sampling_grid import Grid

Point = tuple[int, int]
Color = tuple[int, int, int]


@dataclass(frozen=True)
class Pixel:
    """What is seen at a pixel: the winner, its depth and its Gouraud colour."""

    primitive: int
    depth: int
    color: Color


def rational_picture(display_list: DisplayList, sample: int = 1) -> dict[Point, Pixel]:
    """The pixels (x, y) on which something is drawn, among every ``sample``-th in raster order.

    The winner is the least (depth, primitive number).
    """
    positions = display_list.position.tolist()
    depths = display_list.depth.tolist()
    grid = Grid.of(display_list)
    nearest: dict[Point, tuple[int, int, list[int]]] = {}
    for primitive, (corners, depth) in enumerate(zip(positions, depths, strict=True)):
        for pixel, weights in covered(corners, grid, sample):
            here = round_half_up(mean(depth, weights))
            if pixel not in nearest or (here, primitive) < nearest[pixel][:2]:
                nearest[pixel] = here, primitive, weights
    picture = {}
    for pixel, (here, primitive, weights) in nearest.items():
        red, green, blue = (round_half_up(mean(channel, weights))
                            for channel in display_list.color[primitive].T.tolist())
        picture[pixel] = Pixel(primitive, here, (red, green, blue))
    return picture


def covered(
    corners: list[list[int]], grid: Grid, sample: int = 1
) -> Iterator[tuple[Point, list[int]]]:
    """The pixels whose centres a triangle covers, with the weight of each vertex there.

    The weights are barycentric, times the doubled area, which is their sum.
    Where one is 0 the centre is on the opposite edge, which belongs to the
    triangle if it is a left one (the inside lies to its right) or a top one
    (level, the inside below).
    """
    doubled = area(*corners)
    if doubled == 0:
        return
    xs, ys = zip(*corners, strict=True)
    for y in range(max(0, min(ys) // grid.unit_y), min(grid.height, max(ys) // grid.unit_y + 1)):
        for x in range(max(0, min(xs) // grid.unit_x), min(grid.width, max(xs) // grid.unit_x + 1)):
            if (y * grid.width + x) % sample:
                continue
            centre = [x * grid.unit_x + grid.unit_x // 2, y * grid.unit_y + grid.unit_y // 2]
            weights = []
            for opposite in range(3):
                begin, end = corners[opposite - 2], corners[opposite - 1]
                part = area(begin, end, centre)
                if part * doubled < 0 or (part == 0 and not top_left(begin, end, doubled)):
                    break
                weights.append(part)
            else:
                yield (x, y), weights


def area(a: list[int], b: list[int], c: list[int]) -> int:
    """Twice the area of a triangle, positive where it runs clockwise as seen (y downwards)."""
    return (b[0] - a[0]) * (c[1] - a[1]) - (c[0] - a[0]) * (b[1] - a[1])


def top_left(begin: list[int], end: list[int], doubled: int) -> bool:
    """Whether an edge of a triangle of that doubled area is a left or a top one."""
    if doubled < 0:  # as if it ran clockwise: then left edges go up and top edges rightwards
        begin, end = end, begin
    return end[1] < begin[1] or (end[1] == begin[1] and end[0] > begin[0])


def mean(values: list[int], weights: list[int]) -> Fraction:
    total = sum(value * weight for value, weight in zip(values, weights, strict=True))
    return Fraction(total, sum(weights))


def round_half_up(value: Fraction) -> int:
    return floor(value + Fraction(1, 2))
