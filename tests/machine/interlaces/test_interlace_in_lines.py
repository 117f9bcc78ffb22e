"""Processing elements have whole lines in turn: the same picture as of any other interlace."""


import numpy as np
import pytest
from frames import draw, random_list, spans_twice
from suite.cases import EVERY
from wide_machines import wide_machine

from cardcage.golden.reference import exact
from cardcage.golden.reference.exact import fragments
from cardcage.golden.specification.commands import Fault, ResponseKind
from cardcage.testbenches.engines.engine import Job
from cardcage.testbenches.engines.pysim_engine import PysimEngine
from cardcage.testbenches.frames.simulation import simulate


@pytest.mark.parametrize(("cards", "size", "options"), [
    ("PM", (7, 5), {"memory_ports": 2}),
    ("2x(PM)", (13, 9), {"setup": "hardware", "setup_interval": 16}),
    ("4x(PMM)", (9, 7), {"memory_ports": 2}),
    pytest.param("8x(PM)", (6, 13), {}, marks=EVERY),
    pytest.param("2x(PMPMC)", (7, 6), {"packet": 1}, marks=EVERY),
    ("2x(PMMT)", (6, 5), {"packet": 1}),
])
def test_every_number_of_elements_draws_the_picture(cards, size, options):
    listed = random_list(51, 7, width=size[0], height=size[1])
    simulation = draw(listed, cards=cards, lines=True, **options)
    if "packet" in options:
        return
    elements = len(simulation.work)
    line = np.bincount(fragments(listed).y, minlength=size[1])
    assert [element.fragments for element in simulation.work] == [
        line[element::elements].sum() for element in range(elements)]


def test_overdrawn_pixels_in_lines():
    """Fragments follow one another on the same pixels, and in both units of each line."""
    draw(spans_twice(16, 8), cards="2x(PMM)", lines=True)


@pytest.mark.parametrize(("cards", "resolution"), [("2x(PMM)", (16, 8)), ("PMM", (8, 8))])
def test_boards_pulled_share_by_share(cards, resolution):
    """Cards built for 8 units of 32 words."""
    simulation = draw(random_list(24, 6, width=16, height=16), cards=cards, lines=True, words=32,
                      maximum_units=8)
    assert simulation.resolution == resolution


def test_shares_that_boards_pulled_made_unequal_are_refused():
    configuration = wide_machine(random_list(1, 1), cards="PMMPMP M", lines=True,
                                 allow_orphans=True, maximum_units=8, clocks_per_pixel=2,
                                 fraction_bits=20)
    job = Job(configuration, commands=[1], responses=5, maximum_cycles=2000)
    responses = PysimEngine().run(job).responses
    assert responses[-1][:2] == (ResponseKind.ERROR, Fault.UNITS_UNSUPPORTED)


@pytest.mark.parametrize("units", [1, 2])
def test_three_elements_have_regions_of_a_line_each(units):
    """What is named in place of lines: line i is element i modulo 3's, its pixels side by side in
    its units."""
    listed = random_list(52, 6, width=9, height=8)
    configuration = wide_machine(listed, cards=f"3x(P{'M' * units})", regions=(1, 8),
                                 balance="static", clocks_per_pixel=2)
    simulation = simulate(configuration, listed, PysimEngine(), memory_seed=1)
    picture = exact.draw(listed)
    np.testing.assert_array_equal(simulation.video, picture.color)
    np.testing.assert_array_equal(simulation.depth, picture.depth)
    line = np.bincount(fragments(listed).y, minlength=8)
    assert [element.fragments for element in simulation.work] == [
        line[element::3].sum() for element in range(3)]
