"""Display lists as such: none, one, many, repeated, in another order."""

from __future__ import annotations

from functools import partial
from typing import Final

import numpy as np

from ..scenes.built_in.random_numbers import RandomNumbers
from ..specification.display_list import DisplayList
from .expectations import ANY_ORDER, ANY_WINDING, NOTHING_DRAWN, difference, winners
from .hard_case import Draw, Expectation, HardCase
from .screen_lists import FARTHEST, SIDE, screen_list

#: Depth of each round of one-pixel triangles over the whole screen; the fourth is the nearest.
ROUNDS: Final = (500_000, 300_000, 900_000, 100_000, 700_000)

COPIES: Final = 3
REPEATED: Final = 20


def _random(count: int, seed: int, *, ties: bool) -> DisplayList:
    """Triangles of up to 20 pixels; with ``ties`` level ones of few depths."""
    numbers = RandomNumbers(seed)
    corners = (numbers.integers(SIDE * 256, count, 1, 2) / 256
               + (numbers.integers(20 * 256, count, 3, 2) - 10 * 256) / 256)
    if ties:
        return screen_list(corners, 1000 + numbers.integers(4, count))
    return screen_list(corners, numbers.integers(FARTHEST + 1, count, 3))


def _repeated() -> DisplayList:
    once = _random(REPEATED, 3, ties=False)
    return once.chosen(np.tile(np.arange(REPEATED), COPIES))


def _as_if_once(display_list: DisplayList, draw: Draw) -> str | None:
    picture = draw(display_list)
    once = draw(display_list.chosen(np.arange(REPEATED)))
    return (difference("primitive", picture.winner, once.winner)
            or difference("depth", picture.depth, once.depth))


def _any_order() -> DisplayList:
    """Random triangles, half of them steep, half level at four depths."""
    steep, level = _random(30, 4, ties=False), _random(30, 5, ties=True)
    both = screen_list(np.concatenate([steep.position, level.position]) / 256,
                       np.concatenate([steep.depth, level.depth]))
    return both.chosen(np.argsort(RandomNumbers(6).uniform(60), kind="stable"))


def _many() -> DisplayList:
    """Five rounds of one small triangle on every pixel."""
    y, x = np.divmod(np.arange(SIDE * SIDE), SIDE)
    around = np.array([[0.25, 0.25], [1, 0.25], [0.25, 1.25]])
    corners = np.stack([x, y], axis=1)[:, None] + around
    return screen_list(np.tile(corners, (len(ROUNDS), 1, 1)), np.repeat(ROUNDS, SIDE * SIDE))


CASES: Final = (
    HardCase(
        "empty",
        "never finishes a frame that it was sent no triangle for, or shows the last one",
        partial(screen_list, []),
        (NOTHING_DRAWN,),
    ),
    HardCase(
        "one-triangle",
        "starts a frame's work with the second triangle, or ends it with the last but one",
        partial(screen_list, [[[4, 4], [28, 4], [4, 28]]]),
        (winners(lambda x, y: np.where((x >= 4) & (y >= 4) & (x + y < 31), 0, -1),
                 "its right edge's centres are not its own"), ANY_WINDING),
    ),
    HardCase(
        "more-than-any-fifo",
        "drops or repeats triangles when a queue is full: 5120 of them, more than the deepest "
        "queue holds",
        _many,
        (winners(lambda x, y: 3 * SIDE * SIDE + SIDE * y + x, "the fourth round, every pixel"),),
    ),
    HardCase(
        "duplicates",
        "lets a repeated triangle win against itself, so the primitive changes though the "
        "picture does not",
        _repeated,
        (Expectation("the picture of the first copies alone", _as_if_once),),
    ),
    HardCase(
        "any-order",
        "depends on the order of the list beyond ties in depth",
        _any_order,
        (ANY_ORDER, ANY_WINDING),
    ),
)
