"""The datapath's picture: exact with enough fraction bits, within the bound with fewer."""

from fractions import Fraction
from itertools import product
from math import ceil

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from cardcage.golden.reference import bit_true, exact
from cardcage.golden.reference.triangle_setup import prepare, scene_fraction_bits
from cardcage.golden.specification import fixed_point
from cardcage.golden.specification.display_list import DisplayList, coordinate_bits
from cardcage.golden.specification.errors import InputError

SHIFTS = [(0, 0), (0, 1), (1, 1), (1, 2)]
NAMES = ("color", "depth", "winner")


def assert_same(one, other):
    for name in NAMES:
        assert np.array_equal(getattr(one, name), getattr(other, name)), name


@st.composite
def display_lists(draw):
    """Few random numbers, many triangles: a seed, a size and a kind."""
    random = np.random.default_rng(draw(st.integers(0, 2**32 - 1)))
    width, height = draw(st.integers(1, 40)), draw(st.integers(1, 40))
    sub_bits, depth_bits = draw(st.integers(1, 8)), draw(st.sampled_from([2, 8, 16, 24, 32]))
    limit = 1 << (coordinate_bits(width, height, sub_bits) - 1)
    count = draw(st.integers(0, 30))
    kind = draw(st.sampled_from(["anywhere", "lattice", "sliver"]))
    position = random.integers(-limit, limit, (count, 3, 2))
    if kind == "lattice":
        position = random.integers(0, 2 * max(width, height), (count, 3, 2)) << (sub_bits - 1)
    elif kind == "sliver":
        middle = (position[:, 0] + position[:, 1]) // 2
        position[:, 2] = middle + random.integers(-2, 3, (count, 2))
    depth = random.integers(0, 2**depth_bits - 1, (count, 3))
    ends = random.integers(0, 2, (count, 3)) * (2**depth_bits - 2)
    return DisplayList(
        width=width,
        height=height,
        position=np.clip(position, -limit, limit - 1).astype(np.int32),
        depth=ends if draw(st.booleans()) else depth,
        color=random.integers(0, 256, (count, 3, 3), np.uint8),
        sub_bits=sub_bits,
        depth_bits=depth_bits,
    )


@settings(deadline=None, max_examples=100)
@given(display_lists(), st.sampled_from(SHIFTS), st.sampled_from(["flat", "gouraud"]),
       st.integers(0, 6))
def test_equals_exact_with_enough_fraction_bits(display_list, shifts, shading, more):
    options = {"shading": shading, "x_shift": shifts[0], "y_shift": shifts[1]}
    enough = scene_fraction_bits(display_list, x_shift=shifts[0], y_shift=shifts[1])
    bits = min(enough + more, 64)
    assert_same(bit_true.draw(display_list, fraction_bits=bits, **options),
                exact.draw(display_list, **options))


def test_equals_exact_on_the_largest_triangles():
    """Words of more than 64 bits, on both sides of where a limb ends."""
    limit = 1 << 10
    position = np.array([
        [[-limit, -limit], [limit - 1, -limit], [-limit, limit - 1]],
        [[limit - 1, limit - 1], [limit - 1, -limit], [-limit, limit - 1]],
        [[-limit, 3], [limit - 1, 4], [-limit, 5]],
    ], np.int32) * 256  # fmt: skip
    depth = np.array([[0, 2**32 - 2, 0], [2**32 - 2, 0, 1], [2**31, 5, 2**32 - 2]])
    color = np.array([[[0, 0, 255], [255, 1, 0], [0, 9, 0]]] * 3, np.uint8)
    display_list = DisplayList(512, 512, position, depth, color, depth_bits=32)
    enough = scene_fraction_bits(display_list)
    expected = exact.draw(display_list)
    assert enough > 46
    for fraction_bits in range(enough, 65, 3):
        assert_same(bit_true.draw(display_list, fraction_bits=fraction_bits), expected)


@settings(deadline=None, max_examples=100)
@given(display_lists(), st.sampled_from(SHIFTS), st.integers(0, 24))
def test_error_stays_within_the_bound(display_list, shifts, fraction_bits):
    """Each triangle alone, so that every pixel of it can be compared."""
    for number in range(min(display_list.triangles, 5)):
        one = DisplayList(
            display_list.width, display_list.height,
            display_list.position[number:number + 1], display_list.depth[number:number + 1],
            display_list.color[number:number + 1],
            sub_bits=display_list.sub_bits, depth_bits=display_list.depth_bits,
        )  # fmt: skip
        options = {"x_shift": shifts[0], "y_shift": shifts[1]}
        expected = exact.draw(one, **options)
        got = bit_true.draw(one, fraction_bits=fraction_bits, **options)
        assert np.array_equal(got.winner, expected.winner)
        y, x = np.nonzero(expected.winner == 0)
        if not len(y):
            continue
        box = prepare(one, fraction_bits=0, **options)
        extent = x - box.left[0] + y - box.top[0]
        for pixel in range(len(y)):
            bound = ceil(fixed_point.error_bound(fraction_bits, int(extent[pixel])))
            at = y[pixel], x[pixel]
            assert abs(got.depth[at] - expected.depth[at]) <= bound
            difference = got.color[at].astype(int) - expected.color[at]
            assert abs(difference).max() <= bound
        assert (got.depth[expected.winner == 0] <= one.depth_limit).all()


def test_carried_values_are_off_by_at_most_the_bound_and_nearly_so_much():
    """Before the floor, in fractions: every pixel of many small triangles at few bits."""
    random = np.random.default_rng(1)
    worst = Fraction(0)
    for fraction_bits in (0, 1, 3, 6):
        position = random.integers(0, 12 << 2, (150, 3, 2)).astype(np.int32)
        display_list = DisplayList(12, 12, position, random.integers(0, 255, (150, 3)),
                                   np.zeros((150, 3, 3), np.uint8), sub_bits=2, depth_bits=8)
        prepared = prepare(display_list, fraction_bits=fraction_bits)
        row_of = {primitive: row for row, primitive in enumerate(prepared.primitive.tolist())}
        fragments = exact.fragments(display_list)
        planes = prepared.depth
        for primitive, x, y in zip(fragments.primitive.tolist(), fragments.x.tolist(),
                                   fragments.y.tolist(), strict=True):
            row = row_of[primitive]
            right, down = x - int(prepared.left[row]), y - int(prepared.top[row])
            word = planes.start[row] + right * planes.step_x[row] + down * planes.step_y[row]
            word %= 2**planes.word_bits
            carried = Fraction(word - (word >> (planes.word_bits - 1) << planes.word_bits),
                               2**fraction_bits)
            (x0, y0), (x1, y1), (x2, y2) = position[primitive].tolist()
            area = (x1 - x0) * (y2 - y0) - (x2 - x0) * (y1 - y0)
            px, py = 4 * x + 2 - x0, 4 * y + 2 - y0
            z0, z1, z2 = display_list.depth[primitive].tolist()
            value = (z0 + Fraction((px * (y2 - y0) - (x2 - x0) * py) * (z1 - z0)
                                   + ((x1 - x0) * py - px * (y1 - y0)) * (z2 - z0), area)
                     + Fraction(abs(area) // 2 * 2 + 1, 2 * abs(area)))
            bound = fixed_point.error_bound(fraction_bits, right + down)
            assert abs(carried - value) <= bound
            worst = max(worst, abs(carried - value) / bound)
    assert worst > Fraction(9, 10)


@pytest.mark.parametrize("fraction_bits", range(9))
def test_every_triangle_of_a_tiny_screen(fraction_bits):
    """All 46,656 triples of a lattice of half pixels about 2 x 2 pixels, every fragment."""
    lattice = np.array(list(product(range(-1, 5), repeat=2)), np.int32)
    position = lattice[np.array(list(product(range(36), repeat=3)))]
    count = len(position)
    depth = np.arange(3 * count).reshape(count, 3) * 5 % 7
    display_list = DisplayList(2, 2, position, depth, np.zeros((count, 3, 3), np.uint8),
                               sub_bits=1, depth_bits=3)
    fragments = exact.fragments(display_list)
    prepared = prepare(display_list, fraction_bits=fraction_bits)
    triangle = np.searchsorted(prepared.primitive, fragments.primitive)
    right = fragments.x - prepared.left[triangle]
    down = fragments.y - prepared.top[triangle]
    stored = bit_true.evaluate(prepared.depth, fraction_bits, triangle, right, down, 6)
    error = abs(stored - fragments.depth)
    # 2**F > D * (1 + x + y) of the fragment itself is already enough for it.
    (x0, y0), (x1, y1), (x2, y2) = (position[fragments.primitive, vertex].T for vertex in range(3))
    double_area = abs((x1 - x0) * (y2 - y0) - (x2 - x0) * (y1 - y0))
    assert not error[2**fraction_bits > double_area * (1 + right + down)].any()
    for extent in range(3):
        bound = ceil(fixed_point.error_bound(fraction_bits, extent))
        assert error[right + down == extent].max() <= bound
    assert len(fragments) > 20_000
    # D is at most 25 here and x + y at most 2: seven bits are enough, five are not.
    assert not error.any() or fraction_bits < 7
    assert error.any() or fraction_bits > 5


def test_saturates_and_never_wraps():
    """No fraction bits, a long triangle at either end of the range."""
    for depth in (0, 2**24 - 2):
        position = np.array([[[0, 0], [131000, 0], [0, 131000]]], np.int32)
        slope = np.array([[depth, abs(depth - 250), abs(depth - 250)]])
        color = np.array([[[255, 0, 3], [128, 127, 0], [128, 100, 9]]], np.uint8)
        display_list = DisplayList(512, 512, position, slope, color)
        expected = exact.draw(display_list)
        got = bit_true.draw(display_list, fraction_bits=0)
        assert np.array_equal(got.winner, expected.winner)
        drawn = expected.winner == 0
        assert got.depth[drawn].min() >= 0 and got.depth[drawn].max() <= 2**24 - 2
        bound = ceil(fixed_point.error_bound(0, 1022))
        assert abs(got.depth - expected.depth)[drawn].max() <= bound
        assert abs(got.color.astype(int) - expected.color)[drawn].max() <= min(bound, 255)
        assert (got.depth != expected.depth).any()


def test_empty_list_and_bad_input():
    display_list = DisplayList(4, 4, np.zeros((0, 3, 2), np.int32), np.zeros((0, 3), np.int64),
                               np.zeros((0, 3, 3), np.uint8))
    assert (bit_true.draw(display_list, fraction_bits=8).winner == -1).all()
    for fraction_bits in (-1, 65):
        with pytest.raises(InputError, match="fraction bits"):
            bit_true.draw(display_list, fraction_bits=fraction_bits)
