"""Triangles at the ends of every range: the models do not overflow, and the widths are tight."""

from fractions import Fraction
from itertools import combinations, product
from math import floor

import numpy as np
import pytest
from edge_steps import carried_columns, stepped_columns

from cardcage.golden.reference import bit_true, exact
from cardcage.golden.reference.coverage import Triangles
from cardcage.golden.reference.triangle_setup import (
    Planes,
    carry_edges,
    color_word_bits,
    depth_word_bits,
    prepare,
    scene_fraction_bits,
)
from cardcage.golden.specification import fixed_point
from cardcage.golden.specification.display_list import DisplayList, coordinate_bits
from cardcage.golden.specification.sampling_grid import Grid
from cardcage.golden.specification.widths import (
    edge_column_bits,
    edge_fraction_bits,
    edge_height_bits,
)

FARTHEST = 2**32 - 2


def listed(position, depth, width, height=None, **rest):
    position = np.array(position, np.int32).reshape(-1, 3, 2)
    color = np.zeros((len(position), 3, 3), np.uint8)
    color[:] = [[0, 255, 9], [255, 0, 8], [255, 255, 7]]
    return DisplayList(width, height or width, position, np.array(depth, np.int64).reshape(-1, 3),
                       rest.pop("color", color), **rest)


def rational(display_list, primitive, x, y):
    """Depth of a covered pixel, by barycentric weights in fractions."""
    (x0, y0), (x1, y1), (x2, y2) = display_list.position[primitive].tolist()
    z0, z1, z2 = display_list.depth[primitive].tolist()
    unit = 1 << display_list.sub_bits
    px, py = x * unit + unit // 2 - x0, y * unit + unit // 2 - y0
    area = (x1 - x0) * (y2 - y0) - (x2 - x0) * (y1 - y0)
    second = Fraction(px * (y2 - y0) - (x2 - x0) * py, area)
    third = Fraction((x1 - x0) * py - px * (y1 - y0), area)
    assert min(1 - second - third, second, third) >= 0
    return floor(z0 + second * (z1 - z0) + third * (z2 - z0) + Fraction(1, 2))


def in_int64(display_list, primitive, x, y, doubled):
    """The same from the formula as it stands, in int64: (2N + D) / 2D or (N + D/2) / D."""
    (x0, y0), (x1, y1), (x2, y2) = display_list.position[primitive].astype(np.int64)
    z = display_list.depth[primitive]
    unit = 1 << display_list.sub_bits
    px, py = x * unit + unit // 2, y * unit + unit // 2
    area = (x1 - x0) * (y2 - y0) - (x2 - x0) * (y1 - y0)
    weights = np.array([(x1 - px) * (y2 - py) - (x2 - px) * (y1 - py),
                        (x2 - px) * (y0 - py) - (x0 - px) * (y2 - py),
                        (x0 - px) * (y1 - py) - (x1 - px) * (y0 - py)]) * np.sign(area)
    numerator, area = (weights * z).sum(keepdims=True), abs(area)
    return int(((2 * numerator + area) // (2 * area) if doubled
                else (numerator + area // 2) // area)[0])


def extreme_lists(size):
    """One triangle each: over the guard band's corners, whole and nearly, with extreme depths."""
    limit = 1 << (coordinate_bits(size, size, 8) - 1)
    low, high = -limit, limit - 1
    random = np.random.default_rng(size)
    corners = [[low, low], [low, high], [high, low], [high, high]]
    for triple in combinations(corners, 3):
        for depth in product([0, FARTHEST], [0, 1, FARTHEST], [FARTHEST, FARTHEST // 2]):
            yield listed([triple], [depth], size, depth_bits=32)
    for _ in range(8):
        away = random.integers(0, limit // 8, (3, 2)) * [[1, -1], [-1, 1], [-1, -1]]
        yield listed([np.array(corners[1:]) + away], [random.integers(0, FARTHEST, 3)], size,
                     depth_bits=32)


def test_every_pixel_of_extreme_triangles():
    """64 x 64 pixels are enough for 2b + d + 1 = 65 bits."""
    checked = overflowed = 0
    for display_list in extreme_lists(64):
        assert 2 * display_list.coordinate_bits + display_list.depth_bits + 1 > 63
        fragments = exact.fragments(display_list)
        triangles = Triangles.of(display_list, Grid.of(display_list))
        numerator_limit = abs(int(triangles.double_area[0])) * (int(display_list.depth.max()) + 1)
        assert exact._Depth(display_list, triangles).whole == (numerator_limit < 2**63)
        pixels = list(zip(fragments.x.tolist(), fragments.y.tolist(), strict=True))
        for (x, y), depth in list(zip(pixels, fragments.depth.tolist(), strict=True))[::7]:
            right = rational(display_list, 0, x, y)
            assert depth == right
            overflowed += in_int64(display_list, 0, x, y, doubled=True) != right
            checked += 1
        enough = scene_fraction_bits(display_list)
        picture = bit_true.draw(display_list, fraction_bits=enough)
        assert np.array_equal(picture.depth[fragments.y, fragments.x], fragments.depth)
        expected = exact.draw(display_list)
        assert np.array_equal(picture.color, expected.color)
        assert np.array_equal(expected.depth, picture.depth)
    print(f"{checked} pixels; (2N + D) / 2D in int64 is wrong at {overflowed}")
    assert checked > 5000 and overflowed > checked // 3


@pytest.mark.parametrize("doubled", [True, False])
def test_the_formula_in_int64_overflows(doubled):
    """On the largest screen nearly everywhere, in the form that needs two bits less as well."""
    limit = 1 << 21
    display_list = listed([[[limit - 1, limit - 1], [limit - 1, -limit], [-limit, limit - 1]]],
                          [[FARTHEST, FARTHEST - 5, FARTHEST // 3]], 4096, depth_bits=32)
    random = np.random.default_rng(3)
    enough = scene_fraction_bits(display_list)
    prepared = prepare(display_list, fraction_bits=enough)
    wrong = checked = 0
    for x, y in random.integers(0, 4096, (12, 2)).tolist():
        [depth] = exact.fragments(display_list, pixel=(x, y)).depth.tolist()
        right = rational(display_list, 0, x, y)
        assert depth == right
        stored = bit_true.evaluate(prepared.depth, enough, *(np.array([n]) for n in (0, x, y)),
                                   FARTHEST)
        assert stored.tolist() == [right]
        checked += 1
        wrong += in_int64(display_list, 0, x, y, doubled) != right
    assert wrong > checked // 2


@pytest.mark.parametrize(("form", "limit"), [("_doubles", 2**52), ("whole", 2**63 - 1)])
def test_on_both_sides_of_where_the_form_of_depth_changes(form, limit):
    """Quotients of doubles, then of 64-bit integers, then two halves: the last and the first."""
    end = 1 << 15
    position = [[[end - 1, end - 1], [end - 1, -end], [-end, end - 1]]]
    area = (2 * end - 1) ** 2
    first_beyond = limit // area
    for greatest, inside in ((first_beyond - 1, True), (first_beyond, False)):
        display_list = listed(position, [[greatest, 0, greatest]], 64, depth_bits=32)
        triangles = Triangles.of(display_list, Grid.of(display_list))
        assert getattr(exact._Depth(display_list, triangles), form) == inside
        fragments = exact.fragments(display_list)
        assert len(fragments) == 64 * 64
        for at in range(0, len(fragments), 11):
            x, y = int(fragments.x[at]), int(fragments.y[at])
            assert fragments.depth[at] == rational(display_list, 0, x, y)


# Widths.  Screens of 2**n pixels, since those come nearest to the ends.

FORMATS = [(3, 2, 8), (4, 4, 12), (5, 8, 24), (3, 8, 32)]


def signed_bits(values):
    """The fewest bits that hold all of ``values`` as signed numbers."""
    return max((value if value >= 0 else ~value).bit_length() for value in values) + 1


def whole_range(n, s):
    """Coordinate bits, and the four corners of the coordinate range."""
    bits = coordinate_bits(1 << n, 1 << n, s)
    assert bits == n + 2 + s
    ends = (-(1 << (bits - 1)), (1 << (bits - 1)) - 1)
    return bits, [list(corner) for corner in product(ends, repeat=2)]


@pytest.mark.parametrize(("n", "s", "d"), FORMATS)
def test_widths_of_area_edge_and_plane_numerator(n, s, d):
    """Exactly 2b + 1, 2b - s + 1 and 2b + d + 3 bits, over every triangle of extreme corners."""
    bits, corners = whole_range(n, s)
    unit = 1 << s
    centres = [unit // 2, ((1 << n) - 1) * unit + unit // 2]
    areas, edges, numerators = [0], [0], [0]
    for (x0, y0), (x1, y1), (x2, y2) in combinations(corners, 3):
        area = (x1 - x0) * (y2 - y0) - (x2 - x0) * (y1 - y0)
        areas += [area, -area]
        for x, y in product(centres, repeat=2):
            at = [(x1 - x) * (y2 - y) - (x2 - x) * (y1 - y),
                  (x2 - x) * (y0 - y) - (x0 - x) * (y2 - y),
                  (x0 - x) * (y1 - y) - (x1 - x) * (y0 - y)]
            # Steps are multiples of 2**s, so what lies below never changes.
            edges += [value >> s for value in at] + [-value >> s for value in at]
        for values in product([0, 2**d - 2], repeat=3):
            # The box is clipped to the screen: its origin is the first centre.
            x = y = centres[0]
            weights = [(x1 - x) * (y2 - y) - (x2 - x) * (y1 - y),
                       (x2 - x) * (y0 - y) - (x0 - x) * (y2 - y),
                       (x0 - x) * (y1 - y) - (x1 - x) * (y0 - y)]
            sign = 1 if area > 0 else -1
            numerator = sign * sum(w * z for w, z in zip(weights, values, strict=True))
            numerators.append(2 * numerator + abs(area) // 2 * 2 + 1)
    assert signed_bits(areas) == 2 * bits + 1
    assert signed_bits(edges) == 2 * bits - s + 1
    assert signed_bits(numerators) == 2 * bits + d + 3


def long_edge(triangle, size, sub_bits):
    """The edge from the first vertex down to the last, on every row, and its columns, rational."""
    prepared = prepare(listed([triangle], [[0, 0, 0]], size, sub_bits=sub_bits), fraction_bits=0)
    assert (prepared.top[0], prepared.bottom[0]) == (0, size)
    (x0, y0), _, (x1, y1) = triangle
    unit = 1 << sub_bits
    true = []
    for row in range(size):
        intercept = x0 + Fraction((row * unit + unit // 2 - y0) * (x1 - x0), y1 - y0)
        true.append(-floor(-(intercept - unit // 2) / unit))
    return prepared.long, true


@pytest.mark.parametrize(("n", "s"), [(3, 2), (4, 4), (5, 8), (9, 8)])
def test_widths_of_quotient_and_remainder(n, s):
    """b - s + 1 bits of column, b of remainder, b + 1 of their sum: none can be narrower."""
    size = 1 << n
    bits, corners = whole_range(n, s)
    low, high = corners[0][0], corners[3][0]
    widths = {"column_bits": edge_column_bits(bits, s),
              "remainder_bits": edge_height_bits(bits),
              "sum_bits": edge_height_bits(bits) + 1}
    assert list(widths.values()) == [bits - s + 1, bits, bits + 1]
    failed = set()
    # One at the right end of the range, all but straight down, its remainders near its
    # height; and a slanting one.
    for triangle in ([[high, low], [low, high], [high - 1, high]],
                     [[low, low], [low, high], [high - (high - low) // 3, high]]):
        edges, true = long_edge(triangle, size, s)
        assert stepped_columns(edges, 0, size, **widths) == true
        for name in widths:
            narrower = widths | {name: widths[name] - 1}
            if stepped_columns(edges, 0, size, **narrower) != true:
                failed.add(name)
    assert failed == set(widths)


@pytest.mark.parametrize(("n", "s", "ends"), [(4, 4, (-123, 441)), (5, 8, (1207, -12248)),
                                              (9, 8, (11145, 132687))])
def test_widths_of_carried_edges(n, s, ends):
    """Edges as high as the range: of the column and of the fraction, no bit can be spared.

    The second edge was searched for: on the last row its error exceeds what is left of its slot.
    """
    size = 1 << n
    bits, corners = whole_range(n, s)
    low, high = corners[0][0], corners[3][0]
    column_bits = edge_column_bits(bits, s)
    fraction_bits = edge_fraction_bits(edge_height_bits(bits), size)
    assert fraction_bits == bits + n
    failed = []
    for x0, x1 in ((high, high - 1), ends):
        edges, true = long_edge([[x0, low], [low, high], [x1, high]], size, s)
        for less in ((0, 0), (1, 0), (0, 1)):
            columns, fractions = column_bits - less[0], fraction_bits - less[1]
            carried = carry_edges(edges, column_bits=columns, fraction_bits=fractions)
            if carried_columns(carried, 0, size, columns) != true:
                failed.append(((x0, x1), less))
    assert failed == [((high, high - 1), (1, 0)), (ends, (0, 1))]


@pytest.mark.parametrize("interpolant", ["depth", "color"])
@pytest.mark.parametrize("fraction_bits", [0, 1, 3, 5, 7])
def test_width_of_carried_words(interpolant, fraction_bits):
    """One guard bit less and the largest value, carried too high, wraps instead of saturating.

    The value falls by half a unit of 2**-F a pixel to the left and downwards of the diagonal.
    Both increments are rounded up: half a unit too high for each pixel right or down.
    """
    size, unit = 512, 256
    limit = 255 if interpolant == "color" else 2**24 - 2
    beyond, below = 768 * unit, 256 * unit
    values = np.array([limit, limit, limit - 2 ** (7 - fraction_bits)])
    display_list = listed([[[0, 0], [beyond, beyond], [0, below]]],
                          [values if interpolant == "depth" else [0, 0, 0]], size,
                          color=(values if interpolant == "color" else values * 0)
                          .astype(np.uint8)[None, :, None].repeat(3, axis=2))
    prepared = prepare(display_list, fraction_bits=fraction_bits)
    if interpolant == "depth":
        planes, word_bits = prepared.depth, depth_word_bits(24, fraction_bits, size, size)
    else:
        planes, word_bits = prepared.color[0], color_word_bits(fraction_bits, size, size)
    assert planes.word_bits == word_bits
    narrow = Planes(*(fixed_point.wrap(part, planes.word_bits - 1)
                      for part in (planes.start, planes.step_x, planes.step_y)),
                    planes.word_bits - 1)  # fmt: skip
    assert len(exact.fragments(display_list, pixel=(510, 511))) == 1
    at = [np.array([number]) for number in (0, 510, 511)]
    assert bit_true.evaluate(planes, fraction_bits, *at, limit).tolist() == [limit]
    assert bit_true.evaluate(narrow, fraction_bits, *at, limit).tolist() != [limit]


@pytest.mark.parametrize("size", [64, 512])
def test_words_without_guard_or_sign_hold_extreme_triangles(size):
    """At the least fraction bits that stay in range, unsigned and not saturated: over corners of
    the guard band, random, and level at both ends of the range; a sample of all pixels."""
    fraction_bits = next(bits for bits in range(65)
                         if fixed_point.stays_in_range(bits, 2 * size - 2))
    limit = 1 << (coordinate_bits(size, size, 8) - 1)
    random = np.random.default_rng(size)
    screen = size << 8
    position = np.concatenate([
        [[[-limit, -limit], [limit - 1, -limit], [-limit, limit - 1]],
         [[limit - 1, limit - 1], [limit - 1, -limit], [-limit, limit - 1]],
         [[0, 0], [screen, 1], [screen - 1, screen]]],
        random.integers(-limit, limit, (8, 3, 2)), random.integers(0, screen + 1, (12, 3, 2))])
    ends = random.choice([0, 1, FARTHEST - 1, FARTHEST], (len(position), 3))
    ends[::5] = ends[::5, :1]
    checked = off = 0
    for corners, depth in zip(position, ends, strict=True):
        display_list = listed(corners, depth, size, depth_bits=32)
        found = exact.fragments(display_list)
        if not len(found):
            continue
        prepared = prepare(display_list, fraction_bits=fraction_bits)
        chosen = slice(None, None, 1 + len(found) // 2000)
        right, down = found.x[chosen] - prepared.left[0], found.y[chosen] - prepared.top[0]
        values = [(prepared.depth, depth, 32, FARTHEST), *(
            (planes, display_list.color[0, :, channel].astype(np.int64), 8, 255)
            for channel, planes in enumerate(prepared.color))]
        for planes, vertices, bits, high in values:
            word = fixed_point.wrap(planes.start[0] + right.astype(object) * planes.step_x[0]
                              + down.astype(object) * planes.step_y[0], bits + fraction_bits)
            stored = (word >> fraction_bits).astype(np.int64)
            assert ((stored >= vertices.min()) & (stored <= vertices.max())).all()
            np.testing.assert_array_equal(stored, bit_true.evaluate(
                planes, fraction_bits, np.zeros_like(right), right, down, high))
            checked += len(stored)
            if planes is prepared.depth:
                off += int(np.count_nonzero(stored != found.depth[chosen]))
    print(f"{size}: {fraction_bits} fraction bits, {checked} values, {off} depths not exact")
    assert checked > 20_000 and off > 0
