"""Foretold counts against fractions: the least squares worked out by elimination."""

from fractions import Fraction
from math import floor

import numpy as np
import pytest

from cardcage.golden.balancing.learnt_counts import learnt_counts


def blurred(field):
    """Of rows of fractions: a quarter to each side, then up and down; nothing beyond."""
    def along(row):
        return [(row[max(place - 1, 0)] + 2 * row[place] + row[min(place + 1, len(row) - 1)]) / 4
                for place in range(len(row))]

    def turned(rows):
        return [list(row) for row in zip(*rows, strict=True)]

    return turned(list(map(along, turned(list(map(along, field))))))


def solved(wanted, one, other):
    """The pair of factors of the least sum of squares, by elimination; the shortest of many."""
    def dot(a, b):
        return sum((x * y for x, y in zip(a, b, strict=True)), Fraction(0))

    if dot(one, one) == 0:
        return Fraction(0), dot(other, wanted) / (dot(other, other) or 1)
    part = dot(one, other) / dot(one, one)
    rest = [y - part * x for x, y in zip(one, other, strict=True)]
    if dot(rest, rest) == 0:  # other = part * one: along (1, part)
        by = dot(one, wanted) / dot(one, one) / (1 + part * part)
        return by, by * part
    second = dot(rest, wanted) / dot(rest, rest)
    return dot(one, wanted) / dot(one, one) - second * part, second


def expected(seen, columns):
    """By the definition, a fraction at a time; and the factors as they were before they were
    held."""
    def minus(a, b):
        return [[x - y for x, y in zip(*rows, strict=True)] for rows in zip(a, b, strict=True)]

    def flat(field):
        return [count for row in field for count in row]

    last, before, third = ([[Fraction(int(count)) for count in row]
                            for row in np.reshape(counts, (-1, columns))] for counts in seen)
    growth = minus(last, before)
    factors = solved(flat(growth), flat(blurred(minus(before, third))),
                     flat(minus(blurred(before), before)))
    goes_on = min(max(factors[0], Fraction(-1, 2)), Fraction(3, 2))
    spreads = min(max(factors[1], Fraction(0)), Fraction(1))
    return [max(0, floor(count + goes_on * more + spreads * change + Fraction(1, 2)))
            for count, more, change in zip(flat(last), flat(blurred(growth)),
                                           flat(minus(blurred(last), last)), strict=True)], factors


@pytest.mark.parametrize("shape", [(1, 1), (1, 7), (6, 1), (2, 2), (5, 8)], ids=str)
@pytest.mark.parametrize("most", [3, 1 << 16, 1 << 56])
def test_to_the_last_bit(shape, most):
    source = np.random.default_rng([*shape, most])
    for _ in range(6):
        seen = [source.integers(0, most, shape[0] * shape[1]) for _ in range(3)]
        found = learnt_counts(seen, shape[1])
        assert found.dtype == np.int64
        assert found.tolist() == expected(seen, shape[1])[0]


def test_factors_within_and_beyond_their_bounds():
    """Pictures that go on by what is chosen: it is found again, or held."""
    source = np.random.default_rng(5)
    where = set()
    for goes_on in (-2, Fraction(-1, 4), 1, 3):
        for spreads in (-1, Fraction(1, 2), 2):
            third = source.integers(0, 1 << 20, 30) * 64 + (1 << 40)
            before = third + source.integers(0, 1 << 20, 30) * 64

            def blur(counts):
                return np.array([count for row in blurred([[Fraction(int(count)) for count in row]
                                 for row in counts.reshape(5, 6)]) for count in row])

            last = before + (goes_on * blur(before - third)
                             + spreads * (blur(before) - before)).astype(np.int64)
            counts, factors = expected([last, before, third], 6)
            where.add((round(float(factors[0]), 3), round(float(factors[1]), 3)))
            assert learnt_counts([last, before, third], 6).tolist() == counts
    assert where == {(goes_on, spreads) for goes_on in (-2, -0.25, 1, 3)
                     for spreads in (-1, 0.5, 2)}


def test_where_factors_cannot_be_told_apart():
    flat = np.full(12, 40)
    for pictures in ([flat] * 3, [flat * 0] * 3,  # nothing changes
                     [flat + 9, flat + 3, flat],  # nothing spreads
                     [flat, np.arange(12) * 16, np.arange(12) * 16],  # nothing had grown
                     [flat + 1, np.eye(3, 4, dtype=int).ravel() * 16, flat * 0]):
        assert learnt_counts(pictures, 4).tolist() == expected(pictures, 4)[0]
    assert learnt_counts([flat] * 3, 4).tolist() == flat.tolist()
    # Each by itself changes when blurred as it had grown when that is blurred: a wave of period 2.
    wave = np.tile([16, 0], 6)
    grown = wave - np.round(np.array(blurred([[Fraction(int(each)) for each in row]
                            for row in wave.reshape(1, -1)])[0]).astype(float)).astype(int)
    pictures = [wave * 2, wave, wave - grown]
    assert learnt_counts(pictures, 12).tolist() == expected(pictures, 12)[0]


def test_halves_go_up():
    """A region by itself: growth 1 goes on by half of that, 2 before."""
    assert [learnt_counts([np.array([last]), np.array([before]), np.array([third])], 1).tolist()
            for last, before, third in ((13, 12, 10), (12, 13, 15), (0, 1, 3))] == [
                [14], [12], [0]]
