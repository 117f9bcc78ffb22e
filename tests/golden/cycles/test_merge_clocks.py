"""Clocks of a tree's merge, step by step."""

import pytest
from wide_machines import wide_machine

from cardcage.golden.cycles.frame_clocks import most_frame_clocks, predict_frame
from cardcage.golden.cycles.merge_clocks import (
    HOP_CLOCKS,
    MERGE_CLOCKS,
    STEP_CLOCKS,
    merge_clocks,
)
from cardcage.golden.cycles.one_port_lanes import scan_share
from cardcage.golden.merging.cage import merge_cage
from cardcage.golden.merging.traffic import Send, Traffic
from cardcage.golden.scene_display_list import make_display_list

LIST = make_display_list("random:n=60,size=9,seed=4", width=40, height=28).display_list


def machine(cards, ports=2):
    return wide_machine(LIST, cards=cards, memory_ports=ports)


def test_a_step_waits_for_its_longest_send():
    """With two ports for the one of the most pixels, with one for that of the most accesses, which
    take longer where the scan reads as well."""
    traffic = Traffic(6, [Send(0, 1, 0, 500, 400), Send(0, 3, 2, 700, 10), Send(0, 5, 4, 0, 0),
                          Send(1, 2, 0, 900, 100), Send(2, 4, 0, 30, 30)])
    assert merge_clocks(machine("6x(PMMT)", 2), traffic) == [
        STEP_CLOCKS + longest + passed * HOP_CLOCKS + before
        for longest, passed, before in ((700, 1, MERGE_CLOCKS), (900, 2, 0), (30, 4, 0))]
    # Pixels that are kept take two accesses, and two units take them at the same time.
    for cards, accesses in (("6x(PMT)", (900, 1000, 60)), ("6x(PMMT)", (500, 900, 30))):
        one_port = machine(cards, 1)
        slower = 1 - scan_share(one_port)
        assert 0.5 < slower < 1
        longest = [accesses[0] / slower, accesses[1] / slower, accesses[2] / slower]
        longest[0] = max(longest[0], 710 if cards == "6x(PMT)" else 700)  # no scan reads node 2
        assert merge_clocks(one_port, traffic) == [
            STEP_CLOCKS + round(clocks) + passed * HOP_CLOCKS + before
            for clocks, passed, before in zip(longest, (1, 2, 4), (MERGE_CLOCKS, 0, 0),
                                              strict=True)]
    one_port = machine("6x(PMT)", 1)
    # No scan reads node 2.
    assert merge_clocks(one_port, Traffic(4, traffic.sends[1:2]))[0] == (
        MERGE_CLOCKS + STEP_CLOCKS + 710 + HOP_CLOCKS)


def test_one_node_has_nothing_to_merge():
    alone = machine("PMMT")
    assert merge_clocks(alone, merge_cage(alone, LIST)[1]) == []


@pytest.mark.parametrize("cards", ["4x(PMMC)", "4x(PMMT)"])
def test_a_frame_has_the_clocks_of_its_merge(cards):
    cage = machine(cards)
    frame = predict_frame(cage, LIST)
    expected = sum(merge_clocks(cage, merge_cage(cage, LIST)[1])) if cage.merge == "T" else 0
    assert frame.merge == expected and (expected > 2 * STEP_CLOCKS) == (cage.merge == "T")
    assert frame.shown >= frame.boot + frame.draw + frame.merge
    assert frame.shown - frame.boot - frame.draw - frame.merge <= frame.scan
    assert most_frame_clocks(cage, 64) > 3 * frame.total
