"""Numbers written in decimal, many at a time, in any spelling."""

from __future__ import annotations

import warnings
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .decimals import decimals
from .text_lines import Lines


def numbers(
    text: bytes, kind: type[np.float64] | type[np.int64], count: int
) -> NDArray[Any]:
    """``count`` numbers with blanks between; ``ValueError`` where the text holds anything else.

    Every numpy says the same: older ones only warn of what they cannot read.
    """
    lines = Lines(text if text.endswith(b"\n") else text + b"\n")
    values: NDArray[Any] | None = None
    if lines.clean:
        values = decimals(lines.text, lines.words, lines.ends, kind)
    if values is None:
        with warnings.catch_warnings():
            warnings.simplefilter("error", DeprecationWarning)
            try:
                values = np.fromstring(text, kind, sep=" ")
            except DeprecationWarning as error:
                raise ValueError(str(error)) from None
    if len(values) != count:
        raise ValueError(f"{len(values)} numbers where {count} words are")
    return values


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
