"""The reference picture against a brute-force rasteriser in rational numbers, and by hand."""

from fractions import Fraction
from math import floor

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from cardcage.golden.hard_cases.rational import covered, mean, round_half_up
from cardcage.golden.reference import exact
from cardcage.golden.specification.display_list import DisplayList, coordinate_bits
from cardcage.golden.specification.errors import InputError
from cardcage.golden.specification.sampling_grid import Grid

SHIFTS = [(0, 0), (0, 1), (1, 1), (1, 2), (2, 2), (2, 3)]


def brute_force(display_list, x_shift=0, y_shift=0):
    """{(primitive, x, y): (depth, red, green, blue)} and the size, pixel by pixel, in fractions."""
    grid = Grid.of(display_list, x_shift, y_shift)
    found = {}
    for primitive in range(display_list.triangles):
        values = [display_list.depth[primitive].tolist(),
                  *display_list.color[primitive].T.tolist()]
        for (x, y), weights in covered(display_list.position[primitive].tolist(), grid):
            found[primitive, x, y] = tuple(round_half_up(mean(value, weights)) for value in values)
    return found, grid.width, grid.height


def as_dictionary(fragments):
    return {(int(p), int(x), int(y)): (int(d), *map(int, c)) for p, x, y, d, c in
            zip(fragments.primitive, fragments.x, fragments.y, fragments.depth, fragments.color,
                strict=True)}


def check(display_list, x_shift=0, y_shift=0, **limits):
    """Fragments, picture and depth complexity equal brute force; gives the fragments."""
    expected, width, height = brute_force(display_list, x_shift, y_shift)
    shifts = {"x_shift": x_shift, "y_shift": y_shift}
    fragments = exact.fragments(display_list, shading="gouraud", **shifts)
    assert as_dictionary(fragments) == expected
    order = list(zip(fragments.primitive, fragments.y, fragments.x, strict=True))
    assert order == sorted(order)
    picture = exact.draw(display_list, shading="gouraud", **shifts, **limits)
    complexity = exact.depth_complexity(display_list, **shifts)
    assert complexity.dtype == np.int32 and complexity.shape == (height, width)
    nothing = (2**display_list.depth_bits - 1, -1, *display_list.background)
    for y in range(height):
        for x in range(width):
            here = [(value[0], key[0], *value[1:]) for key, value in expected.items()
                    if key[1:] == (x, y)]
            got = (picture.depth[y, x], picture.winner[y, x], *picture.color[y, x])
            assert got == min(here, default=nothing)
            assert complexity[y, x] == len(here)
    return expected


def make(position, width=8, height=8, depth=None, color=None, **rest):
    """Triangles given in whole numbers of sub-pixel units."""
    position = np.array(position, np.int32).reshape(-1, 3, 2)
    count = len(position)
    random = np.random.default_rng(count)
    depth_bits = rest.get("depth_bits", 24)
    if depth is None:
        depth = random.integers(0, 2**depth_bits - 1, (count, 3))
    if color is None:
        color = random.integers(0, 256, (count, 3, 3))
    return DisplayList(width, height, position, np.array(depth, np.int64).reshape(-1, 3),
                       np.array(color, np.uint8).reshape(-1, 3, 3), **rest)


@st.composite
def display_lists(draw):
    width, height = draw(st.integers(1, 9)), draw(st.integers(1, 9))
    sub_bits = draw(st.integers(1, 8))
    depth_bits = draw(st.sampled_from([2, 3, 8, 24, 32]))
    limit = 1 << (coordinate_bits(width, height, sub_bits) - 1)
    half = 1 << (sub_bits - 1)
    coordinate = st.one_of(
        st.integers(-limit, limit - 1),  # off the screen, the guard band
        st.integers(-1, 2 * max(width, height)).map(lambda n: n * half),  # corners and centres
        st.sampled_from([-limit, limit - 1, 0, half, half - 1, half + 1]),
    )
    point = st.tuples(coordinate, coordinate)
    corners = draw(st.lists(point, min_size=3, max_size=7))
    index = st.integers(0, len(corners) - 1)  # few corners: shared edges, no area, duplicates
    triangles = draw(st.lists(st.tuples(index, index, index), max_size=5))
    depths = st.sampled_from([0, 1, 2**depth_bits - 2]) | st.integers(0, 2**depth_bits - 2)
    channels = st.integers(0, 255)
    count = len(triangles)
    return make(
        [[corners[i] for i in triangle] for triangle in triangles],
        width,
        height,
        draw(st.lists(depths, min_size=3 * count, max_size=3 * count)),
        draw(st.lists(channels, min_size=9 * count, max_size=9 * count)),
        sub_bits=sub_bits,
        depth_bits=depth_bits,
        background=(1, 2, 3),
    )


@settings(deadline=None, max_examples=120)
@given(display_lists(), st.sampled_from(SHIFTS), st.integers(1, 40), st.integers(1, 12))
def test_random_lists_equal_brute_force(display_list, shifts, fragment_limit, row_limit):
    check(display_list, *shifts, fragment_limit=fragment_limit, row_limit=row_limit)


@settings(deadline=None, max_examples=60)
@given(st.data())
def test_slivers_equal_brute_force(data):
    """A long edge and a third vertex a few sub-pixel units off it."""
    end = st.integers(-300, 2300)
    a, b = data.draw(st.tuples(end, end)), data.draw(st.tuples(end, end))
    offset = st.integers(-3, 3)
    share = data.draw(st.integers(0, 16))
    c = [(s * share + e * (16 - share)) // 16 + data.draw(offset)
         for s, e in zip(a, b, strict=True)]
    check(make([[a, b, c], [c, b, a]]))


@pytest.mark.parametrize(("corners", "pixels"), [
    # In pixels.  A square's halves: the diagonal's centres go to the one it bounds on the left.
    ([(0, 0), (3, 0), (3, 3)], {(0, 0), (1, 0), (2, 0), (1, 1), (2, 1), (2, 2)}),
    ([(0, 0), (3, 3), (0, 3)], {(0, 1), (0, 2), (1, 2)}),
    # Vertices on centres: left and top edge drawn, right and bottom not.
    ([(0.5, 0.5), (2.5, 0.5), (0.5, 2.5)], {(0, 0), (1, 0), (0, 1)}),
    ([(2.5, 2.5), (2.5, 0.5), (0.5, 2.5)], {(1, 1)}),
    # An apex on a centre lies on a right edge as well, so it is not drawn.
    ([(1.5, 0.5), (3.5, 2.5), (-0.5, 2.5)], {(0, 1), (1, 1)}),
    # A level top edge through centres belongs, a level bottom edge does not.
    ([(0, 1.5), (4, 1.5), (2, 3.5)], {(0, 1), (1, 1), (2, 1), (3, 1), (1, 2), (2, 2)}),
    ([(0, 3.5), (4, 3.5), (2, 1.5)], {(1, 2), (2, 2)}),
    # Between centres, and no area.
    ([(0.6, 0.6), (1.4, 0.6), (0.6, 1.4)], set()),
    ([(0, 0), (2, 2), (4, 4)], set()),
    # All vertices off the screen, and the whole of it covered.
    ([(-7, -1), (7, -1), (2, 7)], {(x, y) for x in range(4) for y in range(4)}),
    # Wholly outside.
    ([(-4, 0), (-1, 0), (-4, 4)], set()),
    ([(5, 0), (7, 0), (5, 4)], set()),
])  # fmt: skip
def test_hand_written_pixels(corners, pixels):
    position = [[int(c * 256) for c in corner] for corner in corners]
    for winding in (position, position[::-1], position[1:] + position[:1]):
        display_list = make([winding], 4, 4)
        fragments = exact.fragments(display_list)
        assert set(zip(fragments.x.tolist(), fragments.y.tolist(), strict=True)) == pixels
        check(display_list)


@settings(deadline=None, max_examples=80)
@given(st.lists(st.tuples(st.integers(-8, 40), st.integers(-8, 40)), min_size=3, max_size=9),
       st.tuples(st.integers(-8, 40), st.integers(-8, 40)), st.sampled_from(SHIFTS[:4]))
def test_triangulated_polygon_is_covered_once(ring, hub, shifts):
    """A convex polygon cut from two different corners, or from a point inside: the same, once."""
    points = sorted(set(ring))
    hull = []
    for sequence in (points, points[::-1]):  # Andrew's monotone chain
        chain = []
        for x, y in sequence:
            while len(chain) > 1 and ((chain[-1][0] - chain[-2][0]) * (y - chain[-2][1])
                                      <= (chain[-1][1] - chain[-2][1]) * (x - chain[-2][0])):
                chain.pop()
            chain.append((x, y))
        hull += chain[:-1]
    fans = [[(hull[0], hull[i], hull[i + 1]) for i in range(1, len(hull) - 1)],
            [(hull[-1], hull[i], hull[i + 1]) for i in range(len(hull) - 2)]]
    sides = list(zip(hull, hull[1:] + hull[:1], strict=True))
    if all((b[0] - a[0]) * (hub[1] - a[1]) >= (b[1] - a[1]) * (hub[0] - a[0]) for a, b in sides):
        fans.append([(hub, a, b) for a, b in sides])
    images = [exact.depth_complexity(make([[(8 * x, 8 * y) for x, y in corners]
                                           for corners in fan], sub_bits=5),
                                     x_shift=shifts[0], y_shift=shifts[1]) for fan in fans]
    for image in images:
        assert image.max() <= 1
        assert np.array_equal(image, images[0])


@pytest.mark.parametrize("depths", [
    [(0, 2**32 - 2, 0), (2**32 - 2, 0, 1)],
    [(2**32 - 2,) * 3, (2**32 - 2, 2**32 - 2, 2**32 - 3)],
    [(2**19 + 10,) * 3, (2**19 + 10,) * 3],  # just past 63 bits
])  # fmt: skip
def test_extreme_triangle_does_not_overflow(depths):
    """Area and depth at both ends of their ranges: 2N + D needs 77 bits."""
    limit = 1 << 21
    # The two halves of the coordinate range; no pixel below is on the diagonal.
    corners = [(-limit, -limit), (limit - 1, -limit), (limit - 1, limit - 1)]
    other = [(-limit, limit - 1), (-limit, -limit), (limit - 1, limit - 1)]
    display_list = make([corners, other], 4096, 4096, depth=depths, depth_bits=32)
    area = (2 * limit - 1) ** 2
    assert area * max(map(max, depths)) >= 2**63
    for x, y in ((1, 0), (4095, 0), (4095, 4094), (17, 1234), (0, 4095), (1500, 4000)):
        fragments = exact.fragments(display_list, pixel=(x, y))
        expected = {}
        for primitive, triangle in enumerate((corners, other)):
            (x0, y0), (x1, y1), (x2, y2) = triangle
            whole = (x1 - x0) * (y2 - y0) - (x2 - x0) * (y1 - y0)
            px, py = 256 * x + 128 - x0, 256 * y + 128 - y0
            second = Fraction(px * (y2 - y0) - (x2 - x0) * py, whole)
            third = Fraction((x1 - x0) * py - px * (y1 - y0), whole)
            weights = 1 - second - third, second, third
            if min(weights) >= 0:
                expected[primitive] = floor(
                    sum(w * d for w, d in zip(weights, depths[primitive], strict=True))
                    + Fraction(1, 2))
        assert dict(zip(fragments.primitive.tolist(), fragments.depth.tolist(),
                        strict=True)) == expected
        assert list(expected) == [int(y > x)]


def test_both_forms_of_depth_agree():
    """One plane where it fits 63 bits, two halves where not: the same on a list with both."""
    random = np.random.default_rng(0)
    position = random.integers(-2000, 6000, (50, 3, 2))
    depth = random.integers(0, 2**32 - 1, (50, 3))
    small = make(position, 16, 16, depth=depth, depth_bits=32)
    giant = [(-(1 << 21), -(1 << 21)), ((1 << 21) - 1, -(1 << 21)), (-(1 << 21), (1 << 21) - 1)]
    mixed = make(np.concatenate([position, [giant]]), 4096, 4096,
                 depth=np.concatenate([depth, np.full((1, 3), 2**32 - 2)]), depth_bits=32)
    one, two = exact.draw(small), exact.draw(mixed)
    drawn = one.winner >= 0
    assert np.array_equal(one.depth[drawn], two.depth[:16, :16][drawn])
    assert np.array_equal(one.winner[drawn], two.winner[:16, :16][drawn])
    assert (two.winner[:16, :16][~drawn] == 50).all()


def test_chunks_do_not_change_the_picture():
    random = np.random.default_rng(5)
    display_list = make(random.integers(-8000, 24000, (60, 3, 2)), 64, 48)
    whole = exact.draw(display_list)
    assert exact.depth_complexity(display_list).sum() > 5000
    for fragment_limit, row_limit in ((1, 1 << 20), (1 << 20, 1), (64, 100), (777, 13)):
        part = exact.draw(display_list, fragment_limit=fragment_limit, row_limit=row_limit)
        for name in ("color", "depth", "winner"):
            assert np.array_equal(getattr(part, name), getattr(whole, name))


def test_fragments_at_a_pixel():
    random = np.random.default_rng(6)
    display_list = make(random.integers(-500, 2500, (40, 3, 2)))
    everything = as_dictionary(exact.fragments(display_list))
    for x in range(8):
        for y in range(8):
            here = as_dictionary(exact.fragments(display_list, pixel=(x, y)))
            assert here == {key: value for key, value in everything.items() if key[1:] == (x, y)}
    for pixel in ((-1, 0), (8, 0), (0, 8)):
        with pytest.raises(InputError, match="pixel"):
            exact.fragments(display_list, pixel=pixel)


def test_earlier_primitive_keeps_a_tie_and_depth_decides_otherwise():
    square = [(0, 0), (4095, 0), (0, 4095)]
    display_list = make([square] * 4, depth=[[9] * 3, [5] * 3, [5] * 3, [7] * 3])
    picture = exact.draw(display_list)
    assert (picture.winner == 1).all() and (picture.depth == 5).all()


def test_flat_shading_takes_the_first_vertex():
    display_list = make([[(0, 0), (4095, 0), (0, 4095)]], color=[[9, 8, 7], [0, 0, 0], [1, 1, 1]])
    assert (exact.draw(display_list, shading="flat").color == [9, 8, 7]).all()
    assert not (exact.draw(display_list).color == [9, 8, 7]).all()
    with pytest.raises(InputError, match="shading"):
        exact.draw(display_list, shading="phong")


def test_empty_list_and_nothing_on_screen():
    for position in ([], [[(0, 0), (9, 9), (18, 18)]], [[(-512, 0), (-256, 0), (-512, 512)]]):
        display_list = make(position, background=(4, 5, 6))
        picture = exact.draw(display_list)
        assert (picture.winner == -1).all() and (picture.depth == 2**24 - 1).all()
        assert (picture.color == [4, 5, 6]).all()
        assert (picture.color.dtype, picture.depth.dtype, picture.winner.dtype) == (
            np.uint8, np.int64, np.int32)  # fmt: skip
        assert len(exact.fragments(display_list)) == 0
        assert len(exact.fragments(display_list, pixel=(0, 0))) == 0
        assert not exact.depth_complexity(display_list).any()


def test_many_small_triangles_and_one_giant():
    """The giant forces the wide integers; the small ones are drawn alike either way."""
    random = np.random.default_rng(8)
    centre = random.integers(0, 512 * 256, (3000, 1, 2))
    position = centre + random.integers(-400, 400, (3000, 3, 2))
    giant = [[(-250000, -250000), (250000, -250000), (-250000, 250000)]]
    depth = random.integers(0, 2**20, (3000, 3))
    small = exact.draw(make(position, 512, 512, depth=depth))
    both = exact.draw(make(np.concatenate([position, giant]), 512, 512,
                           depth=np.concatenate([depth, np.full((1, 3), 2**24 - 2)])))
    drawn = small.winner >= 0
    assert drawn.sum() > 2000
    assert np.array_equal(small.depth[drawn], both.depth[drawn])
    assert np.array_equal(small.winner[drawn], both.winner[drawn])
