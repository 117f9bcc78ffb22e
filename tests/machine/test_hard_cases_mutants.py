"""Broken rounding, bias, saturation and widths: each is caught by a hard case made for it.

Not by chance: what the broken machine draws is predicted, pixel by pixel, in
fractions, and so is every pixel where that is wrong.
"""

import inspect
import sys
import types
from dataclasses import replace
from fractions import Fraction
from math import ceil, floor

import numpy as np
import pytest
from amaranth.hdl import Const
from suite.cases import EVERY

from cardcage.golden.hard_cases.catalogue import hard_case
from cardcage.golden.hard_cases.rational import covered
from cardcage.golden.reference import bit_true, exact
from cardcage.golden.reference import triangle_setup as golden_setup
from cardcage.golden.reference.triangle_setup import scene_fraction_bits
from cardcage.golden.specification import fixed_point
from cardcage.golden.specification.configuration import MachineConfiguration
from cardcage.golden.specification.fixed_point import error_bound
from cardcage.golden.specification.sampling_grid import Grid
from cardcage.testbenches.engines.pysim_engine import PysimEngine
from cardcage.testbenches.frames.simulation import simulate


def nearest(value):
    return floor(value + Fraction(1, 2))


def carried_depths(display_list, fraction_bits, *, rounded=nearest, bias=Fraction(1, 2)):
    """{(x, y): floored depth} of triangles that do not overlap, as a datapath would carry them.

    ``rounded`` takes start and slopes to multiples of 2**-F; ``bias`` is in multiples of 1/D.
    """
    unit, depths = 1 << display_list.sub_bits, {}
    for corners, depth in zip(display_list.position.tolist(), display_list.depth.tolist(),
                              strict=True):
        (x0, y0), (x1, y1), (x2, y2) = corners
        doubled = (x1 - x0) * (y2 - y0) - (x2 - x0) * (y1 - y0)
        rise1, rise2 = depth[1] - depth[0], depth[2] - depth[0]
        slope_x = Fraction(rise1 * (y2 - y0) - rise2 * (y1 - y0), doubled)
        slope_y = Fraction(rise2 * (x1 - x0) - rise1 * (x2 - x0), doubled)
        # The first column and row with a centre in the triangle's box.
        left, top = (max(0, -((unit // 2 - min(corner[axis] for corner in corners)) // unit))
                     for axis in (0, 1))
        corner_depth = (depth[0] + slope_x * (left * unit + unit // 2 - x0)
                        + slope_y * (top * unit + unit // 2 - y0))
        area = abs(doubled)
        start, step_x, step_y = (
            rounded(value * 2**fraction_bits)
            for value in (corner_depth + (area // 2 + bias) / area, slope_x * unit, slope_y * unit))
        for (x, y), _ in covered(corners, Grid.of(display_list)):
            assert (x, y) not in depths
            depths[x, y] = start + (x - left) * step_x + (y - top) * step_y >> fraction_bits
    return depths


def image(display_list, depths):
    """int64 (height, width): ``depths`` before the background."""
    result = np.full((display_list.height, display_list.width), display_list.depth_limit + 1)
    for (x, y), depth in depths.items():
        result[y, x] = depth
    return result


def machine_for(display_list, fraction_bits, **widths):
    """The host sets triangles up; every width but those given is wide enough for all."""
    return MachineConfiguration(
        cards="PM", width=display_list.width, height=display_list.height,
        fraction_bits=fraction_bits, clocks_per_pixel=2, setup="host", **widths)


def assert_caught(name, display_list, configuration, predicted, record_property, what):
    """The broken machine draws the predicted depths, and some are not allowed: they are not the
    exact ones, or below exact precision not within the bound."""
    simulation = simulate(configuration, display_list, PysimEngine(), memory_seed=1)
    np.testing.assert_array_equal(simulation.depth, predicted)
    bits, allowed = configuration.fraction_bits, 0
    if bits < scene_fraction_bits(display_list):
        allowed = ceil(error_bound(bits, display_list.width + display_list.height - 2))
    error = abs(simulation.depth - exact.draw(display_list).depth)
    wrong = int((error > allowed).sum())
    assert wrong
    record_property("measured", f"{what}: caught by hard:{name} at {bits} fraction bits, {wrong} "
                    f"depths off by more than {allowed} LSB, all as predicted")
    return simulation.video


@pytest.mark.parametrize("name", ["sliver-half-way-depths", "half-way-depths",
                                  "drift-past-both-ends"])
def test_the_prediction_is_right_for_what_is_not_broken(name):
    display_list = hard_case(name).make()
    bits = scene_fraction_bits(display_list)
    assert np.array_equal(image(display_list, carried_depths(display_list, bits)),
                          exact.draw(display_list).depth)


@EVERY
def test_slopes_truncated_instead_of_rounded(monkeypatch, record_property):
    """29 steps of 8/5 units too low come to more than the half spacing that the bias leaves."""
    name = "sliver-half-way-depths"
    display_list = hard_case(name).make()
    bits = scene_fraction_bits(display_list)
    predicted = image(display_list, carried_depths(display_list, bits, rounded=floor))
    monkeypatch.setattr(fixed_point, "round_half_up_divide", lambda dividend, divisor:
                        dividend // divisor)
    assert_caught(name, display_list, machine_for(display_list, bits), predicted, record_property,
                  "truncated slopes")
    low = exact.draw(display_list).depth - predicted
    assert set(np.unique(low)) == {0, 1}  # one LSB too near, at far pixels that are half-way
    assert [int(x) for y, x in np.argwhere(low)] == [23, 28]


def test_no_bias_of_half_a_spacing(monkeypatch, record_property):
    """Half-way depths are on the edge of the floor: any slope rounded down takes them below."""
    name = "half-way-depths"
    display_list = hard_case(name).make()
    bits = scene_fraction_bits(display_list)
    predicted = image(display_list, carried_depths(display_list, bits, bias=Fraction(0)))
    source = inspect.getsource(golden_setup)
    right = "biased = 2 * numerator + 2 * (area // 2) + 1"
    assert source.count(right) == 1
    mutant = types.ModuleType(golden_setup.__name__)
    mutant.__package__ = golden_setup.__package__
    monkeypatch.setitem(sys.modules, golden_setup.__name__, mutant)
    exec(compile(source.replace(right, right.removesuffix(" + 1")), golden_setup.__file__, "exec"),
         mutant.__dict__)
    monkeypatch.setattr("cardcage.testbenches.frames.frame_job.prepare", mutant.prepare)
    assert_caught(name, display_list, machine_for(display_list, bits), predicted, record_property,
                  "no bias")
    # With 2**31 the slope of -1/3 is rounded down: every third row of the lower half, but the
    # first, where the start's own rounding up still makes good for it.
    y, x = np.nonzero(predicted != exact.draw(display_list).depth)
    assert set(y - 4) == {4, 7, 10, 13, 16, 19, 22} and (x + y >= 31).all()


def test_wrapped_instead_of_saturated(monkeypatch, record_property):
    """Without fraction bits a slope of 1/2 is 1 and one of -5/8 is -1: past both ends."""
    name = "drift-past-both-ends"
    display_list = hard_case(name).make()
    carried = carried_depths(display_list, 0)
    high = display_list.depth_limit
    assert min(carried.values()) < 0 and max(carried.values()) > high + 1
    wrapped = {pixel: depth % (high + 2) for pixel, depth in carried.items()}
    monkeypatch.setattr("cardcage.hdl.rasteriser.interpolator.saturate",
                        lambda value, low, high: value[:len(Const(high))])
    video = assert_caught(name, display_list, machine_for(display_list, 0),
                          image(display_list, wrapped), record_property, "no saturation")
    right = bit_true.draw(display_list, fraction_bits=0)  # which is the frame, at this size
    assert ((video < 16) & (right.color == 255)).any(), "white is nearly black"


def unchecked(monkeypatch):
    """The host sends lists that do not fit the machine."""
    monkeypatch.setattr("cardcage.testbenches.frames.frame_job.fitted",
                        lambda configuration, display_list: display_list)


@EVERY
def test_a_depth_word_one_bit_too_narrow(monkeypatch, record_property):
    """Carried depths beyond twice the range come back as negative ones, so as the nearest."""
    name = "drift-past-both-ends"
    display_list = hard_case(name).make()
    full = machine_for(display_list, 0).depth_plane_bits
    high = display_list.depth_limit
    narrow = {pixel: fixed_point.saturate(fixed_point.to_signed(depth, full - 1), 0, high)
              for pixel, depth in carried_depths(display_list, 0).items()}
    unchecked(monkeypatch)
    assert_caught(name, display_list, machine_for(display_list, 0, depth_integer_bits=full - 1),
                  image(display_list, narrow), record_property, "depth word a bit too narrow")


@EVERY
def test_an_edge_column_one_bit_too_narrow(monkeypatch, record_property):
    """The right edge in column 64 comes back in column -64: its half of the screen is gone."""
    name = "coordinate-ends"
    display_list = hard_case(name).make()
    bits = scene_fraction_bits(display_list)
    right = exact.draw(display_list)
    y, x = np.indices(right.depth.shape)
    predicted = np.where(x >= y, display_list.depth_limit + 1, right.depth)
    full = machine_for(display_list, bits)
    unchecked(monkeypatch)
    narrow = replace(full, edge_column_bits=full.edge_column_bits - 1)
    assert_caught(name, display_list, narrow, predicted, record_property,
                  "edge column a bit too narrow")
