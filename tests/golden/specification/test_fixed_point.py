"""Narrowings: exhaustively at small widths, against their definitions."""

from fractions import Fraction
from math import ceil, floor

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from cardcage.golden.specification import fixed_point
from cardcage.golden.specification.errors import InputError

NUMBERS = range(-70, 71)
KINDS = ("int", "int64", "object")


def each(function, kind, *arguments):
    """``function`` over ``NUMBERS``, as Python ints or as one array."""
    if kind == "int":
        return [function(number, *arguments) for number in NUMBERS]
    result = function(np.array(list(NUMBERS), kind), *arguments)
    assert isinstance(result, np.ndarray)
    return result.tolist()


@pytest.mark.parametrize("kind", KINDS)
def test_wrap_and_to_signed_keep_the_low_bits(kind):
    for bits in range(1, 8):
        assert each(fixed_point.wrap, kind, bits) == [n % 2**bits for n in NUMBERS]
        signed = each(fixed_point.to_signed, kind, bits)
        for number, result in zip(NUMBERS, signed, strict=True):
            assert -(2 ** (bits - 1)) <= result < 2 ** (bits - 1)
            assert (result - number) % 2**bits == 0


@pytest.mark.parametrize("kind", KINDS)
def test_floor_shift(kind):
    for bits in (0, 1, 2, 3, 7, 63, 70):
        assert each(fixed_point.floor_shift, kind, bits) == [floor(Fraction(n, 2**bits)) for n in
        NUMBERS]


@pytest.mark.parametrize("kind", KINDS)
def test_saturate_holds_both_ends(kind):
    assert each(fixed_point.saturate, kind, -3, 12) == [sorted((-3, n, 12))[1] for n in NUMBERS]


@pytest.mark.parametrize("kind", KINDS)
def test_divisions(kind):
    for divisor in range(1, 12):
        expected = [floor(Fraction(2 * n + divisor, 2 * divisor)) for n in NUMBERS]
        assert each(fixed_point.round_half_up_divide, kind, divisor) == expected
        assert each(fixed_point.ceil_divide, kind, divisor) == [ceil(Fraction(n, divisor))
                                                          for n in NUMBERS]


@pytest.mark.parametrize("bits", [61, 62, 63, 64, 65, 100])
def test_wide_words_do_not_overflow(bits):
    numbers = [-(2**63), -1, 0, 1, 2**63 - 1]
    array = np.array(numbers)
    assert fixed_point.wrap(array, bits).tolist() == [n % 2**bits for n in numbers]
    assert fixed_point.to_signed(array, bits).tolist() == [fixed_point.to_signed(n, bits) for n in
    numbers]


@given(st.integers(0, 2**70), st.integers(0, 2**70))
def test_bit_length(one, other):
    array = np.array([one, other], object)
    assert fixed_point.bit_length(array).tolist() == [one.bit_length(), other.bit_length()]


def test_exact_fraction_bits_is_the_smallest():
    for area in range(1, 40):
        for extent in range(12):
            bits = fixed_point.exact_fraction_bits(area, extent)
            assert 2**bits > area * (1 + extent)
            assert 2 ** (bits - 1) <= area * (1 + extent)


def test_exact_fraction_bits_suffice_for_every_value_and_error():
    """Floor(carried) is right when off by anything up to the bound, either way."""
    for area in range(1, 30):
        for extent in range(6):
            bits = fixed_point.exact_fraction_bits(area, extent)
            error = Fraction(1 + extent, 2 ** (bits + 1))
            for numerator in range(2 * area):
                exact = floor(Fraction(numerator, area) + Fraction(1, 2))
                carried = Fraction(2 * numerator + 2 * (area // 2) + 1, 2 * area)
                assert floor(carried - error) == floor(carried + error) == exact


def test_exact_fraction_bits_of_arrays():
    area, extent = np.array([1, 2**40, 7]), np.array([0, 1000, 3])
    bits = fixed_point.exact_fraction_bits(area, extent)
    assert bits.tolist() == [1, (2**40 * 1001).bit_length(), 5]


def test_triangles_on_the_screen_are_exact_unless_an_error_is_allowed():
    extent = 16 + 12 - 2
    exact = fixed_point.exact_fraction_bits(16 * 12 << 2 * 8, extent)
    assert fixed_point.on_screen_fraction_bits(16, 12, 8) == exact
    for max_error in (1, 2, 5):
        bits = fixed_point.on_screen_fraction_bits(16, 12, 8, max_error)
        assert bits == fixed_point.error_fraction_bits(extent, max_error) < exact


@pytest.mark.parametrize("value_bits", [1, 8, 24, 32])
@pytest.mark.parametrize("fraction_bits", [0, 1, 5, 20, 64])
@pytest.mark.parametrize("extent", [0, 1, 14, 1022, 8190])
def test_guard_bits_are_the_fewest_from_two(value_bits, fraction_bits, extent):
    error = ceil(Fraction(1 + extent, 2 ** (fraction_bits + 1)))

    def enough(guard):
        half = 2 ** (value_bits + guard - 1)
        return -error >= -half and 2**value_bits - 1 + error < half

    guard = fixed_point.guard_bits(value_bits, fraction_bits, extent)
    assert guard >= 2 and enough(guard) and not enough(guard - 1)


@pytest.mark.parametrize("extent", [0, 1, 2, 3, 14, 15, 1022, 8190])
def test_values_stay_in_range_from_where_the_bound_is_below_a_quarter(extent):
    least = next(bits for bits in range(65) if fixed_point.stays_in_range(bits, extent))
    for bits in range(65):
        bound = Fraction(1 + extent, 2 ** (bits + 1))
        stays = fixed_point.stays_in_range(bits, extent)
        assert stays == (bound < Fraction(1, 4)) == (bits >= least)


@pytest.mark.parametrize("area", range(1, 30))
def test_below_a_quarter_no_floor_leaves_the_range(area):
    """Of the least and the greatest value, off by anything below the bound, either way; with the
    bound at a quarter the greatest of D = 2 does."""
    almost = Fraction(1, 4) - Fraction(1, 10**9)
    half = Fraction(2 * (area // 2) + 1, 2 * area)
    assert floor(half - almost) == floor(half + almost) == 0
    assert (floor(half + Fraction(1, 4)) == 1) == (area == 2)


@pytest.mark.parametrize("fraction_bits", [-1, 65, 2.0, True, None])
def test_fraction_bits_out_of_range(fraction_bits):
    with pytest.raises(InputError, match="fraction bits"):
        fixed_point.check_fraction_bits(fraction_bits)
