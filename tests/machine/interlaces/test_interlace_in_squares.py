"""Processing elements interlace in squares of pixels: the same picture, whatever their side."""


import numpy as np
import pytest
from frames import draw, random_list, spans_twice
from suite.cases import EVERY
from wide_machines import wide_machine

from cardcage.golden.reference.exact import depth_complexity
from cardcage.golden.specification.commands import Fault, ResponseKind
from cardcage.testbenches.engines.engine import Job
from cardcage.testbenches.engines.pysim_engine import PysimEngine

SIZE = {"width": 13, "height": 9}


@pytest.mark.parametrize(("cards", "seed"), [
    ("2x(PMM)", 44), pytest.param("2x(PM)", 11, marks=EVERY),
    pytest.param("4x(PMM)", 41, marks=EVERY)])
def test_the_same_picture_for_every_side(cards, seed):
    listed = random_list(seed, 8, **SIZE)
    assert depth_complexity(listed).sum() > 150
    simulations = {block: draw(listed, cards=cards, block=block) for block in (1, 2, 4, 8)}
    for simulation in simulations.values():  # each is equal to golden already
        np.testing.assert_array_equal(simulation.video, simulations[1].video)
        np.testing.assert_array_equal(simulation.depth, simulations[1].depth)
    # They are different machines all the same: the work falls differently.
    work = {tuple(element.fragments for element in simulation.work)
            for simulation in simulations.values()}
    assert len(work) > 2, work


@pytest.mark.parametrize(("width", "height", "cards", "block", "options"), [
    (19, 6, "2x(PMMMM)", 4, {"memory_ports": 2}),
    (7, 6, "2x(PM)", 2, {"setup": "hardware"}),
    pytest.param(9, 17, "PMM", 8, {}, marks=EVERY),
    (7, 5, "2x(PMM)", 32, {}),  # the second has no pixel
])
def test_sizes_shares_and_sides(width, height, cards, block, options):
    draw(random_list(18, 6, width=width, height=height), cards=cards, block=block, **options)


def test_overdrawn_pixels_in_squares():
    """Fragments follow one another on the same pixels, and in one unit of each square."""
    draw(spans_twice(16, 8), cards="2x(PMM)", block=4)


@pytest.mark.parametrize(("cards", "resolution"), [
    ("2x(PMM)", (16, 8)), ("PMM", (8, 8)), pytest.param("4x(PMM)", (16, 16), marks=EVERY)])
def test_boards_pulled_share_by_share(cards, resolution):
    """Cards built for 8 units of 32 words."""
    simulation = draw(random_list(24, 6, width=16, height=16), cards=cards, block=4, words=32,
                      maximum_units=8)
    assert simulation.resolution == resolution


@pytest.mark.parametrize("cards", ["PMMPMP M", "PMMPMMMM PMM"])
def test_shares_that_boards_pulled_made_unequal_are_refused(cards):
    configuration = wide_machine(random_list(1, 1), cards=cards, block=4, allow_orphans=True,
                              maximum_units=8, clocks_per_pixel=2, fraction_bits=20)
    elements = configuration.processing_elements
    job = Job(configuration, commands=[1, 4], responses=elements + 1 + 3, maximum_cycles=2000)
    responses = PysimEngine().run(job).responses
    assert [kind for kind, _, _ in responses] == [
        *[ResponseKind.DOMAIN] * elements, ResponseKind.UNITS, *[ResponseKind.ERROR] * 3]
    assert responses[-1][1] == Fault.UNITS_UNSUPPORTED
