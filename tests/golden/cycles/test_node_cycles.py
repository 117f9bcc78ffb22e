"""The cycle model of cages of nodes: one broadcast for all, or a list for each."""

from __future__ import annotations

import random
from dataclasses import fields, replace

import numpy as np
import pytest
from counted_lists import list_of
from cycle_lists import scene
from cycle_recurrence import LISTS, written_out, written_out_lists
from wide_machines import wide_machine

from cardcage.golden.cycles.broadcast import LIST_LATENCY, SetupTiming
from cardcage.golden.cycles.cycle_estimate import estimate_cycles
from cardcage.golden.cycles.cycle_model import predict_cycles
from cardcage.golden.cycles.element_latencies import Pipeline
from cardcage.golden.cycles.one_port.scan_reads import scan_share, scan_shares
from cardcage.golden.organisations.organisation_of import organisation_of

CAGES = ("2x(PMC)", "3x(PMMT)", "2x(PMMPMMC)", "PMPMMMC PMMPMMC")
PACKETS = (1, 3, "contiguous")


def nodes_scene(configuration, seed, n=60, size=12):
    """Random triangles; the last one of each node has a span in each of its elements, which keeps
    its list in one part."""
    listed = scene(seed, n=n, size=size)
    shares = organisation_of(configuration).shares(list_of(n))
    for node in range(configuration.nodes):
        listed.position[shares.of_node(node)[-1]] = 256 * np.array([[0, 0], [39, 0], [0, 27]])
    return listed


def shares_alone(machine, listed):
    """Of each node a machine of one node, with the triangles that it draws."""
    organisation = organisation_of(machine)
    shares = organisation.shares(listed)
    return [(alone.configuration, listed.chosen(shares.of_node(node)))
            for node, alone in enumerate(organisation.each)]


@pytest.mark.parametrize(("cards", "packet", "seed"), [
    (cards, packet, seed) for seed, cards in enumerate(CAGES) for packet in PACKETS])
def test_the_arrays_say_what_the_recurrence_says(cards, packet, seed):
    """A node holds up the broadcast only where the triangle on offer is for it."""
    pick = random.Random(f"nodes {cards} {packet}")
    pipeline = Pipeline(**{field.name: pick.randrange(1, 9) for field in fields(Pipeline)})
    size = pick.choice((4, 12, 25))
    machine = wide_machine(scene(0), cards=cards, memory_ports=2, packet=packet)
    listed = nodes_scene(machine, 30 + seed, size=size)
    for setup in (None, SetupTiming(interval=20, latency=30, inside=3),
                  SetupTiming(interval=2, latency=11, waiting=4, inside=7)):
        for depth in (2, 5):
            machine = replace(machine, fifo_depth=depth)
            prediction = predict_cycles(machine, listed, pipeline, setup=setup)
            np.testing.assert_array_equal(
                prediction.finished, written_out(machine, listed, pipeline, setup))
            assert prediction.cycles >= prediction.bound
    lists = predict_cycles(machine, listed, pipeline, retained=True)
    assert lists.cycles == written_out_lists(machine, listed, pipeline) >= lists.bound


@pytest.mark.parametrize("packet", PACKETS)
@pytest.mark.parametrize("cards", CAGES)
def test_with_lists_each_node_draws_as_if_it_were_alone(cards, packet):
    """With two ports to the clock, as many clocks later as the lists take to begin."""
    assert LIST_LATENCY == LISTS
    listed = scene(8, n=80)
    machine = wide_machine(listed, cards=cards, memory_ports=2, packet=packet)
    alone = [predict_cycles(*each) for each in shares_alone(machine, listed)]
    lists = predict_cycles(machine, listed, retained=True)
    assert lists.cycles == LIST_LATENCY + max(each.cycles for each in alone)
    assert lists.broadcast_bound == max(each.broadcast_bound for each in alone)
    np.testing.assert_array_equal(lists.element_bound,
                                  np.concatenate([each.element_bound for each in alone]))
    # Set-up has been done as they were loaded.
    assert predict_cycles(machine, listed, retained=True, setup=SetupTiming(
        interval=999)).bounds == lists.bounds


def test_lists_that_are_cut_short():
    """What the model says of each triangle of whole lists is what it says of lists that end
    there."""
    listed = scene(8, n=80)
    machine = wide_machine(listed, cards="3x(PMMT)", memory_ports=2, packet=3)
    whole = predict_cycles(machine, listed, retained=True).finished
    for triangles in (1, 25, 50, 79):
        begun = predict_cycles(machine, listed.chosen(np.arange(triangles)), retained=True).finished
        np.testing.assert_array_equal(whole[:len(begun)], begun)


@pytest.mark.parametrize("ports", [1, 2])
def test_a_node_alone_takes_what_a_cage_without_merge_cards_takes(ports):
    listed = scene(9, n=150)
    cage, node = (wide_machine(listed, cards=cards, memory_ports=ports)
                  for cards in ("PMMPMM", "PMMPMMC"))
    for setup in (None, SetupTiming(interval=9, latency=30, inside=3)):
        one, other = (predict_cycles(machine, listed, after=scene(7), setup=setup)
                      for machine in (cage, node))
        np.testing.assert_array_equal(one.finished, other.finished)
        assert one.bounds == other.bounds
    assert estimate_cycles(cage, listed).total == estimate_cycles(node, listed).total


def test_many_triangles_a_clock():
    """Small triangles keep sixteen nodes busy only where each has its list."""
    listed = scene(3, n=1600, size=2)
    machine = wide_machine(listed, cards="16x(PMMC)", memory_ports=2)
    sent, lists = (predict_cycles(machine, listed, retained=retained)
                   for retained in (False, True))
    assert sent.binding == "broadcast" and sent.cycles < 1.1 * sent.bound
    assert lists.cycles < sent.cycles / 3
    estimate = estimate_cycles(machine, listed, retained=True)
    assert estimate.total == pytest.approx(lists.cycles, rel=0.25)
    assert estimate_cycles(machine, listed).total == pytest.approx(sent.cycles, rel=0.1)


def test_a_full_node_is_passed_by():
    """Large triangles for one of two nodes do not keep small ones from the other."""
    listed = scene(5, n=40, size=2)
    listed.position[0::2] = 256 * np.array([[0, 0], [39, 0], [0, 27]])
    machine = wide_machine(listed, cards="2x(PMMC)", memory_ports=2, fifo_depth=4)
    large = predict_cycles(*shares_alone(machine, listed)[0]).cycles
    assert predict_cycles(machine, listed).cycles == pytest.approx(large, abs=2)
    # In runs that the host sends in list order the first node would have to be done first; the
    # host alternates, so that nothing is lost.
    contiguous = replace(machine, packet="contiguous")
    order = np.argsort(np.arange(40) % 2, kind="stable")
    assert predict_cycles(contiguous, listed.chosen(order)).cycles == (
        predict_cycles(machine, listed).cycles)


def test_the_scan_reads_all_nodes_of_a_chain_and_one_of_a_tree():
    machines = {merge: wide_machine(scene(0), cards=f"3x(PMMPMM{merge})") for merge in "CT"}
    alone = wide_machine(scene(0), cards="PMMPMM")
    shares = scan_shares(organisation_of(alone))
    of = {card: scan_shares(organisation_of(machine)) for card, machine in machines.items()}
    assert (shares.sum(axis=2) > 0).all()
    np.testing.assert_array_equal(of["C"], np.concatenate([shares] * 3, axis=1))
    np.testing.assert_array_equal(of["T"],
                                  np.concatenate([shares, 0 * shares, 0 * shares], axis=1))
    for node in range(3):
        assert scan_share(machines["C"], node) == scan_share(alone)
        assert scan_share(machines["T"], node) == (scan_share(alone) if node == 0 else 0)


@pytest.mark.parametrize("merge", "CT")
def test_nodes_hide_only_what_they_drew_themselves(merge):
    """With one port each node is as it would be alone, but for the scan, which a tree's nodes
    beyond the first are spared."""
    listed, before = scene(6, n=120), scene(7, n=60)
    machine = wide_machine(listed, cards=f"2x(PMM{merge})", clocks_per_pixel=4)
    lists = predict_cycles(machine, listed, after=before, retained=True)
    alone = [predict_cycles(own, share, after=earlier) for (own, share), (_, earlier) in zip(
        shares_alone(machine, listed), shares_alone(machine, before), strict=True)]
    bounds = [each.port_bound for each in alone]
    if merge == "T":
        bounds[1] *= 1 - scan_share(machine)
    assert lists.port_bound == pytest.approx(max(bounds))
    # The scan is two clocks further on.
    if merge == "C":
        assert lists.cycles - LIST_LATENCY == pytest.approx(
            max(each.cycles for each in alone), rel=0.02)
    unscanned = predict_cycles(replace(machine, cards="2x(PMMT)"), listed, after=before,
                               retained=True)
    assert unscanned.cycles <= lists.cycles
    # What one node has drawn does not hide the other's: less is hidden than in a node alone.
    whole = predict_cycles(wide_machine(listed, cards="PMM", clocks_per_pixel=4), listed,
                           after=before)
    assert sum(each.port_bound for each in alone) > whole.port_bound


@pytest.mark.parametrize("cards", CAGES)
def test_an_estimate_is_the_sum_of_its_nodes(cards):
    listed = scene(2, n=90)
    machine = wide_machine(listed, cards=cards)
    alone = [estimate_cycles(*each) for each in shares_alone(machine, listed)]
    for retained, together in ((False, sum), (True, max)):
        estimate = estimate_cycles(machine, listed, retained=retained)
        assert estimate.broadcast == together(each.broadcast for each in alone)
        np.testing.assert_array_equal(
            estimate.fragments, np.concatenate([each.fragments for each in alone]))
        if machine.merge == "C":
            np.testing.assert_array_equal(
                estimate.draw, np.concatenate([each.draw for each in alone]))
    assert len(estimate.draw) == machine.processing_elements


@pytest.mark.parametrize("retained", [False, True])
def test_fewer_triangles_than_nodes(retained):
    listed = scene(5, n=2)
    machine = wide_machine(listed, cards="4x(PMMC)")
    assert predict_cycles(machine, listed, retained=retained).cycles > 0
    none = predict_cycles(machine, listed.chosen(np.arange(0)), retained=retained)
    assert (none.cycles, none.bound) == (0, 0)
    assert estimate_cycles(machine, listed.chosen(np.arange(0)), retained).broadcast == 0
