"""The error bound is nearly reached at real sizes, and not exceeded, by triangles searched for."""

from fractions import Fraction
from math import ceil

import numpy as np
import pytest
from click.testing import CliRunner

from cardcage.golden.precision.worst_case_search import (
    INTERPOLANTS,
    find_worst,
    stored_errors,
)
from cardcage.golden.reference import exact
from cardcage.golden.specification import fixed_point
from cardcage.golden.specification.errors import InputError
from testbenches.studies import bound_search

SIZES = [(512, 512), (640, 480), (97, 61), (4096, 4096)]
SEEDS = range(2)


@pytest.mark.parametrize("interpolant", INTERPOLANTS)
@pytest.mark.parametrize("size", SIZES)
@pytest.mark.parametrize("fraction_bits", [0, 1, 4, 9, 16, 24, 32, 45, 60])
def test_the_bound_is_nearly_reached_and_not_exceeded(interpolant, size, fraction_bits):
    """At a pixel that the triangle covers, both ways; the carried value in fractions."""
    for seed in SEEDS:
        case = find_worst(width=size[0], height=size[1], interpolant=interpolant,
                          fraction_bits=fraction_bits, seed=seed)
        assert len(exact.fragments(case.display_list, pixel=(case.x, case.y))) == 1
        assert case.x + case.y == sum(size) - 2
        assert case.bound == Fraction(sum(size) - 1, 2 ** (fraction_bits + 1))
        print(f"{interpolant} F={fraction_bits} {size} seed {seed}: {float(case.error):.6g} "
              f"of {float(case.bound):.6g}, ratio {case.ratio:.4f}")
        assert -case.bound < case.error <= case.bound
        assert case.ratio >= 0.98
        assert (case.error > 0) == (seed % 2 == 0)


@pytest.mark.parametrize("formats", [(1, 12), (2, 8), (8, 32)])
def test_other_formats(formats):
    sub_bits, depth_bits = formats
    for fraction_bits in (0, 7, 20):
        case = find_worst(width=256, height=200, interpolant="depth", fraction_bits=fraction_bits,
                          seed=1, sub_bits=sub_bits, depth_bits=depth_bits)
        assert 0.95 * case.bound <= abs(case.error) <= case.bound


@pytest.mark.parametrize("interpolant", INTERPOLANTS)
@pytest.mark.parametrize("size", [(256, 256), (97, 61)])
@pytest.mark.parametrize("fraction_bits", [0, 2, 4, 8, 12])
def test_stored_errors_reach_the_bound_rounded_up(interpolant, size, fraction_bits):
    """Every covered pixel of the worst triangles, each against the bound of its own x + y."""
    reached = 0
    for seed in SEEDS:
        case = find_worst(width=size[0], height=size[1], interpolant=interpolant,
                          fraction_bits=fraction_bits, seed=seed)
        errors, extent = stored_errors(case)
        bounds = np.array([ceil(fixed_point.error_bound(fraction_bits, steps))
                           for steps in range(sum(size) - 1)])[extent]
        assert extent.max() == sum(size) - 2
        assert (abs(errors) <= bounds).all()
        # Far from the origin, where the bound is the largest.
        reached += (abs(errors) == bounds)[2 * extent > sum(size)].sum()
    print(f"{interpolant} F={fraction_bits} {size}: reached at {reached} pixels")
    assert reached


def test_the_search_repeats_itself():
    arguments = {"width": 64, "height": 48, "interpolant": "depth", "fraction_bits": 5}
    one, two, other = (find_worst(**arguments, seed=seed) for seed in (7, 7, 9))
    assert np.array_equal(one.display_list.position, two.display_list.position)
    assert not np.array_equal(one.display_list.position, other.display_list.position)
    assert one.error == two.error


@pytest.mark.parametrize(("changes", "field"), [({"width": 7}, "width"), ({"height": 4097}, "hei"),
                                                ({"fraction_bits": 65}, "fraction"),
                                                ({"sub_bits": 9}, "sub_bits"),
                                                ({"depth_bits": 1}, "depth_bits")])
def test_bad_input(changes, field):
    with pytest.raises(InputError, match=field):
        find_worst(**{"width": 16, "height": 16, "interpolant": "depth", "fraction_bits": 3,
                      "seed": 0} | changes)


def test_the_command_prints_its_table():
    done = CliRunner().invoke(bound_search.main, ["--size", "32x24", "--fraction-bits", "2",
                                                  "--fraction-bits", "6", "--seeds", "2"])
    assert done.exit_code == 0, done.output
    rows = [line.split() for line in done.output.splitlines() if line[:5] in INTERPOLANTS]
    assert [row[:2] for row in rows] == [[name, bits] for name in INTERPOLANTS for bits in "26"]
    for row in rows:
        assert float(row[2]) == pytest.approx(55 / 2 ** (int(row[1]) + 1), rel=1e-3)
        assert 0.9 < float(row[4]) <= 1
    done = CliRunner().invoke(bound_search.main, ["--size", "4x4"])
    assert done.exit_code == 2 and "width: 4" in done.output


def test_the_command_fails_where_the_bound_is_exceeded(monkeypatch):
    monkeypatch.setattr(fixed_point, "error_bound",
                        lambda fraction_bits, extent: Fraction(extent, 1 << fraction_bits + 1))
    done = CliRunner().invoke(bound_search.main, ["--size", "8x8", "--fraction-bits", "2",
                                                  "--seeds", "8"])
    assert done.exit_code == 1, done.output
