"""Clipping: watertight, complete, and only where it is needed."""

from fractions import Fraction

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from cardcage.golden.scenes.clipping import clip, intersections
from cardcage.golden.scenes.quantise import (
    PictureFormat,
    quantise_colors,
    quantise_depths,
    quantise_positions,
    round_half_up,
)

PICTURE = PictureFormat(64, 48)
BAND = PICTURE.guard_band


def corners(*triangles, w=1.0):
    """Triangles of (x, y, z) in pixels at one w, with a colour that follows x."""
    points = np.array(triangles, np.float64)
    rest = np.stack([np.full(points.shape[:2], w), points[..., 0]], axis=-1)
    return np.concatenate([points[..., :3] * w, rest], axis=-1)


def polygon_area(points):
    """Exact area (Fractions) of a closed polygon of exact points."""
    total = Fraction(0)
    for (ax, ay), (bx, by) in zip(points, points[1:] + points[:1], strict=True):
        total += ax * by - ay * bx
    return abs(total) / 2


def exact(points):
    return [(Fraction(float(x)), Fraction(float(y))) for x, y in points]


def exact_clip_area(triangle, low, high):
    """Area of a triangle inside low <= x, y <= high, in rational arithmetic."""
    polygon = exact(triangle)
    for axis, limit, sign in ((0, low, 1), (0, high, -1), (1, low, 1), (1, high, -1)):
        kept = []
        for a, b in zip(polygon, polygon[1:] + polygon[:1], strict=True):
            da, db = sign * (a[axis] - limit), sign * (b[axis] - limit)
            if da >= 0:
                kept.append(a)
            if (da >= 0) != (db >= 0):
                t = da / (da - db)
                kept.append((a[0] + (b[0] - a[0]) * t, a[1] + (b[1] - a[1]) * t))
        polygon = kept
    return polygon_area(polygon) if polygon else Fraction(0)


def test_triangles_inside_the_guard_band_come_back_bit_for_bit():
    given = corners(
        [(1, 2, 0.1), (60, 3, 0.2), (5, 40, 0.3)],
        [(-BAND, -BAND, 0), (BAND - 1, 0, 0.5), (0, BAND - 1, 1)],
    )
    result = clip(given, PICTURE)
    assert np.array_equal(result.corners, given)
    assert result.source.tolist() == [0, 1]


@pytest.mark.parametrize("triangle", [
    [(-9, 0, 0.5), (-1, 20, 0.5), (0, 5, 0.5)],
    [(64, 0, 0.5), (70, 20, 0.5), (99, 5, 0.5)],
    [(1, -9, 0.5), (9, -1, 0.5), (3, 0, 0.5)],
    [(1, 48, 0.5), (9, 50, 0.5), (3, 99, 0.5)],
    [(1, 1, -0.5), (9, 1, -0.1), (3, 9, -0.2)],
])
def test_triangles_outside_the_screen_are_dropped(triangle):
    inside = [(1, 2, 0.1), (60, 3, 0.2), (5, 40, 0.3)]
    result = clip(corners(triangle, inside, triangle), PICTURE)
    assert result.source.tolist() == [1]


def test_nothing_is_lost_behind_the_far_plane():
    result = clip(corners([(1, 2, 0.9), (60, 3, 1.1), (5, 40, 2.0)]), PICTURE)
    assert len(result.corners) == 1
    assert quantise_depths(result.corners[..., :4], PICTURE).max() == PICTURE.depth_limit


def test_order_of_drawing_is_kept():
    small = [(1, 2, 0.1), (60, 3, 0.2), (5, 40, 0.3)]
    large = [(-1000, 10, 0.1), (1000, 20, 0.2), (30, 1000, 0.3)]
    result = clip(corners(small, large, small, large), PICTURE)
    assert np.all(np.diff(result.source) >= 0)
    assert set(result.source.tolist()) == {0, 1, 2, 3}
    assert (result.source == 0).sum() == (result.source == 2).sum() == 1
    assert (result.source == 1).sum() == (result.source == 3).sum() >= 2


def test_near_plane_cuts_at_depth_zero_with_attributes_in_step():
    one = corners([(10, 10, -0.5), (50, 10, 0.5), (10, 40, 0.5)])
    result = clip(one, PICTURE).corners
    assert len(result) == 2
    points = result.reshape(-1, 5)
    assert np.all(points[:, 2] >= 0)
    cut = points[points[:, 2] == 0]
    assert {(x, y) for x, y in cut[:, :2]} == {(30.0, 10.0), (10.0, 25.0)}
    assert np.array_equal(points[:, 4], points[:, 0])


def test_a_vertex_behind_the_eye():
    # Projected as it stands the third vertex would land below the other two; what the
    # eye sees of the triangle rises from them.
    near, far = 1.0, 10.0
    def at(x, y, distance):  # an eye with a square 64-pixel picture of 90 degrees
        z = (distance - near) * far / (far - near)
        return [32 * x + 32 * distance, 32 * y + 24 * distance, z, distance, 0.0]
    triangle = np.array([[at(-1, 1, 4), at(1, 1, 4), at(0, -3, -4)]])
    result = clip(triangle, PICTURE).corners
    assert len(result) >= 1 and result[..., 3].min() >= near - 1e-12
    pixels = result[..., :2] / result[..., 3:4]
    # Three eighths of the way to it the edges meet the near plane at (+-0.625, -0.5, 1).
    found = {tuple(p) for p in np.round(pixels.reshape(-1, 2), 9)}
    assert found == {(24, 32), (40, 32), (12, 8), (52, 8)}


coordinate = st.one_of(
    st.floats(-4 * BAND, 4 * BAND, allow_nan=False),
    st.integers(-2 * BAND, 2 * BAND).map(float),
)
depth = st.sampled_from([-0.75, -0.1, 0.0, 0.3, 0.9]) | st.floats(-1, 1)
weight = st.sampled_from([1.0, 0.125, 3.7]) | st.floats(0.01, 100)
vertex = st.builds(lambda x, y, z, w: (x * w, y * w, z * w, w, x), coordinate, coordinate, depth,
                   weight)


# Multiples of 1/64 and 1/1024, so that no share of an edge is rounded to all of it.
tame_vertex = st.builds(
    lambda x, y, z, w: (x * w / 4096, y * w / 4096, z * w / 65536, w / 64),
    st.integers(-4096, 4096), st.integers(-4096, 4096), st.integers(-1024, 1024),
    st.integers(1, 640),
)  # fmt: skip


@settings(deadline=None)
@given(tame_vertex, tame_vertex, tame_vertex, tame_vertex)
def test_neighbours_share_every_vertex_on_their_edge(a, b, c, d):
    """Clip a triangle on each side of the edge a b: the same bits appear on that edge."""
    picture = PictureFormat(8, 8)  # a narrow band: nearly everything crosses it
    # The colour marks the vertices that lie on the edge: 0 at a and b, positive elsewhere.
    one = np.array([[(*a, 0.0), (*b, 0.0), (*c, 1.0)]])
    two = np.array([[(*b, 0.0), (*a, 0.0), (*d, 1.0)]])
    left = [clip(triangle, picture).corners.reshape(-1, 5) for triangle in (one, two)]
    on_edge = [{tuple(p) for p in points[points[:, 4] == 0.0].tolist()} for points in left]
    # One of them may lie outside the screen altogether; otherwise they must agree.
    if len(left[0]) and len(left[1]):
        assert on_edge[0] == on_edge[1]


@settings(deadline=None)
@given(vertex, vertex)
def test_an_intersection_has_no_direction(a, b):
    start, end = np.array([a]), np.array([b])
    one = intersections(start, end, np.array([0.3]), np.array([-0.7]))
    two = intersections(end, start, np.array([-0.7]), np.array([0.3]))
    assert np.array_equal(one, two)


@settings(deadline=None)
@given(st.tuples(coordinate, coordinate), st.tuples(coordinate, coordinate),
       st.tuples(coordinate, coordinate))
def test_clipped_area_is_the_exact_area(a, b, c):
    triangle = corners([(*a, 0.5), (*b, 0.5), (*c, 0.5)])
    result = clip(triangle, PICTURE).corners
    expected = exact_clip_area(
        (a, b, c), Fraction(-BAND), Fraction(float(PICTURE.guard_band_end))
    )
    area = sum((polygon_area(exact(t)) for t in result[..., :2]), Fraction(0))
    if len(result):
        assert abs(area - expected) <= Fraction(1, 10**6)
    else:
        assert exact_clip_area((a, b, c), Fraction(0), Fraction(48)) == 0  # nothing on the screen


@settings(deadline=None)
@given(st.lists(st.tuples(vertex, vertex, vertex), min_size=1, max_size=8))
def test_what_comes_out_fits_the_grid(triangles):
    result = clip(np.array(triangles), PICTURE)
    assert np.all(result.corners[..., 2] >= 0.0)
    pixels = result.corners[..., :2] / result.corners[..., 3:4]
    assert np.all(pixels >= -BAND - 1e-6) and np.all(pixels <= BAND + 1e-6)
    position = quantise_positions(result.corners[..., :4], PICTURE)
    limit = BAND << PICTURE.sub_bits
    assert np.all(position >= -limit) and np.all(position < limit)


# ---- quantisation


def test_rounding_is_half_up_and_exact():
    values = np.array([-1.5, -0.5, 0.5, 1.5, 0.49999999999999994, 2.0**52 + 1, -0.50000001])
    assert round_half_up(values).tolist() == [-1, 0, 1, 2, 0, 2**52 + 1, -1]


def test_positions_snap_to_the_sub_pixel_grid():
    points = np.array([[1.0, -1.0, 0, 2.0], [1 / 512, -1 / 512, 0, 1.0], [1e9, -1e9, 0, 1.0]])
    position = quantise_positions(points, PICTURE)
    assert position.dtype == np.int32
    limit = BAND * 256
    assert position.tolist() == [[128, -128], [1, 0], [limit - 1, -limit]]


@pytest.mark.parametrize("depth_bits", [2, 16, 24, 32])
def test_depths_run_from_zero_to_one_below_the_background(depth_bits):
    picture = PictureFormat(64, 64, depth_bits=depth_bits)
    points = np.array([[0, 0, z * w, w] for z in (0, 0.5, 1, 1.1, -1e-17) for w in (1, 8)])
    limit = 2**depth_bits - 2
    expected = [0, limit // 2, limit, limit, 0]
    assert quantise_depths(points, picture)[::2].tolist() == expected
    assert quantise_depths(points, picture)[1::2].tolist() == expected


def test_colors_saturate():
    colors = np.array([-3.0, 0.49, 0.5, 254.5, 255.5, 1e6])
    assert quantise_colors(colors).tolist() == [0, 0, 1, 255, 255, 255]
