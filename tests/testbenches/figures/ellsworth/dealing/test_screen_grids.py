"""How the screen is cut up."""

import numpy as np
import pytest

from cardcage.testbenches.figures.ellsworth.dealing.screen_grids import (
    PROCESSORS,
    RATIOS,
    cut,
    fits,
    processors_for,
    screen_grid,
)

SCREEN = (640, 512)


@pytest.mark.parametrize("regions", sorted({each * ratio for each in PROCESSORS
                                            for ratio in RATIOS}))
def test_every_curve_has_a_grid_that_covers_the_screen(regions):
    grid = screen_grid(SCREEN, regions)
    assert grid.count == regions
    assert (grid.x[0], grid.x[-1], grid.y[0], grid.y[-1]) == (0, 640, 0, 512)
    widths, heights = np.diff(grid.x), np.diff(grid.y)
    assert np.ptp(widths) <= 1 and np.ptp(heights) <= 1
    assert 0.5 <= widths.mean() / heights.mean() <= 2.5


def test_nearly_square_and_wide_rather_than_tall():
    assert screen_grid(SCREEN, 256).columns == 16  # of 40x32
    assert screen_grid((512, 512), 128).columns == 8  # 64x32 rather than 32x64
    assert screen_grid((512, 512), 2).columns == 1


def test_what_is_too_small_is_left_out():
    assert processors_for(SCREEN) == list(PROCESSORS)
    assert processors_for((64, 48)) == [2, 4, 8, 16]
    assert processors_for((32, 32)) == [2, 4] and processors_for((8, 8)) == []
    assert fits((64, 48), 192) and not fits((63, 48), 192)


def test_sides_differ_by_a_pixel():
    grid = cut((10, 7), 4, 2)
    assert grid.x.tolist() == [0, 2, 5, 7, 10] and grid.y.tolist() == [0, 3, 7]
