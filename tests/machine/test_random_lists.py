"""Random display lists by random card orders: what leaves the machine is what golden draws."""

import numpy as np
import pytest
from frames import check_bit_true, draw, triangles
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from suite.cases import chosen
from wide_machines import wide_machine

from cardcage.testbenches.engines.pysim_engine import PysimEngine
from cardcage.testbenches.frames.simulation import simulate

WIDTH, HEIGHT, SUB_BITS, DEPTH_BITS = 8, 6, 4, 10
LIMIT = 16  # pixels of guard band to either side of the origin

on_grid = st.integers(-LIMIT * 2**SUB_BITS, LIMIT * 2**SUB_BITS - 1)
near = st.integers(-2 * 2**SUB_BITS, 10 * 2**SUB_BITS)
half_pixels = st.integers(-2, 20).map(lambda n: n * 2 ** (SUB_BITS - 1))
coordinate = st.one_of(near, half_pixels, on_grid)
vertex = st.tuples(coordinate, coordinate, st.integers(0, 2**DEPTH_BITS - 2),
                   st.tuples(*[st.integers(0, 255)] * 3))


@st.composite
def display_lists(draw):
    """Triangles that share edges, repeat, are slivers, have no area or lie off the screen."""
    faces = []
    for _ in range(draw(st.integers(0, 6))):
        kind = draw(st.sampled_from(["free", "fan", "copy", "sliver", "point"]))
        face = [draw(vertex) for _ in range(3)]
        if faces and kind == "fan":
            face[:2] = faces[-1][1:]
        elif faces and kind == "copy":
            face = faces[draw(st.integers(0, len(faces) - 1))]
        elif kind == "sliver":
            x, y, *rest = face[0]
            face[1] = (min(x + 1, LIMIT * 2**SUB_BITS - 1), y, *rest)
        elif kind == "point":
            face[2] = face[1]
        faces.append(face)
    return triangles(
        [[[x / 2**SUB_BITS, y / 2**SUB_BITS] for x, y, _, _ in face] for face in faces],
        [[depth for _, _, depth, _ in face] for face in faces],
        [[color for _, _, _, color in face] for face in faces],
        width=WIDTH, height=HEIGHT, sub_bits=SUB_BITS, depth_bits=DEPTH_BITS)


@st.composite
def card_orders(draw):
    """1 to 8 units and any number of processing elements among them, one of them leftmost."""
    units = 2 ** draw(st.integers(0, 3))
    extra = draw(st.lists(st.integers(0, units), max_size=3))
    return "P" + "".join("P" * extra.count(place) + "M" for place in range(units)) + (
        "P" * extra.count(units))


#: Of five examples each.
ROUNDS = chosen(range(4), 0)

once = settings(max_examples=5, deadline=None, print_blob=True,
                suppress_health_check=[HealthCheck.too_slow, HealthCheck.data_too_large])


@pytest.mark.parametrize("_round", ROUNDS)
@once
@given(display_lists(), card_orders(), st.integers(0, 2**32), st.sampled_from([2, 3, 4]))
def test_the_machine_draws_what_golden_draws(_round, display_list, cards, seed, clocks_per_pixel):
    draw(display_list, cards=cards, seed=seed, clocks_per_pixel=clocks_per_pixel)


@pytest.mark.parametrize("_round", ROUNDS)
@once
@given(display_lists(), card_orders(), st.integers(0, 2**32), st.integers(0, 12),
       st.sampled_from(["flat", "gouraud"]))
def test_below_exact_the_machine_is_its_bit_true_model(_round, display_list, cards, seed,
                                                       fraction_bits, shading):
    configuration = wide_machine(display_list, cards=cards, fraction_bits=fraction_bits,
                              shading=shading, clocks_per_pixel=2)
    simulation = simulate(configuration, display_list, PysimEngine(), memory_seed=seed,
                          stall_seed=seed)
    check_bit_true(configuration, display_list, simulation)


def test_a_list_without_triangles_is_all_background():
    simulation = draw(triangles([], [], []), cards="PM")
    assert (simulation.video == np.array([12, 34, 56])).all()
