"""Plans for cages of nodes: an order where nodes tie, lists as long as the largest share, and
lists that a machine cannot draw in its shares."""

from dataclasses import replace

import numpy as np
import pytest
from plan_scenes import random_list, triangles

from cardcage.golden.merging.cage import merge_cage
from cardcage.golden.merging.node_picture import merged, node_pictures
from cardcage.golden.merging.ties import nodes_tie, order_matters
from cardcage.golden.organisations.organisation_of import organisation_of
from cardcage.golden.organisations.shares import Shares
from cardcage.golden.planning.machine_plan import plan, triangle_bits
from cardcage.golden.planning.scene_needs import fitted
from cardcage.golden.reference import bit_true, exact
from cardcage.golden.reference.triangle_setup import prepare
from cardcage.golden.specification.configuration import MachineConfiguration
from cardcage.golden.specification.errors import InputError

CAGES = ["3x(PMMC)", "4x(PMT)", "3x(PMS)F"]


def levels(depths, seed=1, count=40):
    """Level triangles at so many depths: the fewer, the more of them tie."""
    listed = random_list(seed, count)
    depth = np.random.default_rng(seed).integers(0, depths, (count, 1)).repeat(3, axis=1)
    return replace(listed, depth=depth)


def line(planned, item):
    [found] = [each for each in planned.lines if each.item == item]
    return found


def assert_same_pictures(display_list, machine, whole):
    shares = organisation_of(machine).shares(display_list)
    pictures = node_pictures(display_list, shares, order_bits=machine.order_bits)
    for name in ("color", "depth", "winner"):
        np.testing.assert_array_equal(getattr(merged(pictures).picture, name),
                                      getattr(whole, name))


@pytest.mark.parametrize("cards", CAGES)
@pytest.mark.parametrize("packet", [1, 3, 100, "contiguous"])
@pytest.mark.parametrize("depths", [1, 3, 4000])
def test_an_order_is_kept_where_nodes_tie(cards, packet, depths):
    display_list = levels(depths)
    planned = plan(display_list, cards=cards, packet=packet)
    machine = planned.configuration
    shares = Shares(machine.nodes, display_list.triangles, packet)
    assert machine.order_bits == (0 if depths == 4000 else shares.order_bits)
    assert_same_pictures(display_list, machine, exact.draw(display_list))
    row = line(planned, "order bits")
    assert (row.value, row.full) == (str(machine.order_bits), str(planned.full.order_bits))
    assert planned.full.order_bits == (0 if packet == "contiguous" else 16)
    assert row.saves == planned.full.order_bits - machine.order_bits == (
        triangle_bits(planned.full)
        - triangle_bits(replace(planned.full, order_bits=machine.order_bits)))
    reason = ("one run of the list" if shares.rounds == 1 else
              f"nodes tie at some pixel, and have {shares.rounds} rounds" if machine.order_bits else
              "no tie between nodes")
    assert reason in row.reason
    assert not [each for each in planned.lines if each.item == "list words"]
    assert fitted(machine, display_list).triangles == display_list.triangles


@pytest.mark.parametrize("cards", ["3xP D 4xM", "PPDM", "PDMM"])
@pytest.mark.parametrize("packet", [1, 3, 100, "contiguous"])
@pytest.mark.parametrize("depths", [1, 3, 4000])
def test_an_order_has_the_node_where_fragments_of_nodes_meet(cards, packet, depths):
    display_list = levels(depths)
    planned = plan(display_list, cards=cards, packet=packet)
    machine = planned.configuration
    shares = organisation_of(machine).shares(display_list)
    node_bits = machine.node_order_bits
    assert node_bits == {"3xP D 4xM": 2, "PPDM": 1, "PDMM": 0}[cards]
    ties, matters = nodes_tie(display_list, shares), order_matters(display_list, shares)
    assert ties >= matters and (not ties or depths < 4000)
    assert machine.order_bits == (
        0 if not ties else node_bits + (shares.order_bits if matters else 0))
    merged_picture, _ = merge_cage(machine, display_list)
    for name in ("color", "depth", "winner"):
        np.testing.assert_array_equal(getattr(merged_picture.picture, name),
                                      getattr(exact.draw(display_list), name))
    row = line(planned, "order bits")
    assert (row.value, row.full) == (str(machine.order_bits), str(planned.full.order_bits))
    # What is broadcast of a triangle has its round, and no node keeps another one's number.
    assert row.saves == triangle_bits(planned.full) - triangle_bits(
        replace(planned.full, order_bits=machine.order_bits))
    if node_bits and ties:
        assert f"in any order: {node_bits} for the node" in row.reason
        assert ("rounds of a packet" in row.reason) == matters
    elif node_bits:
        assert row.reason == "no two nodes tie where they are seen"
    assert fitted(machine, display_list).triangles == display_list.triangles


@pytest.mark.parametrize(("order_bits", "packet", "message"), [
    (0, 1, "order_bits 6 since nodes tie, the machine is built for 0: take --packet contiguous, or "
           "export a machine for this list"),
    (0, "contiguous", "order_bits 2 since nodes tie, the machine is built for 0: export a machine "
                      "for this list"),
    (2, 1, "order_bits 6 since nodes tie, the machine is built for 2: take --packet contiguous, or "
           "export a machine for this list"),
    (5, 1, "order_bits 6 for 14 rounds, the machine is built for 5: take --packet contiguous, or "
           "export a machine for this list")])
def test_orders_too_narrow_for_a_direct_merge(order_bits, packet, message):
    display_list = levels(1)
    machine = wide(display_list, cards="3xP D MM", order_bits=order_bits, packet=packet)
    with pytest.raises(InputError, match=f"^display list: {message}$"):
        fitted(machine, display_list)
    for enough in (6, 16):
        fitting = replace(machine, order_bits=enough)
        assert fitted(fitting, display_list) is display_list
    assert fitted(replace(machine, order_bits=2, packet="contiguous"),
                  display_list) is display_list


def test_other_lines_are_those_of_one_node():
    display_list = levels(2)
    one, nodes = (plan(display_list, cards=cards) for cards in ("PMM", "3x(PMMC)"))
    assert nodes.lines[:-1] == one.lines and len(one.lines) == 13


@pytest.mark.parametrize("coarse", [{"fraction_bits": 0}, {"max_error": 40}])
def test_ties_are_those_of_the_machine(coarse):
    """Depths that are off by a little tie where exact ones do not, or the other way round."""
    different = 0
    for seed in range(30):
        level = levels(4000, seed, count=60)
        sloping = replace(level, depth=np.minimum(level.depth + np.array([0, 5, 11]), 4094))
        exactly = plan(sloping, cards="3x(PMMC)").configuration
        planned = plan(sloping, cards="3x(PMMC)", **coarse).configuration
        assert planned.fraction_bits < exactly.fraction_bits
        listed = fitted(planned, sloping)
        by_node = np.argsort(Shares(3, 60).node, kind="stable")
        whole, without = (bit_true.draw(each, fraction_bits=planned.fraction_bits).winner
                          for each in (listed, listed.chosen(by_node)))
        wrong = (whole >= 0) & (by_node[without] != whole)
        assert (planned.order_bits > 0) == wrong.any()
        different += planned.order_bits != exactly.order_bits
    assert different > 0


def test_what_is_given_is_not_planned():
    display_list = levels(1)
    for given in (5, 16):
        planned = plan(display_list, cards="3x(PMMC)", order_bits=given)
        assert planned.configuration.order_bits == given
        assert line(planned, "order bits").reason == "asked for"
    assert plan(display_list, cards="3x(PMMC)", order_bits=None).configuration.order_bits == 4
    assert plan(display_list, cards="3x(PMMC)", list_words=99).configuration.list_words == 99
    assert plan(display_list, cards="3x(PMMC)", retain=True,
                list_words=99).configuration.list_words == 99


@pytest.mark.parametrize("words", [0, 70])
@pytest.mark.parametrize("packet", [1, 3, "contiguous"])
@pytest.mark.parametrize("cards", CAGES)
def test_lists_hold_the_largest_share_that_set_up_leaves(cards, packet, words):
    """Small triangles, of which many cover no pixel centre, more where the picture is coarser."""
    source = np.random.default_rng(5)
    corner = source.integers(0, 31 << 4, (200, 1, 2))
    display_list = triangles(*(corner + source.integers(0, 20, (200, 3, 2))), width=32, height=32)
    planned = plan(display_list, cards=cards, packet=packet, words=words, retain=True)
    machine = planned.configuration
    resolution = organisation_of(machine).resolution
    assert (resolution.width == 32) == (words == 0)
    shares = Shares(machine.nodes, 200, packet)
    drawn = prepare(display_list, fraction_bits=0, **resolution.shifts).primitive.tolist()
    expected = max(sum(primitive in drawn for primitive in shares.of_node(node).tolist())
                   for node in range(machine.nodes))
    assert machine.list_words == expected < -(-200 // machine.nodes)
    row = line(planned, "list words")
    bits = triangle_bits(machine) - machine.node_bits
    assert row.value == str(expected) and f"{expected} triangles" in row.reason
    assert f"{bits} bits each, {bits * expected:,} in each node" in row.reason
    assert fitted(machine, display_list).triangles == 200


def test_an_empty_list_is_retained_too():
    empty = levels(1).chosen(np.arange(0))
    machine = plan(empty, cards="3x(PMMC)", retain=True).configuration
    assert (machine.list_words, machine.order_bits) == (1, 0)
    assert fitted(machine, empty).triangles == 0


#: With packets of one or two node 1 of two draws the first of all that tie.
MANY = triangles(*[[[200, 200], [250, 210], [212, 250]]] * 3,
                 *[[[8, 8], [100, 24], [12, 72]]] * 131_070)


@pytest.mark.parametrize(("listed", "fields", "message"), [
    (levels(1), {"order_bits": 0},
     "^order_bits: 0 asked for, the display list needs 4 since nodes tie; leave it out, or take"),
    (levels(1), {"order_bits": 3},
     "^order_bits: 3 asked for, the display list needs 4 for 14 rounds; leave it out, or take 4$"),
    (levels(1), {"list_words": 9}, "^list_words: 9 asked for, the display list needs 1[0-4] "
                                   "for the largest share; leave it out, or take 1[0-4]$"),
    (levels(1), {"cards": "2x(PMM)", "retain": True},
     r"^retain: lists are kept in nodes, and .* has no merge card; end its nodes with one, as in"),
    (MANY, {"cards": "PPDMM"}, "^packet: 1 makes 65,537 rounds, at most 32,768 keep ties between "
                               "nodes in order; take 3 at least, or contiguous$"),
    (MANY, {"cards": "2x(PMC)"}, "^packet: 1 makes 65,537 rounds, at most 65,536 keep ties between "
                                 "nodes in order; take 2 at least, or contiguous$"),
])
def test_what_is_refused(listed, fields, message):
    with pytest.raises(InputError, match=message) as raised:
        plan(listed, **{"cards": "3x(PMMC)", "words": 256} | fields)
    assert "\n" not in str(raised.value)


def test_packets_for_a_long_list():
    machine = plan(MANY, cards="2x(PMC)", packet=2).configuration
    assert machine.order_bits == 16
    assert plan(MANY, cards="2x(PMC)", packet="contiguous").configuration.order_bits == 0


def test_a_share_larger_than_a_list_memory(monkeypatch):
    monkeypatch.setattr("cardcage.golden.planning.node_needs.MAXIMUM_WORDS", 9)
    with pytest.raises(InputError, match=r"^list_words: the largest of 3 shares is 1[0-4] "
                                         r"triangles, a list memory holds 9 at most; add nodes"):
        plan(levels(1), cards="3x(PMMC)", retain=True)


def wide(display_list, cards="3x(PMMC)", **fields):
    return MachineConfiguration(
        cards, display_list.width, display_list.height, sub_bits=display_list.sub_bits,
        depth_bits=display_list.depth_bits, **fields)


@pytest.mark.parametrize(("fields", "message"), [
    ({"order_bits": 3}, "order_bits 4 for 14 rounds, the machine is built for 3: take --packet "
                        "contiguous, or export a machine for this list"),
    ({"order_bits": 0}, "order_bits 4 since nodes tie, the machine is built for 0: take --packet "
                        "contiguous, or export a machine for this list"),
    ({"list_words": 9}, "list_words 1[0-4] for the largest share, the machine is built for 9: "
                        "export a machine for this list"),
])
def test_what_a_machine_cannot_draw_in_its_shares(fields, message):
    display_list = levels(1)
    with pytest.raises(InputError, match=f"^display list: {message}$"):
        fitted(wide(display_list, **fields), display_list)
    remedies = {"order_bits": {"packet": "contiguous"}, "list_words": {"list_words": 14}}
    [field] = fields
    fitting = wide(display_list, **fields | remedies[field])
    assert fitted(fitting, display_list) is display_list
    # Where nothing ties, no order is needed; rounds that are counted must fit.
    if field == "order_bits":
        apart = levels(4000)
        if fields[field] == 0:
            assert fitted(wide(apart, **fields), apart) is apart
        else:
            with pytest.raises(InputError, match="order_bits 4 for 14 rounds"):
                fitted(wide(apart, **fields), apart)


@pytest.mark.parametrize("cards", CAGES)
def test_a_machine_of_several_lists_keeps_all_rounds_of_each(cards):
    """One ties in few rounds; another has many, and nothing ties."""
    tying, apart = levels(1, count=10), levels(4000, seed=2, count=200)
    machine = plan([tying, apart], cards=cards, packet=1).configuration
    alone = plan(apart, cards=cards, packet=1).configuration
    assert alone.order_bits < plan(tying, cards=cards, packet=1).configuration.order_bits
    assert machine.order_bits == organisation_of(machine).shares(apart).order_bits
    for display_list in (tying, apart):
        assert_same_pictures(display_list, machine, exact.draw(fitted(machine, display_list)))
