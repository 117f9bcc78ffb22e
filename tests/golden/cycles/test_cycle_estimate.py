"""The estimate of cycles: its exact parts against brute force, and the cards it chooses.

How near it comes to simulated frames is in ``tests/machine/test_planned_machines.py``.
"""

import itertools

import numpy as np
import pytest

from cardcage.golden.cycles.cycle_estimate import cards_for_cycles, estimate_cycles, visible_share
from cardcage.golden.reference import exact
from cardcage.golden.scene_display_list import make_display_list
from cardcage.golden.specification.card_order import domains
from cardcage.golden.specification.configuration import MachineConfiguration
from cardcage.golden.specification.errors import InputError

SCENE = make_display_list("random:n=60,size=20,seed=3", width=48, height=40).display_list


@pytest.mark.parametrize("cards", ["PM", "PMM", "PMMMMMMMM", "2x(PMM)", "PMPMMM", "PMMMMMMMPM",
                                   "PPMMPM PMMMMM", "8x(PM)"])
@pytest.mark.parametrize("words", [0, 64])
def test_fragments_of_each_processing_element(cards, words):
    """Every fragment counted where its unit is, one by one."""
    machine = MachineConfiguration(cards, 48, 40, words=words)
    interlace = machine.interlace
    found = exact.fragments(SCENE, x_shift=interlace.x_shift, y_shift=interlace.y_shift)
    units = interlace.unit(found.x.astype(np.int64), found.y.astype(np.int64))
    expected = [int(((first <= units) & (units < first + count)).sum())
                for first, count in domains(machine.cards)]
    estimate = estimate_cycles(machine, SCENE)
    assert estimate.fragments.tolist() == expected and sum(expected) > 0
    # No fragment is faster than one a clock, and no triangle than three.
    assert (estimate.draw >= estimate.fragments).all()
    owners = [count > 0 for _, count in domains(machine.cards)]
    assert (estimate.draw[owners] > 0).all()
    assert estimate.total > estimate.draw.max()


def test_visible_share_is_the_mean_over_all_orders():
    for depth in (1, 2, 3, 5):
        written = [sum(order[place] == min(order[:place + 1]) for place in range(depth))
                   for order in itertools.permutations(range(depth))]
        complexity = np.full((2, 3), depth, np.int32)
        assert visible_share(complexity) == pytest.approx(np.mean(written) / depth)
    assert visible_share(np.zeros((2, 2), np.int32)) == 0
    mixed = np.array([[0, 1, 4]], np.int32)
    assert visible_share(mixed) == pytest.approx((1 + 1 + 1 / 2 + 1 / 3 + 1 / 4) / 5)


def test_nothing_to_draw_takes_no_pass_over_memory():
    machine = MachineConfiguration("PM", 48, 40)
    empty = make_display_list("random:n=1,size=0.125", width=48, height=40).display_list
    assert estimate_cycles(machine, empty).total < 48 * 40 / 10


def test_two_ports_draw_a_fragment_a_clock_beside_the_scan():
    machine = MachineConfiguration("PM", 48, 40, memory_ports=2)
    estimate = estimate_cycles(machine, SCENE)
    assert (estimate.draw >= estimate.fragments).all()
    assert estimate.draw.sum() < 0.75 * estimate_cycles(
        MachineConfiguration("PM", 48, 40), SCENE).draw.sum()


def test_cards_for_a_number_of_cycles():
    """They suffice; of fewer processing elements no cage does."""
    fields = {"clocks_per_pixel": 4}
    fastest = 10**9
    for elements, units in itertools.product((1, 2), (1, 2, 4)):
        cards = f"{elements}x(P{'M' * units})"
        machine = MachineConfiguration(cards, 48, 40, **fields)
        total = estimate_cycles(machine, SCENE).total
        if total < fastest:
            chosen = MachineConfiguration(cards_for_cycles(SCENE, total, **fields), 48, 40)
            assert chosen.cards == machine.cards
            fastest = total
    assert cards_for_cycles(SCENE, 10**8, **fields) == "PM"


def test_too_few_cycles():
    with pytest.raises(InputError, match=r"cycles: 10 are too few.*takes about") as raised:
        cards_for_cycles(SCENE, 10)
    assert "\n" not in str(raised.value)


def test_units_that_do_not_hold_the_picture_are_passed_over():
    large = make_display_list("tetra:depth=1", width=2048, height=1024).display_list
    chosen = MachineConfiguration(cards_for_cycles(large, 10**8), 2048, 1024)
    assert chosen.units == 2
