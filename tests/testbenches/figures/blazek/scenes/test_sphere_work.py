"""What of a sphere lies in a part of the screen, against polygons and pixels taken one by one."""

import numpy as np
import pytest

from cardcage.testbenches.figures.blazek.scenes.screen_parts import screen_grid_of, work_in_parts
from cardcage.testbenches.figures.blazek.scenes.sphere_work import (
    SphereTemplate,
    _covered,
    sphere_polygons,
)
from cardcage.testbenches.figures.blazek.scenes.spheres import (
    SPHERES,
    sphere_places,
    sphere_radius,
    sphere_reach,
)

SIZE = (128, 64)
RADIUS = 9.3


@pytest.fixture(scope="module")
def template():
    return SphereTemplate(RADIUS)


def one_by_one(place, inside):
    """Polygons, lines and pixels of a sphere about ``place`` where ``inside`` of (y, x) holds."""
    reach = sphere_reach(RADIUS)
    corners = sphere_polygons()[..., :2] * RADIUS + reach
    low, high = np.floor(corners.min(axis=1)).astype(int), np.floor(corners.max(axis=1)).astype(int)
    shift = place - reach
    polygons = sum(inside[y0 + shift[1]:y1 + shift[1] + 1, x0 + shift[0]:x1 + shift[0] + 1].any()
                   for (x0, y0), (x1, y1) in zip(low.tolist(), high.tolist(), strict=True))
    lines = pixels = 0
    for row, left, length, _ in zip(*_covered(corners, 2 * reach), strict=True):
        own = inside[row + shift[1], left + shift[0]:left + shift[0] + length].sum()
        lines, pixels = lines + bool(own), pixels + int(own)
    return int(polygons), lines, pixels


@pytest.mark.parametrize("parts", ["strips", "grid", "lines"])
def test_parts_of_the_screen(template, parts):
    nodes = 8
    places = np.array([[16, 20], [63, 33], [100, 41]])
    found = work_in_parts(template, places, SIZE, nodes, parts)
    for node in (0, 3, 5):
        inside = np.zeros((SIZE[1], SIZE[0]), bool)
        if parts == "lines":
            inside[node::nodes] = True
        else:
            grid = screen_grid_of(SIZE, nodes, parts)
            row, column = divmod(node, grid.columns)
            inside[grid.y[row]:grid.y[row + 1], grid.x[column]:grid.x[column + 1]] = True
        for number, place in enumerate(places):
            own = found[number, node]
            assert (own.polygons, own.lines, own.pixels) == one_by_one(place, inside)


def test_parts_make_the_whole(template):
    places = np.stack([np.arange(20, 100, 9), np.arange(12, 48, 4)], axis=1)
    whole = template.whole
    assert template.polygons == 5120
    # Front and back of a disc, but for the pixels on its rim.
    assert whole.pixels.sum() == pytest.approx(2 * np.pi * RADIUS**2, rel=0.03)
    for parts in ("strips", "grid", "lines"):
        found = work_in_parts(template, places, SIZE, 16, parts)
        assert (found.pixels.sum(axis=1) == whole.pixels.sum()).all()
        assert (found.polygons.sum(axis=1) >= template.polygons).all()
        one = work_in_parts(template, places, SIZE, 1, parts)
        assert (one.polygons == template.polygons).all() and (
            one.lines == whole.lines.sum()).all()


def test_places():
    many = sphere_places(SIZE, 3, SPHERES[-1])
    assert (sphere_places(SIZE, 3, 5) == many[:5]).all()
    reach = sphere_reach(sphere_radius(SIZE))
    assert many.min(axis=0).tolist() == [reach, reach]
    assert many.max(axis=0).tolist() == [SIZE[0] - reach, SIZE[1] - reach]
    assert not (sphere_places(SIZE, 4, 5) == many[:5]).all()
