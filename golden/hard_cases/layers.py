"""A hundred layers that each cover the whole screen."""

from __future__ import annotations

from functools import partial
from typing import Final

import numpy as np

from ..scenes.built_in.random_numbers import RandomNumbers
from ..specification.display_list import DisplayList
from .coordinate_range import FULL_SCREEN
from .expectations import ANY_ORDER, Image, depths, winners
from .hard_case import HardCase
from .screen_lists import Int64, screen_list

LAYERS: Final = 100

FRONT_TO_BACK: Final = np.arange(LAYERS)
SHUFFLED: Final = np.argsort(RandomNumbers(12).uniform(LAYERS), kind="stable")


def _layers(order: Int64) -> DisplayList:
    """Parallel planes 20000 apart, all sloped by 1270 down 63.5 pixels; 0 is the nearest."""
    depth = 1_000_000 + 20_000 * order[:, None] + np.array([0, 0, 1270])
    return screen_list([FULL_SCREEN] * LAYERS, depth)


def _nearest(x: Image, y: Image) -> Image:
    return 1_000_000 + 20 * y + 10


def _case(name: str, mistake: str, order: Int64) -> HardCase:
    place = int(np.flatnonzero(order == 0)[0])
    return HardCase(
        f"layers-{name}", mistake, partial(_layers, order),
        (winners(lambda x, y: place, "the nearest layer everywhere"),
         depths(_nearest, "the nearest plane: 20 a row"), ANY_ORDER),
    )


CASES: Final = (
    _case("front-to-back", "writes a hidden fragment that was compared before the nearer one, "
          "still on its way, had been stored", FRONT_TO_BACK),
    _case("back-to-front", "loses one of two winners that hit a pixel in consecutive clocks; "
          "here every fragment wins", FRONT_TO_BACK[::-1]),
    _case("shuffled", "gets one of the two right, depending on what happens to be in its "
          "pipeline", SHUFFLED),
)
