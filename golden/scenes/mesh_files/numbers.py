"""Numbers written in decimal, many at a time."""

from __future__ import annotations

import warnings
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

_SPACE: Final = 32
_FIXED: Final = b"0123456789+-. \t\n\v\f\r"
_DECIMALS: Final = 12


def numbers(
    text: bytes, kind: type[np.float64] | type[np.int64], count: int
) -> NDArray[Any]:
    """``count`` numbers with blanks between; ``ValueError`` where the text holds anything else.

    Every numpy says the same: older ones only warn of what they cannot read.
    """
    if not count and not text.strip():
        values = np.zeros(0, kind)
    elif kind is np.float64 and (fixed := _fixed_point(text, count)) is not None:
        return fixed
    else:
        with warnings.catch_warnings():
            warnings.simplefilter("error", DeprecationWarning)
            try:
                values = np.fromstring(text, kind, sep=" ")
            except DeprecationWarning as error:
                raise ValueError(str(error)) from None
    if len(values) != count:
        raise ValueError(f"{len(values)} numbers where {count} words are")
    return values


def _fixed_point(text: bytes, count: int) -> NDArray[np.float64] | None:
    """Numbers that all have as many digits after the point, in half the time; None: others.

    Without their points they are whole numbers.  These and the power of ten are exact, so
    the quotient is rounded once, as numpy rounds what it reads.
    """
    if text.translate(None, _FIXED) or text.count(b".") != count:
        return None
    data = np.frombuffer(text + b" " * (_DECIMALS + 2), np.uint8)
    points = np.flatnonzero(data == ord("."))
    decimals = next((n for n in range(_DECIMALS + 1) if data[points[0] + n + 1] <= _SPACE), 0)
    if not decimals or not ((data[points + decimals] > _SPACE)
                            & (data[points + decimals + 1] <= _SPACE)).all():
        return None
    if (np.diff(points) <= decimals).any():  # two points in one number
        return None
    try:
        whole = numbers(text.translate(None, b"."), np.int64, count)
    except ValueError:
        return None
    if np.abs(whole).max() >= 2**53:
        return None
    return np.asarray(whole / 10.0**decimals, np.float64)


def first_numbers(text: bytes, count: int) -> NDArray[np.int64]:
    """Of ``count`` words such as ``7/1/3``, ``7//3`` or ``7`` the first whole number of each.

    ``ValueError`` where the text holds anything else.
    """
    if b"/" not in text:
        return numbers(text, np.int64, count)
    data = np.frombuffer(b" " + text, np.uint8)
    apart = (data <= ord(" ")) | (data == ord("/"))
    before = np.flatnonzero(apart[:-1] > apart[1:])
    first = data[before] != ord("/")
    if np.count_nonzero(first) != count:
        raise ValueError("a word without a first number")
    return np.asarray(numbers(text.replace(b"/", b" "), np.int64, len(before))[first], np.int64)
