"""Set-up: what a machine steps equals the exact picture, within the stated widths."""

from fractions import Fraction

import numpy as np
import pytest
from edge_steps import carried_columns, stepped_columns

from cardcage.golden.reference import exact
from cardcage.golden.reference.triangle_setup import (
    Edges,
    carry_edges,
    color_word_bits,
    depth_word_bits,
    prepare,
    scene_fraction_bits,
)
from cardcage.golden.specification.display_list import DisplayList, coordinate_bits
from cardcage.golden.specification.errors import InputError
from cardcage.golden.specification.fixed_point import to_signed
from cardcage.golden.specification.widths import (
    edge_column_bits,
    edge_fraction_bits,
    edge_height_bits,
    fewest_edge_fraction_bits,
)

SHIFTS = [(0, 0), (0, 1), (1, 1), (1, 2), (2, 2)]


def random_list(seed, count=40):
    """Sizes, sub-pixel bits and kinds of triangles all random, the guard band included."""
    random = np.random.default_rng(seed)
    width, height = (int(size) for size in random.integers(1, 24, 2))
    sub_bits = int(random.integers(1, 9))
    limit = 1 << (coordinate_bits(width, height, sub_bits) - 1)
    anywhere = random.integers(-limit, limit, (count, 3, 2))
    lattice = random.integers(0, 2 * max(width, height), (count, 3, 2)) << (sub_bits - 1)
    small = anywhere[:, :1] // 4 + random.integers(-(2**sub_bits), 2**sub_bits, (count, 3, 2))
    kind = random.integers(0, 3, count)
    position = np.choose(kind[:, None, None], [anywhere, lattice, small])
    depth_bits = int(random.integers(2, 33))
    return DisplayList(
        width=width,
        height=height,
        position=np.clip(position, -limit, limit - 1).astype(np.int32),
        depth=random.integers(0, 2**depth_bits - 1, (count, 3)),
        color=random.integers(0, 256, (count, 3, 3), np.uint8),
        sub_bits=sub_bits,
        depth_bits=depth_bits,
    )


def spans_of(prepared, triangle, bits):
    """(row, first, beyond) from the three edges."""
    top, middle, bottom = (int(getattr(prepared, name)[triangle])
                           for name in ("top", "middle", "bottom"))
    long = stepped_columns(prepared.long, triangle, bottom - top, bits)
    short = stepped_columns(prepared.upper, triangle, middle - top, bits)
    short += stepped_columns(prepared.lower, triangle, bottom - middle, bits)
    low, high = int(prepared.left[triangle]), int(prepared.right[triangle])
    for row, one, other in zip(range(top, bottom), long, short, strict=True):
        first, beyond = (one, other) if prepared.long_edge_left[triangle] else (other, one)
        yield row, first, beyond, max(first, low), min(beyond, high)


@pytest.mark.parametrize("seed", range(30))
def test_stepped_edges_cover_exactly(seed):
    display_list = random_list(seed)
    x_shift, y_shift = SHIFTS[seed % len(SHIFTS)]
    bits = edge_column_bits(display_list.coordinate_bits, display_list.sub_bits)
    prepared = prepare(display_list, fraction_bits=0, x_shift=x_shift, y_shift=y_shift)
    covered = set()
    for triangle, primitive in enumerate(prepared.primitive.tolist()):
        for row, first, beyond, held_first, held_beyond in spans_of(prepared, triangle, bits):
            screen = range(max(first, 0), min(beyond, prepared.grid.width))
            assert list(screen) == list(range(held_first, held_beyond)), "the box cuts pixels off"
            covered |= {(primitive, column, row) for column in screen}
    fragments = exact.fragments(display_list, x_shift=x_shift, y_shift=y_shift)
    expected = set(zip(*(getattr(fragments, name).tolist() for name in ("primitive", "x", "y")),
                       strict=True))
    assert covered == expected


@pytest.mark.parametrize("seed", range(30))
def test_planes_are_rounded_and_wrapped(seed):
    """Start and increments are the rational ones to half a unit of 2**-F, modulo the word."""
    display_list = random_list(seed + 100, count=10)
    fraction_bits = seed * 2
    prepared = prepare(display_list, fraction_bits=fraction_bits)
    size = display_list.width, display_list.height
    assert prepared.depth.word_bits == depth_word_bits(display_list.depth_bits, fraction_bits,
                                                       *size)
    channels = [(prepared.depth, display_list.depth)]
    channels += [(planes, display_list.color[:, :, channel].astype(np.int64))
                 for channel, planes in enumerate(prepared.color)]
    assert channels[1][0].word_bits == color_word_bits(fraction_bits, *size)
    unit = 1 << display_list.sub_bits
    for triangle, primitive in enumerate(prepared.primitive.tolist()):
        (x0, y0), (x1, y1), (x2, y2) = display_list.position[primitive].tolist()
        area = (x1 - x0) * (y2 - y0) - (x2 - x0) * (y1 - y0)
        x = int(prepared.left[triangle]) * unit + unit // 2 - x0
        y = int(prepared.top[triangle]) * unit + unit // 2 - y0
        for planes, values in channels:
            v0, v1, v2 = values[primitive].tolist()
            slope_x = Fraction((v1 - v0) * (y2 - y0) - (v2 - v0) * (y1 - y0), area)
            slope_y = Fraction((v2 - v0) * (x1 - x0) - (v1 - v0) * (x2 - x0), area)
            doubled = 2 * abs(area)
            carried = v0 + slope_x * x + slope_y * y + Fraction(abs(area) // 2 * 2 + 1, doubled)
            for stored, value in ((planes.start, carried), (planes.step_x, slope_x * unit),
                                  (planes.step_y, slope_y * unit)):
                rounded = (value * 2**fraction_bits + Fraction(1, 2)).__floor__()
                assert type(stored[triangle]) is int
                assert stored[triangle] == rounded % 2**planes.word_bits


@pytest.mark.parametrize("shifts", SHIFTS)
def test_numbers_fit_the_stated_widths(shifts):
    """Guard-band extremes: edges along the whole range, steep, shallow and one unit high."""
    for sub_bits in (1, 2, 8):
        limit = 1 << (coordinate_bits(20, 20, sub_bits) - 1)
        ends = [-limit, -limit + 1, 0, 1, limit - 2, limit - 1]
        corners = np.array([[x, y] for x in ends for y in ends])
        random = np.random.default_rng(sub_bits)
        position = corners[random.integers(0, len(corners), (2000, 3))].astype(np.int32)
        display_list = DisplayList(20, 20, position, np.zeros((2000, 3), np.int64),
                                   np.zeros((2000, 3, 3), np.uint8), sub_bits=sub_bits)
        prepared = prepare(display_list, fraction_bits=0, x_shift=shifts[0], y_shift=shifts[1])
        remainder_limit = 1 << edge_height_bits(display_list.coordinate_bits)
        column_limit = 1 << (edge_column_bits(display_list.coordinate_bits, sub_bits) - 1)
        parts = ((prepared.long, prepared.top, prepared.bottom),
                 (prepared.upper, prepared.top, prepared.middle),
                 (prepared.lower, prepared.middle, prepared.bottom))
        for edges, begin, end in parts:
            used = end > begin
            assert ((edges.remainder >= 0) & (edges.remainder < edges.denominator)).all()
            assert ((edges.remainder_step >= 0) & (edges.remainder_step < edges.denominator)).all()
            assert (edges.denominator < remainder_limit).all()
            last = np.maximum(end - begin - 1, 0)
            steps = (edges.remainder + last * edges.remainder_step) // edges.denominator
            for column in (edges.column, edges.column + last * edges.column_step + steps):
                assert ((column >= -column_limit) & (column < column_limit))[used].all()
            unused = [edges.column, edges.remainder, edges.column_step, edges.remainder_step]
            assert all((part[~used] == 0).all() for part in unused)
            assert (edges.denominator[~used] == 1).all()


def test_what_cannot_cover_a_pixel_is_left_out():
    position = np.array([
        [[0, 0], [256, 0], [0, 256]],  # covers the first pixel
        [[0, 0], [512, 512], [1024, 1024]],  # no area
        [[129, 129], [380, 129], [129, 380]],  # between centres
        [[-512, 0], [-256, 0], [-512, 512]],  # left of the screen
        [[0, 1024], [256, 1024], [0, 1300]],  # below it
        [[256, 256], [1024, 256], [256, 1024]],
    ], np.int32)  # fmt: skip
    display_list = DisplayList(4, 4, position, np.zeros((6, 3), np.int64),
                               np.zeros((6, 3, 3), np.uint8))
    prepared = prepare(display_list, fraction_bits=4)
    assert prepared.primitive.tolist() == [0, 5]
    assert prepared.primitive.dtype == np.int32
    assert len(prepared) == 2


def test_flat_shading_takes_the_first_vertex():
    display_list = random_list(3)
    prepared = prepare(display_list, fraction_bits=4, shading="flat")
    assert prepared.color is None
    assert np.array_equal(prepared.flat_color, display_list.color[prepared.primitive, 0])


def test_words_are_as_wide_at_every_resolution():
    """A machine that lost memory units keeps the registers it was built with."""
    position = np.array([[[0, 0], [131000, 0], [0, 131000]]], np.int32)
    display_list = DisplayList(512, 512, position, np.zeros((1, 3), np.int64),
                               np.zeros((1, 3, 3), np.uint8))
    for shifts in SHIFTS:
        prepared = prepare(display_list, fraction_bits=0, x_shift=shifts[0], y_shift=shifts[1])
        # 256 + (1 + 1022) / 2 + 1 needs a third guard bit; a quarter of the pixels would not.
        assert [planes.word_bits for planes in prepared.color] == [8 + 3] * 3
        assert prepared.depth.word_bits == 24 + 2


def test_scene_fraction_bits_are_those_of_the_worst_triangle():
    position = np.array([[[0, 0], [1024, 0], [0, 1024]], [[0, 0], [300, 0], [0, 300]]], np.int32)
    display_list = DisplayList(8, 8, position, np.zeros((2, 3), np.int64),
                               np.zeros((2, 3, 3), np.uint8))
    # Columns 0 … 3 and rows 0 … 3: x + y is 6 at the far corner.
    assert scene_fraction_bits(display_list) == (1024 * 1024 * 7).bit_length()
    assert scene_fraction_bits(display_list, x_shift=1, y_shift=2) == (1024 * 1024 * 2).bit_length()


def test_empty_list():
    display_list = DisplayList(4, 4, np.zeros((0, 3, 2), np.int32), np.zeros((0, 3), np.int64),
                               np.zeros((0, 3, 3), np.uint8))
    assert len(prepare(display_list, fraction_bits=4)) == 0
    assert scene_fraction_bits(display_list) == 0


@pytest.mark.parametrize(("arguments", "word"), [
    ({"fraction_bits": 65}, "fraction bits"),
    ({"fraction_bits": -1}, "fraction bits"),
    ({"fraction_bits": 4, "shading": "phong"}, "shading"),
    ({"fraction_bits": 4, "x_shift": 1}, "resolution"),
    ({"fraction_bits": 4, "y_shift": 2}, "resolution"),
    ({"fraction_bits": 4, "x_shift": -1, "y_shift": -1}, "resolution"),
])  # fmt: skip
def test_bad_input(arguments, word):
    with pytest.raises(InputError, match=word):
        prepare(random_list(0), **arguments)


@pytest.mark.parametrize("seed", range(30))
def test_carried_edges_are_exact(seed):
    """Every column of every edge, sliver or not, guard band included."""
    display_list = random_list(seed)
    x_shift, y_shift = SHIFTS[seed % len(SHIFTS)]
    bits = edge_column_bits(display_list.coordinate_bits, display_list.sub_bits)
    fraction_bits = edge_fraction_bits(edge_height_bits(display_list.coordinate_bits),
                                       display_list.height)
    prepared = prepare(display_list, fraction_bits=0, x_shift=x_shift, y_shift=y_shift)
    rows = {"long": prepared.bottom - prepared.top, "upper": prepared.middle - prepared.top,
            "lower": prepared.bottom - prepared.middle}
    for name, counts in rows.items():
        edges = getattr(prepared, name)
        carried = carry_edges(edges, column_bits=bits, fraction_bits=fraction_bits)
        for triangle, count in enumerate(counts.tolist()):
            assert (carried_columns(carried, triangle, count, bits)
                    == stepped_columns(edges, triangle, count, bits))


def every_edge(height):
    """All remainders and steps of all denominators up to ``height``, some columns."""
    return Edges(*(np.array(numbers) for numbers in zip(*(
        (column, remainder, column_step, remainder_step, denominator)
        for denominator in range(1, height + 1)
        for remainder in range(denominator) for remainder_step in range(denominator)
        for column, column_step in ((0, 0), (-3, 1), (2, -1))), strict=True)))


@pytest.mark.parametrize("remainder_bits", range(1, 5))
@pytest.mark.parametrize("rows", [1, 2, 3, 7, 8])
def test_carried_edges_of_small_heights_exhaustively(remainder_bits, rows):
    column_bits = 6
    edges = every_edge((1 << remainder_bits) - 1)
    enough = edge_fraction_bits(remainder_bits, rows)
    carried = carry_edges(edges, column_bits=column_bits, fraction_bits=enough)
    for index in range(len(edges.column)):
        assert (carried_columns(carried, index, rows, column_bits)
                == stepped_columns(edges, index, rows, column_bits))


def wrong_columns(edges, rows, fraction_bits):
    """Of all edges and rows at once; columns of six bits."""
    carried = carry_edges(edges, column_bits=6, fraction_bits=fraction_bits)
    row = np.arange(rows)[:, None]
    columns = to_signed((carried.start + row * carried.step) >> fraction_bits, 6)
    exact_columns = edges.column + row * edges.column_step + (
        edges.remainder + row * edges.remainder_step) // edges.denominator
    return int((columns != to_signed(exact_columns, 6)).sum())


HEIGHTS = range(1, 34)


@pytest.mark.parametrize("rows", [*range(1, 10), 15, 16, 17, 32, 33])
def test_the_fewest_fraction_bits_of_an_edge_exhaustively(rows):
    """Each height alone, all its remainders and steps.  With one bit less some edge of most
    heights goes wrong; of powers of two on their only row all that are two units high or more."""
    edges = every_edge(HEIGHTS[-1])
    too_few = []
    for height in HEIGHTS:
        of_height = edges.denominator == height
        here = Edges(*(part[of_height] for part in vars(edges).values()))
        bits = fewest_edge_fraction_bits(height, height * rows)
        assert 1 << bits >= height * rows and 1 << bits > height
        assert wrong_columns(here, rows, bits) == 0
        assert wrong_columns(here, rows, bits + 1) == 0
        if bits and wrong_columns(here, rows, bits - 1):
            too_few.append(height)
    assert len(too_few) > len(HEIGHTS) // 2
    if rows == 1:
        assert too_few == list(HEIGHTS)


@pytest.mark.parametrize("height", [1, 2, 3, 4, 5, 8, 9, 16, 17])
@pytest.mark.parametrize("rows", [1, 2, 3, 4, 6, 8, 9])
def test_fraction_bits_for_edges_together(height, rows):
    """All heights up to one, each followed down as many rows as the greatest product allows."""
    edges = every_edge(height)
    for product in range(1, height * rows + 1):
        bits = fewest_edge_fraction_bits(height, product)
        for denominator in range(1, min(height, product) + 1):
            of_height = edges.denominator == denominator
            here = Edges(*(part[of_height] for part in vars(edges).values()))
            assert wrong_columns(here, product // denominator, bits) == 0


def test_carried_edges_need_their_fraction_bits():
    """With two bits less some edge goes wrong: the width is no luxury."""
    rows, remainder_bits, column_bits = 8, 4, 6
    edges = every_edge((1 << remainder_bits) - 1)
    fewer = edge_fraction_bits(remainder_bits, rows) - 2
    carried = carry_edges(edges, column_bits=column_bits, fraction_bits=fewer)
    assert any(carried_columns(carried, index, rows, column_bits)
               != stepped_columns(edges, index, rows, column_bits)
               for index in range(len(edges.column)))
