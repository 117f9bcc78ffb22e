"""The counts of a frame on any grid, against those that are counted anew, and by hand."""

import numpy as np
import pytest

from cardcage.golden.balancing.region_counts import counts_of
from cardcage.golden.scene_display_list import make_display_list
from cardcage.testbenches.figures.ellsworth.dealing.frame_loads import FrameLoads
from cardcage.testbenches.figures.ellsworth.dealing.models import mean_box, triangles_of
from cardcage.testbenches.figures.ellsworth.dealing.screen_grids import cut, screen_grid

SIZE = (75, 52)


def listed(side, count=300, seed=3):
    return make_display_list(f"random:n={count},size={side},seed={seed}", width=SIZE[0],
                             height=SIZE[1]).display_list


@pytest.mark.parametrize("side", [2, 7, 40])
@pytest.mark.parametrize("regions", [1, 6, 16, 96, 192])
def test_counts_are_those_of_the_golden_model(side, regions):
    loads = FrameLoads(triangles_of(listed(side)))
    grid = screen_grid(SIZE, regions)
    found, wanted = loads.counts(grid), counts_of(loads.triangles, grid)
    assert np.array_equal(found.triangles, wanted.triangles)
    assert np.array_equal(found.clocks, wanted.clocks)
    assert found.drawn == wanted.drawn
    if regions == 1:
        assert loads.fragments <= wanted.clocks[0]


@pytest.mark.parametrize("side", [5, 40])
def test_boxes_one_by_one(side):
    loads = FrameLoads(triangles_of(listed(side, 60)))
    grid, t = cut(SIZE, 5, 3), loads.triangles
    boxes, pixels = np.zeros(grid.count, int), np.zeros(grid.count, int)
    for left, right, top, bottom in zip(t.left, t.right, t.top, t.bottom, strict=True):
        for row in range(grid.rows):
            for column in range(grid.columns):
                columns = min(right, grid.x[column + 1]) - max(left, grid.x[column])
                rows = min(bottom, grid.y[row + 1]) - max(top, grid.y[row])
                if columns > 0 and rows > 0:
                    boxes[row * grid.columns + column] += 1
                    pixels[row * grid.columns + column] += max(rows, -(-rows * columns // 2))
    found = loads.boxes(grid)
    assert np.array_equal(found.boxes, boxes) and np.array_equal(found.pixels, pixels)


def test_nothing_is_drawn():
    empty = FrameLoads(triangles_of(listed(5).chosen(np.zeros(0, np.int64))))
    grid = cut(SIZE, 4, 4)
    assert empty.fragments == 0 and not empty.counts(grid).clocks.any()
    assert not empty.boxes(grid).boxes.any()
    assert mean_box(empty.triangles, 8) == (0.0, 0.0)


def test_the_mean_box():
    display_list = listed(20)
    triangles = triangles_of(display_list)
    position = display_list.position[triangles.primitive] / 256
    assert mean_box(triangles, 8) == pytest.approx(
        (position.max(axis=1) - position.min(axis=1)).mean(axis=0))
