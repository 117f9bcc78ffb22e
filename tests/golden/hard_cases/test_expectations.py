"""What an expectation complains of, and what it lets pass."""

from dataclasses import replace

import numpy as np
import pytest

from cardcage.golden.hard_cases.expectations import colors, depths
from cardcage.golden.hard_cases.hard_case import Expectation
from cardcage.golden.specification.picture import NO_PRIMITIVE, Picture


def slope(x, y):
    return 100 + 10 * x + y


@pytest.fixture
def picture():
    """3 by 2 pixels on that slope, all but one of them drawn on."""
    y, x = np.mgrid[:2, :3]
    winner = np.zeros((2, 3), np.int32)
    winner[1, 0] = NO_PRIMITIVE
    return Picture(color=np.stack([x, y, x + y], axis=-1).astype(np.uint8), depth=slope(x, y),
                   winner=winner)


def judged(expectation: Expectation, picture):
    return expectation.judge(None, lambda _: picture)


@pytest.mark.parametrize("within", [0, 1, 3])
def test_a_depth_may_be_so_much_off_and_no_more(picture, within):
    expectation = depths(slope, "", within=within)
    for error in range(-within, within + 1):
        assert judged(expectation, replace(picture, depth=picture.depth + error)) is None
    for error in (-within - 1, within + 1):
        wrong = picture.depth.copy()
        wrong[1, 2] += error
        assert judged(expectation, replace(picture, depth=wrong)) == (
            f"depth is wrong at 1 pixels, first at (2, 1): {121 + error}, not 121")


def test_colours_count_where_something_was_drawn(picture):
    expectation = colors(lambda x, y: (x, y, x + y), "")
    assert judged(expectation, picture) is None
    picture.color[1, 0] += 1  # nothing was drawn there
    assert judged(expectation, picture) is None
    picture.color[0, 0, 2] += 1
    assert "first at (0, 0): 1, not 0" in judged(expectation, picture)


def test_a_depth_where_nothing_was_drawn_does_not_count(picture):
    picture.depth[1, 0] = 4095
    assert judged(depths(slope, ""), picture) is None
