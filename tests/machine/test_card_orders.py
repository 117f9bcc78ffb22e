"""Any legal order of the cards, and any number of units, draws the same display list."""

import itertools

import numpy as np
import pytest
from frames import check_bit_true, draw, golden_picture, random_list
from suite.cases import EVERY
from wide_machines import wide_machine

from cardcage.testbenches.engines.pysim_engine import PysimEngine
from cardcage.testbenches.frames.simulation import simulate

LIST = random_list(7, 12, width=16, height=16)

#: 2 processing elements and 4 memory units, one processing element left of every unit.
ORDERS = sorted({"P" + "".join(rest) for rest in itertools.permutations("PMMMM")})


@EVERY
def test_every_legal_order_gives_the_same_picture():
    assert len(ORDERS) == 5
    pictures, work = [], {}
    for order in ORDERS:
        simulation = draw(LIST, cards=order)  # equal to golden, so equal to each other
        pictures.append(simulation.video)
        work[order] = [element.fragments for element in simulation.work]
    for picture in pictures[1:]:
        np.testing.assert_array_equal(picture, pictures[0])
    # The orders are different machines all the same: the work falls differently.
    assert len({tuple(sorted(share)) for share in work.values()}) > 1, work
    assert work["PMMPMM"] != work["PMPMMM"]


@EVERY
def test_coarse_precision_gives_every_order_the_same_errors():
    """On lattices of one, two and four units the strides are multiples of the one increment."""
    pictures = []
    for cards in ("PM", "PMM", "PMPMMM", "PMMMPM"):
        configuration = wide_machine(LIST, cards=cards, fraction_bits=0,
                                  clocks_per_pixel=2)
        simulation = simulate(configuration, LIST, PysimEngine(), memory_seed=4)
        check_bit_true(configuration, LIST, simulation)
        pictures.append((simulation.video, simulation.depth))
    for video, depth in pictures[1:]:
        np.testing.assert_array_equal(video, pictures[0][0])
        np.testing.assert_array_equal(depth, pictures[0][1])
    exact = golden_picture(configuration, LIST)
    assert (exact.depth != depth).any() and (exact.color != video).any()


@pytest.mark.parametrize(("cards", "skew"), [
    ("PMMMPM", False), ("PMPMMPPMP", False), ("PPMMMMMMMMPMMMMPMMPMM", True),
    pytest.param("PPMMMMMMMMPMMMMPMMPMM", False, marks=EVERY),
    pytest.param("2x(PMPMMM)", False, marks=EVERY)])
def test_shares_need_not_be_equal_nor_present(cards, skew):
    draw(random_list(8, 8, width=16, height=16), cards=cards, seed=3, skew=skew)


@EVERY
def test_a_skewed_interlace_gives_the_same_picture():
    """Of one unit each, of pairs, and of what is neither; and with set-up by either side."""
    options = {"PMPMMM": {"setup": "hardware"}, "PMMMM": {"memory_ports": 2}}
    skewed = {cards: draw(LIST, cards=cards, skew=True, **options.get(cards, {}))
              for cards in ("PMM", "4x(PM)", "2x(PMM)", *options)}
    for cards, different in (("4x(PM)", True), ("2x(PMM)", False)):
        plain = draw(LIST, cards=cards)
        for simulation in skewed.values():
            np.testing.assert_array_equal(simulation.video, plain.video)
            np.testing.assert_array_equal(simulation.depth, plain.depth)
        # The pixels of one unit are others, those of a pair the same.
        one, other = ([element.fragments for element in simulation.work]
                      for simulation in (plain, skewed[cards]))
        assert (one != other) == different


@pytest.mark.parametrize(("units", "skew"), [
    (1, False), (8, True), pytest.param(2, False, marks=EVERY),
    pytest.param(16, False, marks=EVERY), pytest.param(4, False, marks=EVERY),
    pytest.param(8, False, marks=EVERY)])
def test_fewer_units_of_fixed_words_draw_a_coarser_picture(units, skew):
    """32 words: eight units hold the 256 pixels, one unit an eighth of them."""
    simulation = draw(LIST, cards="P" + "M" * units, words=32, maximum_units=16, skew=skew)
    resolutions = {1: (8, 4), 2: (8, 8), 4: (16, 8), 8: (16, 16), 16: (16, 16)}
    assert simulation.resolution == resolutions[units]


@pytest.mark.parametrize(("width", "height", "cards", "skew"), [
    (5, 9, "PMMMMPMMMM", False), (1, 1, "PMM", False), (13, 7, "PMPMMM", True),
    (3, 2, "8x(PM)", True), pytest.param(13, 7, "PMMPMM", False, marks=EVERY),
    pytest.param(3, 2, "4x(PMM)", False, marks=EVERY)])
def test_sizes_that_are_no_multiple_of_the_interlace(width, height, cards, skew):
    draw(random_list(9, 8, width=width, height=height), cards=cards, skew=skew)
