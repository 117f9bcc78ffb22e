"""Boards pulled out of the cage: it renumbers itself and keeps drawing."""

import pytest
from frames import check, expected_video, golden_picture, random_list
from suite.cases import EVERY
from wide_machines import wide_machine

from cardcage.golden.specification.commands import ResponseKind
from cardcage.testbenches.engines.engine import Job
from cardcage.testbenches.engines.pysim_engine import PysimEngine
from cardcage.testbenches.frames.simulation import simulate

LIST = random_list(11, 10, width=16, height=16)


def cage(cards, **options):
    """Cards built for up to 16 units of 16 words: 16 of them hold 16 by 16."""
    return wide_machine(LIST, cards=cards, words=16, maximum_units=16, clocks_per_pixel=2,
                        **options)


@pytest.mark.parametrize(("cards", "resolution"), [
    pytest.param("PMMMMMMMM PMMMMMMMM", (16, 16), marks=EVERY),
    ("PMMMM PMMMM", (16, 8)),  # half the units: y halves first
    ("PMM PMM", (8, 8)),
    ("PM PM", (8, 4)),
    ("PM P", (4, 4)),
])
def test_units_are_renumbered_and_the_total_returned(cards, resolution):
    configuration = cage(cards)
    simulation = simulate(configuration, LIST, PysimEngine(), memory_seed=5)
    check(configuration, LIST, simulation)
    assert simulation.resolution == resolution
    assert simulation.total == configuration.units == simulation.owned
    firsts = [work.first_unit for work in simulation.work]
    assert firsts == [configuration.cards[:place].count("M")
                      for place, card in enumerate(configuration.cards) if card == "P"]


def test_units_left_of_every_processing_element_belong_to_nobody():
    configuration = cage("MMPMPM", allow_orphans=True)
    simulation = simulate(configuration, LIST, PysimEngine(), memory_seed=5)
    assert (simulation.owned, simulation.total) == (2, 4)
    assert [work.first_unit for work in simulation.work] == [2, 3]
    # Nobody's pixels are not drawn; everybody else's are, and right.
    picture = golden_picture(configuration, LIST)
    owned = simulation.depth >= 0
    assert owned.sum() * 2 == owned.size
    assert (simulation.depth[owned] == picture.depth[owned]).all()
    video = expected_video(configuration, picture.color)
    shown = owned.repeat(2, axis=0).repeat(2, axis=1)
    assert (simulation.video[shown] == video[shown]).all()


def test_a_number_of_units_that_is_no_power_of_two_is_refused_and_does_not_hang():
    configuration = cage("PMMM", allow_orphans=True, fraction_bits=20)
    job = Job(configuration, commands=[1, 4], responses=1 + 1 + 3, maximum_cycles=2000)
    kinds = [kind for kind, _, _ in PysimEngine().run(job).responses]
    assert kinds == [ResponseKind.DOMAIN, ResponseKind.UNITS] + 3 * [ResponseKind.ERROR]
