"""Expected traffic against the paper's sums, and against all assignments tried out."""

from fractions import Fraction
from itertools import product

import numpy as np
import pytest

from cardcage.testbenches.figures.expected_traffic import (
    by_pixel,
    by_pixel_among,
    evenly,
    harmonic,
)


def slow_harmonic(depth):
    return sum((Fraction(1, d) for d in range(1, depth + 1)), Fraction(0))


def sent(nodes_by_depth):
    """Of one pixel, by the algorithm: nodes in ascending order, each its nearest fragment."""
    count, heard = 0, len(nodes_by_depth)
    for node in sorted(set(nodes_by_depth)):
        nearest = nodes_by_depth.index(node)
        if nearest < heard:
            count, heard = count + 1, nearest
    return count


def test_harmonic():
    assert [harmonic(depth) for depth in range(4)] == pytest.approx([0, 1, 1.5, 11 / 6])


@pytest.mark.parametrize(("area", "fragments"), [(7, 0), (7, 3), (7, 7), (5, 28), (1, 9), (0, 0)])
def test_evenly(area, fragments):
    """Equation 4, pixel by pixel."""
    depths = [fragments // area + (pixel < fragments % area) for pixel in range(area)]
    assert sum(depths) == fragments
    assert evenly(area, fragments) == pytest.approx(float(sum(map(slow_harmonic, depths))))


def test_by_pixel():
    depths = np.random.default_rng(3).integers(9, size=200)
    assert by_pixel(depths) == pytest.approx(float(sum(map(slow_harmonic, depths.tolist()))))
    assert by_pixel(depths) <= evenly(200, int(depths.sum()))
    assert by_pixel([]) == 0 == by_pixel([0, 0])


@pytest.mark.parametrize("nodes", [1, 2, 3, 5])
@pytest.mark.parametrize("depth", [0, 1, 2, 3, 4, 5])
def test_among_nodes_is_the_mean_of_all_assignments(nodes, depth):
    every = [sent(assignment) for assignment in product(range(nodes), repeat=depth)]
    assert by_pixel_among([depth], nodes) == pytest.approx(sum(every) / len(every))


def test_among_more_and_more_nodes_it_is_equation_3():
    depths = np.random.default_rng(4).integers(7, size=50)
    among = [by_pixel_among(depths, nodes) for nodes in (1, 2, 16, 100, 10_000)]
    assert among == sorted(among) and among[0] == np.count_nonzero(depths)
    assert among[-1] == pytest.approx(by_pixel(depths), rel=1e-3)
