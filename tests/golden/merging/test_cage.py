"""A chain and a tree of nodes merge to the exact picture, and send what their cards send."""

import numpy as np
import pytest
from wide_machines import wide_machine

from cardcage.golden.merging.cage import cage_pictures, merge_cage
from cardcage.golden.merging.tree import tree_sends
from cardcage.golden.organisations.organisation_of import organisation_of
from cardcage.golden.planning.machine_plan import plan
from cardcage.golden.reference import exact
from cardcage.golden.scene_display_list import make_display_list

LIST = make_display_list("random:n=90,size=9,seed=4", width=37, height=23).display_list
#: All at one depth: every pixel that two triangles cover is a tie.
TIED = make_display_list("random:n=90,size=9,seed=4", width=37, height=23).display_list
TIED.depth[:] = 7000


def drawn_by(machine, display_list):
    """bool (nodes, height, width): what each node draws."""
    organisation = organisation_of(machine)
    shares = organisation.shares(display_list)
    return np.array([exact.draw(display_list.chosen(shares.of_node(node)),
                                **organisation.resolution.shifts).winner >= 0
                     for node in range(machine.nodes)])


@pytest.mark.parametrize("packet", [1, 4, "contiguous"])
@pytest.mark.parametrize("cards", ["3x(PMMC)", "5x(PMMT)", "PMMC", "8x(PMT)"])
@pytest.mark.parametrize("display_list", [LIST, TIED], ids=["random", "tied"])
def test_the_merged_picture_is_the_exact_one(display_list, cards, packet):
    for words in (0, 130):
        machine = plan(display_list, cards=cards, packet=packet, words=words).configuration
        resolution = organisation_of(machine).resolution
        merged, traffic = merge_cage(machine, display_list)
        whole = exact.draw(display_list, **resolution.shifts)
        assert (words == 0) == (whole.width == 37)
        for name in ("color", "depth", "winner"):
            np.testing.assert_array_equal(getattr(merged.picture, name), getattr(whole, name))
        assert len(traffic.sends) == machine.nodes - 1
        assert machine.order_bits == 0 or display_list is TIED
        assert (merged.order[~merged.drawn] == (1 << machine.order_bits) - 1).all()


def test_an_order_that_is_left_out_is_missed():
    machine = wide_machine(TIED, cards="3x(PMMC)", order_bits=0)
    winner = merge_cage(machine, TIED)[0].picture.winner
    assert not np.array_equal(winner, exact.draw(TIED).winner)


def test_a_chain_sends_every_pixel_of_the_scan():
    for words in (0, 130):
        machine = wide_machine(LIST, cards="4x(PMMC)", words=words, order_bits=5)
        _, traffic = merge_cage(machine, LIST)
        assert [send[:3] for send in traffic.sends] == [(0, 0, 1), (0, 1, 2), (0, 2, 3)]
        assert traffic.pixels == 3 * 37 * 23
        assert traffic.pixel_bits == 24 + 5 + 24  # depth, order, colour
        assert traffic.bits == 3 * 37 * 23 * 53


def test_a_tree_sends_what_was_drawn_with_its_place():
    machine = wide_machine(LIST, cards="5x(PMMT)", order_bits=0)
    _, traffic = merge_cage(machine, LIST)
    drawn = drawn_by(machine, LIST)
    groups = [(0, 1, 0, [1]), (0, 3, 2, [3]), (1, 2, 0, [2, 3]), (2, 4, 0, [4])]
    assert [send[:4] for send in traffic.sends] == [
        (step, sender, receiver, drawn[group].any(axis=0).sum())
        for step, sender, receiver, group in groups]
    sends = list(tree_sends(cage_pictures(machine, LIST)))
    for send, (_, _, _, group) in zip(sends, groups, strict=True):
        np.testing.assert_array_equal(send.sent, drawn[group].any(axis=0))
        assert send.stored.any() and not (send.stored & ~send.sent).any()
    # What is stored is what of it shows when the step is done; in the end, of node 4.
    winner = merge_cage(machine, LIST)[0].picture.winner  # dealt out in turn
    np.testing.assert_array_equal(sends[3].stored, (winner >= 0) & (winner % 5 == 4))
    # Depth, colour, two units in two bits, 12 · 37 words of each in nine.
    assert machine.words == 12 * 37
    assert traffic.pixel_bits == 24 + 24 + 2 + 9
    assert traffic.bits == 59 * traffic.pixels > 0
