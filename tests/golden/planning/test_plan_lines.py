"""Plans of machines: fields given, errors allowed, and the lines that explain."""

import time
from dataclasses import replace
from math import ceil

import numpy as np
import pytest
from plan_scenes import CARDS, random_list, triangles

from cardcage.golden.planning.machine_plan import plan, triangle_bits
from cardcage.golden.planning.presets import PRESETS
from cardcage.golden.planning.scene_needs import fitted, scene_needs
from cardcage.golden.reference import bit_true, exact
from cardcage.golden.reference.triangle_setup import scene_fraction_bits
from cardcage.golden.scene_display_list import make_display_list
from cardcage.golden.specification import fixed_point
from cardcage.golden.specification.errors import InputError
from cardcage.golden.specification.fixed_point import error_fraction_bits, on_screen_fraction_bits


@pytest.mark.parametrize("extent", [0, 1, 7, 30, 1022, 8190])
def test_bits_for_an_error_are_the_fewest(extent):
    for error in (1, 2, 5, 100, 5000):
        bits = error_fraction_bits(extent, error)
        assert ceil(fixed_point.error_bound(bits, extent)) <= error
        assert bits == 0 or ceil(fixed_point.error_bound(bits - 1, extent)) > error


@pytest.mark.parametrize("error", [1, 2, 7])
@pytest.mark.parametrize("seed", range(3))
def test_the_error_asked_for_is_kept(seed, error):
    """By the picture that the datapath's model draws, whoever wins its pixels."""
    display_list = random_list(seed, 30)
    machine = plan(display_list, cards=CARDS, max_error=error).configuration
    assert machine.fraction_bits < scene_fraction_bits(display_list)
    drawn = bit_true.draw(fitted(machine, display_list), fraction_bits=machine.fraction_bits)
    assert abs(drawn.depth - exact.draw(display_list).depth).max() <= error


def test_small_triangles_take_fewer_bits_than_the_screen():
    scene = make_display_list("sphereflake:depth=1", width=256, height=256).display_list
    planned = plan(scene, cards=CARDS, max_error=1)
    assert planned.full.fraction_bits == on_screen_fraction_bits(256, 256, 8, 1) == 8
    assert planned.configuration.fraction_bits < 8


def test_never_more_bits_than_exact():
    display_list = triangles([[8, 8], [9, 24], [24, 9]])
    exact_bits = scene_fraction_bits(display_list)
    assert plan(display_list, cards=CARDS, max_error=1).configuration.fraction_bits <= exact_bits
    assert on_screen_fraction_bits(1, 1, 8, max_error=1) <= on_screen_fraction_bits(1, 1, 8)


@pytest.mark.parametrize("flat", [True, False])
def test_fields_that_are_given(flat):
    """The list's own formats may be given too, as they are in a preset; others are refused."""
    display_list = random_list(3)
    if flat:
        display_list = replace(display_list, color=display_list.color[:, :1].repeat(3, axis=1))
    machine = plan(display_list, cards=CARDS).configuration
    assert (machine.width, machine.height, machine.depth_bits) == (
        display_list.width, display_list.height, display_list.depth_bits)
    assert machine.shading == ("flat" if flat else "gouraud")
    given = {"fraction_bits": 3, "shading": "gouraud", "fifo_depth": 5, "clocks_per_pixel": 3}
    changed = plan(display_list, **PRESETS["tiny"] | given).configuration
    assert {name: getattr(changed, name) for name in given} == given
    assert changed.cards == PRESETS["tiny"]["cards"]
    for name in ("width", "height", "depth_bits"):
        with pytest.raises(InputError, match=f"^{name}: the display list has"):
            plan(display_list, cards=CARDS, **{name: 1 + getattr(display_list, name)})


@pytest.mark.parametrize("arguments", [
    {"max_error": -1}, {"max_error": 1 << 32}, {"max_error": 1.5}, {"max_error": True},
    {"max_error": 2, "fraction_bits": 3}, {"fraction_bits": 65},
])
def test_refused(arguments):
    with pytest.raises(InputError, match=r"max.error|fraction.bits"):
        plan(random_list(1), cards=CARDS, **arguments)


def test_an_empty_list():
    empty = replace(random_list(1), position=np.zeros((0, 3, 2), np.int32),
                    depth=np.zeros((0, 3), np.int64), color=np.zeros((0, 3, 3), np.uint8))
    planned = plan(empty, cards=CARDS)
    machine = planned.configuration
    assert (machine.fraction_bits, machine.shading, machine.fifo_depth) == (0, "flat", 2)
    assert fitted(machine, empty).triangles == 0
    assert all(line.reason for line in planned.lines)


def test_what_is_given_is_not_planned():
    display_list = random_list(2)
    planned = plan(display_list, cards="PM", fraction_bits=7, shading="gouraud", fifo_depth=9,
                   words=64, edge_column_bits=6)
    machine = planned.configuration
    assert (machine.fraction_bits, machine.fifo_depth, machine.edge_column_bits) == (7, 9, 6)
    assert machine.words == planned.full.words == 64
    assert planned.needs == scene_needs(display_list, x_shift=machine.interlace.x_shift,
                                        y_shift=machine.interlace.y_shift)


def test_lines_say_what_the_machine_has():
    """Every number is the configuration's; what a line saves, the triangle's words lack."""
    scene = make_display_list("tetra", width=64, height=64).display_list
    planned = plan(scene, cards=CARDS)
    machine, full, lines = planned.configuration, planned.full, {line.item: line
                                                                for line in planned.lines}
    for item, field in (("sub-pixel bits", "sub_bits"), ("coordinate bits", "coordinate_bits"),
                        ("edge column bits", "edge_column_bits"), ("FIFO depth", "fifo_depth"),
                        ("edge height bits", "edge_height_bits"),
                        ("fraction bits", "fraction_bits")):
        assert (lines[item].value, lines[item].full) == (str(getattr(machine, field)),
                                                         str(getattr(full, field)))
    assert lines["depth integer bits"].value == str(machine.depth_integer_bits)
    assert (lines["interpolants"].value, lines["interpolants"].full) == ("depth", "depth, colour")
    assert lines["interpolants"].saves == triangle_bits(full) - triangle_bits(
        replace(full, shading="flat"))
    assert "no colour interpolator" in lines["interpolants"].reason
    assert "no line stepper" in lines["lines"].reason
    for name in ("edge_column_bits", "edge_height_bits"):
        saved = triangle_bits(full) - triangle_bits(replace(full, edge_fraction_bits=0, **{
            name: getattr(machine, name)}))
        assert lines[name.replace("_", " ")].saves == saved > 0
    assert triangle_bits(machine) < triangle_bits(full) / 2
    assert f"{planned.needs.exact_double_area:,}" in lines["fraction bits"].reason
    assert str(planned.needs.columns[1]) in lines["edge column bits"].reason


def test_fifos_hold_no_more_than_there_is():
    one = triangles([[8, 8], [100, 24], [12, 72]])
    assert plan(one, cards=CARDS).configuration.fifo_depth == 2
    several = triangles(*[[[8, 8], [100, 24], [12, 72]]] * 6)
    assert plan(several, cards=CARDS).configuration.fifo_depth == 7
    many = triangles(*[[[8, 8], [100, 24], [12, 72]]] * 60)
    assert plan(many, cards=CARDS).configuration.fifo_depth == 16


def test_quick():
    """Two seconds for fifty thousand triangles, by the clock of this process alone."""
    scene = make_display_list("teapot:tessellation=28", width=512, height=512).display_list
    assert scene.triangles > 49_000
    began = time.process_time()
    plan(scene, cards=CARDS)
    assert time.process_time() - began < 2
