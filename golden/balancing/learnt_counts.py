"""The counts of the next picture's regions, foretold from those of the last three.

All in integers and fractions of them, so that every host makes the same table.
"""

from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction

import numpy as np
from numpy.typing import NDArray

Int64 = NDArray[np.int64]

#: Pictures that must have been counted.
LEARNT_FROM = 3

#: Between which the growth of a region is thought to go on: it turns half round at least, or goes
#: on half as fast again at most.
GOES_ON = (Fraction(-1, 2), Fraction(3, 2))

#: How much of a count is thought to spread to its neighbours: between none and as blurred.
SPREADS = (Fraction(0), Fraction(1))

#: Counts are blurred by whole numbers, and so come out this many times too large.
_BLURRED = 16


def learnt_counts(seen: Sequence[Int64] | Sequence[Sequence[int]], columns: int) -> Int64:
    """int64 (regions,): what each region is expected to be counted in the next picture.

    Its last count, and two things more: its growth from the picture before, blurred, times a
    factor; and how the count changes if it is blurred, times another.  The factors are those by
    which the three pictures before would have foretold the growth of the last one best: least
    squares over all regions for both together, then each held to ``GOES_ON`` and ``SPREADS``.
    Where many pairs would be as good it is the smallest.  Blurred means that each region gives a
    quarter of its count to each neighbour left and right, and then as much up and down; none
    beyond the screen.  What is foretold is rounded to the nearest integer, halves up, and is no
    less than 0.

    ``seen``     int64 (3, regions), or anything that numpy makes that of: what was counted of
                 each, row by row, in the last three pictures, the last one first; up to 56 bits
    ``columns``  of regions

    >>> import cardcage
    >>> cardcage.learnt_counts([[60, 60], [40, 40], [20, 20]], columns=2).tolist()
    [80, 80]
    """
    last, before, third = np.asarray(seen, np.int64)
    goes_on, spreads = _factors(last - before, _blurred(before - third, columns),
                                _change(before, columns))
    goes_on, spreads = _held(goes_on, GOES_ON), _held(spreads, SPREADS)
    # Both over one denominator; of Python's integers, as products are longer than 64 bits.
    denominator = goes_on.denominator * spreads.denominator
    of_growth = goes_on.numerator * spreads.denominator
    of_change = spreads.numerator * goes_on.denominator
    foretold = [count + _rounded(of_growth * growth + of_change * change, denominator)
                for count, growth, change in zip(
                    last.tolist(), _blurred(last - before, columns).tolist(),
                    _change(last, columns).tolist(), strict=True)]
    return np.maximum(np.array(foretold, np.int64), 0)


def _blurred(counts: Int64, columns: int) -> Int64:
    """``_BLURRED`` times."""
    field = counts.reshape(-1, columns)
    for _ in range(2):  # the rows, and then, turned, the columns
        around = np.pad(field, ((1, 1), (0, 0)), mode="edge")
        field = (around[:-2] + 2 * around[1:-1] + around[2:]).T
    return field.reshape(-1)


def _change(counts: Int64, columns: int) -> Int64:
    """By blurring, ``_BLURRED`` times."""
    return _blurred(counts, columns) - _BLURRED * counts


def _factors(wanted: Int64, one: Int64, other: Int64) -> tuple[Fraction, Fraction]:
    """By what two things, given ``_BLURRED`` times, come nearest to what is wanted together:
    Cramer's rule for the normal equations."""
    of_one, of_other = _dot(one, wanted), _dot(other, wanted)
    ones, both, others = _dot(one, one), _dot(one, other), _dot(other, other)
    determinant = ones * others - both * both
    if determinant == 0:  # one is a multiple of the other
        determinant = ones + others
        pair = (of_one, of_other)
    else:
        pair = (of_one * others - of_other * both, of_other * ones - of_one * both)
    if determinant == 0:  # nothing has changed, and nothing would
        return Fraction(0), Fraction(0)
    return (Fraction(_BLURRED * pair[0], determinant), Fraction(_BLURRED * pair[1], determinant))


def _dot(one: Int64, other: Int64) -> int:
    """The sum of products, of any length."""
    return sum(a * b for a, b in zip(one.tolist(), other.tolist(), strict=True))


def _held(factor: Fraction, bounds: tuple[Fraction, Fraction]) -> Fraction:
    return min(max(factor, bounds[0]), bounds[1])


def _rounded(value: int, denominator: int) -> int:
    """``value``, ``_BLURRED`` times too large, over the denominator; halves up."""
    whole = _BLURRED * denominator
    return (2 * value + whole) // (2 * whole)
