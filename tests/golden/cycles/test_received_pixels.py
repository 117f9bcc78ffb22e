"""How the ports of a node take what it receives: cases whose clocks one can count."""

import numpy as np
import pytest
from wide_machines import wide_machine

from cardcage.golden.cycles.received_pixels import (
    LANE_CLOCKS,
    ROOM,
    lost_reads,
    received_clocks,
    sending_order,
)
from cardcage.golden.merging.tree import TreeSend
from cardcage.golden.organisations.organisation_of import organisation_of
from cardcage.golden.scene_display_list import make_display_list

LIST = make_display_list("tetra:depth=0", width=64, height=64).display_list
SCANNED, UNSCANNED = 0, 2


def machine(cards, **options):
    return wide_machine(LIST, cards=cards, memory_ports=1, **options)


def clocks(configuration, receiver, sent, stored, begin=0.0):
    return received_clocks(configuration, TreeSend(0, receiver + 1, receiver, sent, stored), begin)


def rows(configuration, unit):
    """bool (height, width): the pixels of a unit."""
    y, x = np.mgrid[:64, :64]
    return organisation_of(configuration).unit(x, y) == unit


EVERYWHERE = np.ones((64, 64), bool)
NOWHERE = np.zeros((64, 64), bool)


def test_the_order_of_sending():
    """Two units in turn, what is left of one of them, and the next two; words ascend."""
    unit = np.array([0, 0, 0, 1, 3, 3, 2, 2, 2])
    word = np.array([7, 5, 6, 9, 1, 0, 4, 3, 8])
    order = sending_order(unit, word)
    assert list(zip(unit[order], word[order], strict=True)) == [
        (0, 5), (1, 9), (0, 6), (0, 7), (2, 3), (3, 0), (2, 4), (3, 1), (2, 8)]


@pytest.mark.parametrize("cards", ["4x(PMMT)", "4x(PMPMT)", "4x(PMMMMT)"])
@pytest.mark.parametrize("stored", [NOWHERE, EVERYWHERE])
def test_two_units_that_nobody_scans_take_a_pixel_a_clock(cards, stored):
    taken = clocks(machine(cards), UNSCANNED, EVERYWHERE, stored)
    assert 0 <= taken - LANE_CLOCKS - 4096 <= 2


@pytest.mark.parametrize("stored", [0, 1])
def test_one_unit_takes_every_access_by_itself(stored):
    """Where a node has no other, and where the other has got nothing."""
    for cards in ("4x(PMT)", "4x(PMMT)"):
        configuration = machine(cards)
        sent = rows(configuration, 0)
        taken = clocks(configuration, UNSCANNED, sent, sent & bool(stored))
        assert taken == pytest.approx(LANE_CLOCKS + sent.sum() * (1 + stored))


def test_what_one_unit_has_more_than_the_other_it_takes_alone():
    configuration = machine("4x(PMMT)")
    alone = rows(configuration, 1)
    alone[:32] = False
    sent = rows(configuration, 0) | alone
    # 1,024 of each in turn, 1,024 of the first one alone.
    assert clocks(configuration, UNSCANNED, sent, sent) == pytest.approx(
        LANE_CLOCKS + 2048 + 2 * 1024, abs=2)


def test_the_scan_takes_a_lone_unit_a_clock_of_four_while_it_shows_a_line():
    configuration = machine("4x(PMT)")
    timing = configuration.timing
    sent = NOWHERE.copy()
    sent[:16] = True
    shown = timing.horizontal_active / timing.horizontal_total
    expected = 2 * sent.sum() / (1 - shown / 4)
    assert clocks(configuration, SCANNED, sent, sent) == pytest.approx(expected, rel=0.01)
    # It never reads when nothing is shown, between two pictures.
    blank = timing.vertical_active * timing.horizontal_total * 4
    lines = (timing.vertical_total - timing.vertical_active) * timing.horizontal_total * 4
    sent[2:] = False
    assert lines > 256
    assert clocks(configuration, SCANNED, sent, sent, blank) == pytest.approx(256 + LANE_CLOCKS)


def test_where_each_unit_has_its_own_element_the_busier_port_bounds_it():
    """The scan shows a line of one unit and one of the other in turn; what waits evens out no more
    than there is room for."""
    configuration = machine("4x(PMPMT)")
    taken = clocks(configuration, SCANNED, EVERYWHERE, EVERYWHERE)
    timing = configuration.timing
    slowest = 4096 / (1 - timing.horizontal_active / timing.horizontal_total / 4)
    lines = taken / (4 * timing.horizontal_total)
    # A pair that waits spares both units two accesses at a port that has three clocks of four.
    assert slowest - lines * ROOM * 2 / (3 / 4) <= taken < slowest
    assert taken > 4096 / (1 - 1 / 8)


def test_a_shared_bus_loses_reads_to_the_scan():
    """None where nothing is written, or scanned; and so it takes longer than two elements."""
    assert lost_reads((0.25, 0), 0) == lost_reads((0, 0), 1) == 0
    assert lost_reads((0.25, 0), 1) == lost_reads((0, 0.25), 1) == pytest.approx(1 / 6)
    assert lost_reads((0.125, 0.125), 1) == pytest.approx(1 / 8)
    half = np.indices((64, 64)).sum(axis=0) // 2 % 2 == 0
    shared, own = (clocks(machine(cards), SCANNED, EVERYWHERE, half)
                   for cards in ("4x(PMMT)", "4x(PMPMT)"))
    assert own == pytest.approx(4096, rel=0.01)
    assert 1.03 < shared / own < 1.09
