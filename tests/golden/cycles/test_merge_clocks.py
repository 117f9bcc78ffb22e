"""Clocks of a tree's merge, step by step, and of a bus, turn by turn."""

import numpy as np
import pytest
from wide_machines import wide_machine

from cardcage.golden.cycles.frame_clocks import most_frame_clocks, predict_frame
from cardcage.golden.cycles.merge_clocks import (
    HOP_CLOCKS,
    MERGE_CLOCKS,
    PHASES,
    STEP_CLOCKS,
    merge_clocks,
    predict_merge,
)
from cardcage.golden.cycles.received_pixels import received_clocks
from cardcage.golden.cycles.snoop_clocks import BUS_CLOCKS, TURN_CLOCKS, snoop_clocks
from cardcage.golden.merging.cage import cage_pictures, merge_cage
from cardcage.golden.merging.tree import TreeSend, tree_sends
from cardcage.golden.scene_display_list import make_display_list

LIST = make_display_list("random:n=60,size=9,seed=4", width=40, height=28).display_list


def machine(cards, ports=2):
    return wide_machine(LIST, cards=cards, memory_ports=ports)


def send(step, sender, receiver, pixels, stored):
    """The first ``pixels`` of the picture, the first ``stored`` of which the receiver keeps."""
    place = np.arange(28 * 40).reshape(28, 40)
    return TreeSend(step, sender, receiver, place < pixels, place < stored)


SENDS = [send(0, 1, 0, 500, 400), send(0, 3, 2, 700, 10), send(0, 5, 4, 0, 0),
         send(1, 2, 0, 900, 100), send(2, 4, 0, 30, 30)]


def test_a_step_waits_for_its_longest_send():
    """With two ports for the one of the most pixels."""
    assert merge_clocks(machine("6x(PMMT)"), SENDS) == [
        STEP_CLOCKS + longest + passed * HOP_CLOCKS + before
        for longest, passed, before in ((700, 1, MERGE_CLOCKS), (900, 2, 0), (30, 4, 0))]


def test_with_one_port_it_waits_for_that_of_the_most_accesses():
    """In the first step 500 + 400 in a unit of node 0, which is scanned, are longer than 700 + 10
    in one that is not."""
    one_port = machine("6x(PMT)", 1)
    first, second, _ = merge_clocks(one_port, SENDS, begin=300)
    before = STEP_CLOCKS + HOP_CLOCKS + MERGE_CLOCKS
    assert first == before + round(received_clocks(one_port, SENDS[0], 300 + before))
    assert first > before + 900
    before = STEP_CLOCKS + 2 * HOP_CLOCKS
    assert second == before + round(received_clocks(one_port, SENDS[3], 300 + first + before))
    assert merge_clocks(one_port, SENDS[1:2])[0] == (
        STEP_CLOCKS + HOP_CLOCKS + MERGE_CLOCKS
        + round(received_clocks(one_port, SENDS[1], 0)))


def test_where_nobody_knows_when_it_begins_it_takes_the_mean():
    one_port = machine("2x(PMMT)", 1)
    begins = np.arange(PHASES) * one_port.cycles_per_scan / PHASES
    takes = [received_clocks(one_port, SENDS[0], begin) for begin in begins]
    assert max(takes) > min(takes)
    assert merge_clocks(one_port, SENDS[:1]) == [
        STEP_CLOCKS + HOP_CLOCKS + MERGE_CLOCKS + round(np.mean(takes))]


def test_one_node_has_nothing_to_merge():
    alone = machine("PMMT")
    assert merge_clocks(alone, tree_sends(cage_pictures(alone, LIST))) == []


@pytest.mark.parametrize("ports", [1, 2])
def test_nodes_on_a_bus_wait_for_one_another(ports):
    """A pixel takes a clock, whatever the ports."""
    for cards in ("PMMS F", "4x(PMMS)FF"):
        cage = machine(cards, ports)
        _, traffic = merge_cage(cage, LIST)
        turns = snoop_clocks(traffic)
        assert turns == [TURN_CLOCKS + sent + (BUS_CLOCKS if node == 0 else 0)
                         for node, sent in enumerate(traffic.sent)]
        assert predict_merge(cage, LIST) == predict_frame(cage, LIST).merge == sum(turns)
        assert sum(turns) > traffic.pixels


@pytest.mark.parametrize("ports", [1, 2])
@pytest.mark.parametrize("cards", ["4x(PMMC)", "4x(PMMT)", "4x(PMMS)FF", "4xP D 4xM"])
def test_a_frame_has_the_clocks_of_its_merge(cards, ports):
    cage = machine(cards, ports)
    frame = predict_frame(cage, LIST)
    assert frame.merge == predict_merge(cage, LIST)
    if cage.merge == "T":
        steps = merge_cage(cage, LIST)[1].steps
        assert frame.merge == sum(merge_clocks(cage, tree_sends(cage_pictures(cage, LIST))))
        assert frame.merge > sum(steps) > 2 * STEP_CLOCKS
    elif cage.merge != "S":
        assert frame.merge == 0
    assert frame.shown >= frame.boot + frame.draw + frame.merge
    assert frame.shown - frame.boot - frame.draw - frame.merge <= frame.scan
    assert most_frame_clocks(cage, 64) > 3 * frame.total
