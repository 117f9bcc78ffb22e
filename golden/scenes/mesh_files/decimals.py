"""Numbers written in decimal, a whole array of words at once.

Eight digits are eight bytes, and these one whole number of 64 bits, of which three
multiplications make the value: several times faster than a loop over the bytes.  Every byte
is checked; a word with anything else in it is left to a reader that knows every spelling.
"""

from __future__ import annotations

from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

Places = NDArray[np.int64]
Bytes = NDArray[np.uint8]

#: Blanks that a text needs behind its last word: eight bytes are looked at from any digit on.
BEHIND: Final = 8

#: Digits that fit a whole number of 64 bits, and its powers of ten.
_MOST_DIGITS: Final = 18
_WHOLE_POWERS: Final = 10 ** np.arange(_MOST_DIGITS + 1)

#: Powers of ten and whole numbers that are exact as doubles: their product and their quotient
#: are rounded once, as Python rounds what it reads.
_POWERS: Final = 10.0 ** np.arange(23)
_EXACT: Final = 2**53

#: Eight digits 0; what carries any byte above nine into its highest bit; and these bits.
_ZEROS, _ABOVE_NINE, _HIGHEST = (np.uint64(byte * 0x0101010101010101)
                                 for byte in (ord("0"), 0x80 - 10, 0x80))
#: Neighbours joined into pairs, pairs into fours, fours into eight: what keeps every second
#: one, the factor that adds ten, a hundred, ten thousand times a one to the next, and the shift.
_JOINS: Final = tuple((np.uint64(keep), np.uint64(1 + (10 ** (bits // 8) << bits)), np.uint64(bits))
                      for keep, bits in ((0xFFFFFFFFFFFFFFFF, 8), (0x00FF00FF00FF00FF, 16),
                                         (0x0000FFFF0000FFFF, 32)))


class _NotPlainError(Exception):
    """A word is no number, or written as few are."""


def eight_bytes(text: Bytes, places: Places) -> NDArray[np.uint64]:
    """The eight bytes from each of some places on as one number, the first one lowest."""
    windows = np.ndarray((len(text) - 7,), "<u8", text, 0, (1,))
    return windows[places].astype(np.uint64, copy=False)


def decimals(
    text: Bytes, starts: Places, ends: Places, kind: type[np.float64] | type[np.int64]
) -> NDArray[Any] | None:
    """The numbers that stand between ``starts`` and ``ends``; None where one is not plain.

    Plain is a sign or none, then digits, which for ``float64`` may have a point and an exponent.
    """
    if not len(starts):
        return np.zeros(0, kind)
    try:
        if kind is np.int64:
            return _whole_numbers(text, starts, ends)
        return _floats(text, starts, ends)
    except _NotPlainError:
        return None


def _whole_numbers(text: Bytes, starts: Places, ends: Places) -> Places:
    try:
        return _digits(text, starts, ends)
    except _NotPlainError:
        first, negative = _signs(text, starts)
        _check((ends > first).all())
        return _signed(_digits(text, first, ends), negative)


def _floats(text: Bytes, starts: Places, ends: Places) -> NDArray[np.float64]:
    last = ends
    tail = _tails(text, starts, ends, b"e")
    if tail is not None:
        ends = ends - tail
    first, negative = _signs(text, starts)
    fraction = _tails(text, starts, ends, b".")
    if fraction is None:
        _check((ends > first).all())
        whole, power = _digits(text, first, ends), np.zeros(1, np.int64)
    else:
        decimal = np.maximum(fraction - 1, 0)
        digits = ends - first - (fraction > 0)
        _check(digits.min() > 0 and digits.max() <= _MOST_DIGITS)
        if digits.max() < 8:
            whole = _eight_digits(_without_points(text, first, ends - fraction), digits)
        else:
            whole = (_digits(text, first, ends - fraction) * _WHOLE_POWERS[decimal]
                     + _digits(text, ends - decimal, ends))
        power = -decimal
    _check(whole.max() <= _EXACT)
    if tail is not None:
        power = power + _exponents(text, ends, last)
    values = _scaled(whole, power)
    far = np.abs(power) >= len(_POWERS)
    for index in np.flatnonzero(far & (whole > 0)).tolist() if far.any() else ():
        values[index] = float(text[first[index] : last[index]].tobytes())
    return _signed(values, negative)


def _scaled(whole: Places, power: Places) -> NDArray[np.float64]:
    """``whole`` times ten to the ``power``, where that is less than 23 either way."""
    size = _POWERS[np.minimum(np.abs(power), len(_POWERS) - 1)]
    values = whole.astype(np.float64)
    below = power < 0
    if below.all():
        return values / size
    return np.where(below, values / size, values * size)


def _exponents(text: Bytes, marks: Places, ends: Places) -> Places:
    """The exponents between ``marks``, where an e may stand, and ``ends``; 0 where none does."""
    there = ends > marks
    first, negative = _signs(text, np.minimum(marks + 1, ends))
    width = ends - first
    _check(((width > 0) & (width < 4))[there].all())
    values = _digits(text, first, ends)
    return _signed(values, negative)


def _signs(text: Bytes, starts: Places) -> tuple[Places, NDArray[np.bool_] | None]:
    """Where the digits begin, and which numbers are negative; None: none has a sign."""
    first = text[starts]
    if (first >= ord("0")).all():
        return starts, None
    negative = first == ord("-")
    return starts + (negative | (first == ord("+"))), negative


def _signed(values: NDArray[Any], negative: NDArray[np.bool_] | None) -> NDArray[Any]:
    return values if negative is None else np.negative(values, out=values, where=negative)


def _tails(text: Bytes, starts: Places, ends: Places, mark: bytes) -> Places | None:
    """How many bytes of each word there are from a mark on; 0 without one, None: all without.

    One number where all words have as many.  Where a word has several marks, from any of
    them: the others are then found among the digits.
    """
    first = text[starts[0] : ends[0]].tobytes().lower()
    width = len(first) - first.find(mark)
    if mark in first and (ends - starts >= width).all() and _is(text[ends - width], mark).all():
        return np.array([width])
    places = np.flatnonzero(_is(text[starts[0] : ends[-1]], mark)) + starts[0]
    owner = np.searchsorted(ends, places, side="right")
    inside = places >= starts[owner]
    if not inside.any():
        return None
    tails = np.zeros(len(ends), np.int64)
    tails[owner[inside]] = (ends[owner] - places)[inside]
    return tails


def _is(text: Bytes, mark: bytes) -> NDArray[np.bool_]:
    """Where a text has a point, or a letter, small or a capital."""
    return np.asarray(text | 0x20 == ord(mark), np.bool_)


def _digits(text: Bytes, starts: Places, ends: Places) -> Places:
    """The values of digits, none to eighteen of them."""
    width = ends - starts
    longest = int(width.max())
    _check(longest <= _MOST_DIGITS)
    if longest <= 8:
        return _eight_digits(eight_bytes(text, starts), width)
    tail = np.minimum(width, 8)
    return (_digits(text, starts, ends - tail) * 10**8
            + _eight_digits(eight_bytes(text, ends - tail), tail))


def _without_points(text: Bytes, starts: Places, points: Places) -> NDArray[np.uint64]:
    """The eight bytes from each start on, those behind the point moved up by one."""
    values = eight_bytes(text, starts)
    first = np.uint64(1) << (8 * (points - starts)).view(np.uint64)
    before: NDArray[np.uint64] = first - np.uint64(1)
    return values & before | values >> np.uint64(8) & ~before


def _eight_digits(values: NDArray[np.uint64], width: Places) -> Places:
    """The values of none to eight digits; ``values`` holds their bytes and is used up."""
    values ^= _ZEROS
    # What stands behind the digits is shifted out, and zeros in before them.
    values <<= (64 - 8 * width).view(np.uint64)
    _check(not (np.bitwise_or.reduce((values + _ABOVE_NINE) | values) & _HIGHEST))
    for keep, factor, shift in _JOINS:
        values &= keep
        values *= factor
        values >>= shift
    return values.view(np.int64)


def _check(plain: bool | np.bool_) -> None:
    if not plain:
        raise _NotPlainError
