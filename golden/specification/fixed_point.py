"""Fixed point: every narrowing by name, and the widths the arithmetic needs.

Each function takes Python ints or numpy integer arrays, mixed as numpy
broadcasts them, and gives back the same kind.  Arrays of dtype ``object`` hold
Python ints and never overflow; with int64 arrays the caller answers for the
ranges named below.  The hardware narrows with components of the same names.
"""

from __future__ import annotations

from fractions import Fraction
from typing import Any, cast, overload

import numpy as np
from numpy.typing import NDArray

from .ranges import check_whole

Array = NDArray[Any]

#: More than the widest display list needs to be exact (see ``exact_fraction_bits``):
#: double area below 2**44, extent below 2**13.
MAX_FRACTION_BITS = 64

#: The greatest error there can be, since depths have at most 32 bits.
MAXIMUM_ERROR = (1 << 32) - 1

#: Masks and powers of two up to this many bits are exact in int64.
_INT64_BITS = 62


def _widened(value: int | Array, bits: int) -> int | Array:
    """``value``, as an object array where int64 cannot hold ``2**bits``."""
    if isinstance(value, np.ndarray) and value.dtype != object:
        return value.astype(np.int64 if bits <= _INT64_BITS else object)
    return value


@overload
def wrap(value: int, bits: int) -> int: ...
@overload
def wrap(value: Array, bits: int) -> Array: ...
def wrap(value: int | Array, bits: int) -> int | Array:
    """``value`` modulo ``2**bits``, unsigned: what a register of ``bits`` bits keeps.

    An int64 array with ``bits`` above 62 comes back as an object array.
    """
    return cast("int | Array", _widened(value, bits) & ((1 << bits) - 1))


@overload
def to_signed(value: int, bits: int) -> int: ...
@overload
def to_signed(value: Array, bits: int) -> Array: ...
def to_signed(value: int | Array, bits: int) -> int | Array:
    """The low ``bits`` bits of ``value`` read as two's complement, ``bits`` at least 1."""
    half = 1 << (bits - 1)
    low = _widened(value, bits) & ((1 << bits) - 1)
    return cast("int | Array", (low ^ half) - half)


@overload
def floor_shift(value: int, fraction_bits: int) -> int: ...
@overload
def floor_shift(value: Array, fraction_bits: int) -> Array: ...
def floor_shift(value: int | Array, fraction_bits: int) -> int | Array:
    """floor(value / 2**fraction_bits): the fraction bits are dropped."""
    if isinstance(value, np.ndarray) and value.dtype != object:
        # A shift by the whole word is undefined; 63 already leaves only the sign.
        fraction_bits = min(fraction_bits, 63)
    return cast("int | Array", value >> fraction_bits)


@overload
def saturate(value: int, low: int, high: int) -> int: ...
@overload
def saturate(value: Array, low: int, high: int) -> Array: ...
def saturate(value: int | Array, low: int, high: int) -> int | Array:
    """``value`` held to ``[low, high]``, both ends included."""
    if isinstance(value, np.ndarray):
        return np.minimum(np.maximum(value, low), high)
    return min(max(value, low), high)


@overload
def round_half_up_divide(numerator: int, denominator: int) -> int: ...
@overload
def round_half_up_divide(numerator: Array, denominator: int | Array) -> Array: ...
def round_half_up_divide(numerator: int | Array, denominator: int | Array) -> int | Array:
    """floor(numerator / denominator + 1/2) for a positive denominator.

    That is floor((2n + d) / 2d), computed as floor((n + floor(d/2)) / d): for
    integers both are the same, and the second needs two bits less.  int64
    arrays must hold n + floor(d/2).
    """
    return cast("int | Array", (numerator + denominator // 2) // denominator)


@overload
def ceil_divide(numerator: int, denominator: int) -> int: ...
@overload
def ceil_divide(numerator: Array, denominator: int | Array) -> Array: ...
def ceil_divide(numerator: int | Array, denominator: int | Array) -> int | Array:
    """ceil(numerator / denominator) for a positive denominator."""
    return cast("int | Array", -(-numerator // denominator))


@overload
def modulated(color: int, shade: int) -> int: ...
@overload
def modulated(color: Array, shade: Array) -> Array: ...
def modulated(color: int | Array, shade: int | Array) -> int | Array:
    """A channel of eight bits under a shade of as many: 255 leaves it as it is.

    floor(color * (shade + 1) / 256), so that hardware needs a product and no division.
    """
    return cast("int | Array", color * (shade + 1) >> 8)


@overload
def bit_length(value: int) -> int: ...
@overload
def bit_length(value: Array) -> NDArray[np.int64]: ...
def bit_length(value: int | Array) -> int | NDArray[np.int64]:
    """The least n with ``value < 2**n``, for values from 0; arrays give int64."""
    if not isinstance(value, np.ndarray):
        return int(value).bit_length()
    numbers = value.ravel().tolist()
    lengths = np.fromiter((number.bit_length() for number in numbers), np.int64, len(numbers))
    return lengths.reshape(value.shape)


@overload
def exact_fraction_bits(double_area: int, extent: int) -> int: ...
@overload
def exact_fraction_bits(double_area: Array, extent: Array) -> NDArray[np.int64]: ...
def exact_fraction_bits(
    double_area: int | Array, extent: int | Array
) -> int | NDArray[np.int64]:
    """The fewest fraction bits F at which stepped planes floor to the exact value.

    ``double_area``  D, twice the triangle's area in square sub-pixel units, positive
    ``extent``       the largest x + y, in pixels of the machine, from the corner
                     of the triangle's clipped bounding box

    The exact value is floor((N + floor(D/2)) / D), a multiple of 1/D before the
    floor.  What is carried starts half such a step higher, so it may err by
    less than 1 / 2D either way and still floor to the same integer.  Start and
    two increments, each rounded to nearest at 2**-F, err by at most
    (1 + x + y) * 2**-(F+1) together; hence 2**F > D * (1 + extent).
    """
    return bit_length(double_area * (1 + extent))


def error_bound(fraction_bits: int, extent: int) -> Fraction:
    """The most a carried value is off, before the floor, ``extent`` = x + y pixels on.

    Start and each increment are off by at most half a unit of 2**-F.
    """
    return Fraction(1 + extent, 1 << (fraction_bits + 1))


def error_fraction_bits(extent: int, max_error: int) -> int:
    """The fewest fraction bits at which no stored value is more than ``max_error``, at least 1,
    off, for triangles of that ``extent``: the error before the floor is at most that."""
    bits = 0
    while error_bound(bits, extent) > max_error:
        bits += 1
    return bits


def on_screen_fraction_bits(width: int, height: int, sub_bits: int, max_error: int = 0) -> int:
    """Fraction bits at which every triangle with all its vertices on the screen is exact, or, where
    ``max_error`` is not 0, has no depth that is more than so many LSB off.

    No such triangle has more area than half the screen, or covers more columns and rows.
    """
    extent = width + height - 2
    bits = exact_fraction_bits((width << sub_bits) * (height << sub_bits), extent)
    if max_error:
        bits = min(bits, error_fraction_bits(extent, max_error))
    return min(bits, MAX_FRACTION_BITS)


def guard_bits(value_bits: int, fraction_bits: int, extent: int) -> int:
    """Bits above a value's own that tell too low from too high: the fewest, at least two.

    At a covered pixel the value lies in [0, 2**value_bits).  Carried, it is off by at
    most B = (1 + extent) * 2**-(F+1), so once floored by at most ceil(B).  Read as a
    signed number of ``value_bits + guard`` bits it must not fall out at the bottom,
    ceil(B) <= 2**(value_bits+guard-1), nor at the top, where all of
    2**value_bits - 1 + ceil(B) is less than that.
    """
    check_fraction_bits(fraction_bits)
    error = ceil_divide(1 + extent, 2 << fraction_bits)
    return ((1 << value_bits) - 1 + error).bit_length() + 1 - value_bits


def stays_in_range(fraction_bits: int, extent: int) -> bool:
    """Whether carried values, once floored, lie between the vertices' at every covered pixel.

    The start is half a unit high (``exact_fraction_bits``), and the unrounded plane is never
    outside: off by less than 1/4 the floor cannot be either.  Then there is nothing to
    saturate, no bit is needed to tell too low from too high, and none for a sign.
    """
    return 2 * (1 + extent) < 1 << fraction_bits


def check_fraction_bits(fraction_bits: int) -> None:
    """Raise ``InputError`` unless it is a whole number from 0 to ``MAX_FRACTION_BITS``."""
    check_whole("fraction bits", fraction_bits, 0, MAX_FRACTION_BITS)


def check_max_error(max_error: int) -> None:
    """Raise ``InputError`` unless it is a number of depth LSB."""
    check_whole("max error", max_error, 0, MAXIMUM_ERROR)
