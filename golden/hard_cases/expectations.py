"""What can be expected of a picture by hand or by an invariant."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..scenes.built_in.random_numbers import RandomNumbers
from ..specification.display_list import DisplayList
from ..specification.picture import NO_PRIMITIVE, Picture
from .hard_case import Draw, Expectation

#: Pixel columns and rows, each int64 (height, width).
Image = NDArray[np.int64]
#: A value for every pixel (x, y): an array of that shape, or one number for all.
Formula = Callable[[Image, Image], Any]


def alone(winner: Image) -> Image:
    """Every primitive a group of its own."""
    return winner


def in_pairs(winner: Image) -> Image:
    """Two primitives a group, as rectangles have them; -1 stays."""
    return winner // 2


def winners(
    formula: Formula, says: str, *, group: Callable[[Image], Image] = alone
) -> Expectation:
    """``formula`` gives the group of each pixel's primitive, -1 for the background."""

    def judge(display_list: DisplayList, draw: Draw) -> str | None:
        picture = draw(display_list)
        return difference("primitive", group(picture.winner.astype(np.int64)),
                          everywhere(formula, picture))

    return Expectation(says, judge)


def depths(formula: Formula, says: str, *, within: int = 0) -> Expectation:
    """``formula`` gives the depth of each pixel that anything was drawn on, to ``within`` LSB."""

    def judge(display_list: DisplayList, draw: Draw) -> str | None:
        picture = draw(display_list)
        expected = everywhere(formula, picture)
        drawn = picture.winner != NO_PRIMITIVE
        near = ~drawn | (abs(picture.depth - expected) <= within)
        return difference("depth", picture.depth, np.where(near, picture.depth, expected))

    return Expectation(says, judge)


def colors(formula: Formula, says: str) -> Expectation:
    """``formula`` gives (3, height, width) or (3,): the colour of each pixel drawn on."""

    def judge(display_list: DisplayList, draw: Draw) -> str | None:
        picture = draw(display_list)
        x, y = _columns_and_rows(picture)
        expected = np.zeros((3, *x.shape), np.int64)
        for channel, values in enumerate(formula(x, y)):
            expected[channel] = values
        drawn = picture.winner != NO_PRIMITIVE
        return difference("colour", np.where(drawn, packed(picture.color), 0),
                          np.where(drawn, packed(np.moveaxis(expected, 0, -1)), 0))

    return Expectation(says, judge)


def pixels(
    by_hand: Mapping[tuple[int, int], tuple[int, int, tuple[int, int, int]]], says: str
) -> Expectation:
    """Primitive, depth and colour at (x, y), and nothing anywhere else."""

    def judge(display_list: DisplayList, draw: Draw) -> str | None:
        picture = draw(display_list)
        drawn = {(int(x), int(y)) for y, x in np.argwhere(picture.winner != NO_PRIMITIVE)}
        if drawn != set(by_hand):
            return f"pixels {sorted(drawn ^ set(by_hand))[:4]} are drawn or missing"
        for (x, y), (primitive, depth, color) in by_hand.items():
            red, green, blue = picture.color[y, x].tolist()
            got = int(picture.winner[y, x]), int(picture.depth[y, x]), (red, green, blue)
            if got != (primitive, depth, color):
                return f"pixel {x, y} is {got}, not {primitive, depth, color}"
        return None

    return Expectation(says, judge)


NOTHING_DRAWN = winners(lambda x, y: NO_PRIMITIVE, "the background everywhere")


def covered_once(inside: Formula, says: str) -> Expectation:
    """The triangles cover the pixels where ``inside``, each once, and no others.

    With every depth equal the first triangle that hits a pixel keeps it, and in
    the reversed list the last one: both are the same where there is but one.
    """

    def judge(display_list: DisplayList, draw: Draw) -> str | None:
        level = replace(display_list, depth=np.zeros_like(display_list.depth))
        count = display_list.triangles
        first = draw(level)
        last = draw(level.chosen(np.arange(count)[::-1])).winner
        covered = (first.winner != NO_PRIMITIVE).astype(np.int64)
        return (difference("coverage", covered, everywhere(inside, first).astype(np.int64))
                or difference("last triangle", np.where(last < 0, last, count - 1 - last),
                              first.winner))

    return Expectation(says, judge)


def _any_winding(display_list: DisplayList, draw: Draw) -> str | None:
    expected = draw(display_list)
    for order in ([2, 1, 0], [1, 2, 0], [1, 0, 2]):
        turned = replace(display_list, **{
            field: getattr(display_list, field)[:, order]
            for field in ("position", "depth", "color")
        })
        complaint = _same_picture(draw(turned), expected)
        if complaint:
            return f"vertices in order {order}: {complaint}"
    return None


ANY_WINDING = Expectation("the same picture whichever vertex comes first, either way round",
                          _any_winding)


def _any_order(display_list: DisplayList, draw: Draw) -> str | None:
    count = display_list.triangles
    expected = draw(display_list)
    for seed in range(4):
        order = np.argsort(RandomNumbers(seed).uniform(count), kind="stable")
        got = draw(display_list.chosen(order))
        complaint = difference("depth", got.depth, expected.depth)
        if complaint:
            return f"permutation {seed}: {complaint}"
        winner = np.append(order, NO_PRIMITIVE)[got.winner]  # -1 is the last
        for primitive in np.unique(winner[winner != expected.winner]):
            # Another one is seen: then both are at the same depth there.
            alone = draw(display_list.chosen(np.array([primitive])))
            here = (winner == primitive) & (winner != expected.winner)
            if not np.array_equal(alone.depth[here], expected.depth[here]):
                return f"permutation {seed}: primitive {primitive} is seen where there is no tie"
    return None


ANY_ORDER = Expectation("the same depths in any order of the list; other primitives at ties alone",
                        _any_order)


def everywhere(formula: Formula, picture: Picture) -> Image:
    """int64 (height, width): ``formula`` of every pixel of ``picture``."""
    x, y = _columns_and_rows(picture)
    return np.broadcast_to(np.asarray(formula(x, y), np.int64), x.shape)


def _columns_and_rows(picture: Picture) -> tuple[Image, Image]:
    y, x = np.indices((picture.height, picture.width), np.int64)
    return x, y


def difference(what: str, got: NDArray[Any], expected: NDArray[Any]) -> str | None:
    """A complaint that names the first pixel at which two images differ."""
    wrong = np.argwhere(got != expected)
    if not len(wrong):
        return None
    y, x = wrong[0]
    return (f"{what} is wrong at {len(wrong)} pixels, first at ({x}, {y}): "
            f"{got[y, x]}, not {expected[y, x]}")


def _same_picture(got: Picture, expected: Picture) -> str | None:
    return (difference("primitive", got.winner, expected.winner)
            or difference("depth", got.depth, expected.depth)
            or difference("colour", packed(got.color), packed(expected.color)))


def packed(color: NDArray[Any]) -> Image:
    """(height, width) of (height, width, 3): red, green and blue as one number."""
    red, green, blue = np.moveaxis(color.astype(np.int64), -1, 0)
    return np.asarray(red << 16 | green << 8 | blue)
