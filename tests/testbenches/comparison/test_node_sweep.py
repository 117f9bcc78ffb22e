"""Cages of more and more nodes: which there are, what they draw, how much faster they are."""

from __future__ import annotations

import numpy as np
import pytest

from cardcage.golden.organisations.shares import Shares
from cardcage.golden.planning.machine_plan import plan
from cardcage.golden.reference.exact import depth_complexity, draw
from cardcage.golden.scene_display_list import make_display_list
from cardcage.golden.specification.card_order import parse_cards
from cardcage.testbenches.comparison.cage import Cage
from cardcage.testbenches.comparison.node_sweep import (
    FrameTime,
    Place,
    Point,
    curves_of,
    grown,
    places,
    predicted_time,
    repeated,
    repeated_piece,
)
from cardcage.testbenches.machine_options import DEFAULT_PACKET

LIST = make_display_list("random:n=12,size=5,seed=5", width=8, height=8,
                         shading="flat").display_list


@pytest.mark.parametrize(("cards", "piece"), [
    ("PM", "PM"), ("4x(PMM)", "PMM"), ("2x(2x(PMM)C)", "PMMPMMC"), ("PMMPM", "PMMPM"),
    ("4x(PMMT)", "PMMT"), ("4x(PMMS)FF", "PMMSFF"), ("PMMPMMS F", "PMMPMMSF"),
    ("PPPPDMMMM", "PDM"), ("4xP D 8xM", "PDMM"), ("6xP D 4xM", "PPPDMM"), ("D", "D")])
def test_the_piece_that_repeats(cards, piece):
    assert repeated_piece(cards) == piece
    assert parse_cards(repeated(piece, 1)) == piece


@pytest.mark.parametrize(("piece", "copies", "cards"), [
    ("PMM", 2, "PMMPMM"), ("PMMC", 2, "PMMCPMMC"), ("PMMSFF", 3, "PMMSPMMSPMMSFF"),
    ("PDMM", 2, "PPDMMMM"), ("PPDM", 3, "PPPPPPDMMM")])
def test_a_piece_several_times(piece, copies, cards):
    """Frame units are there once, and a direct merge."""
    assert parse_cards(repeated(piece, copies)) == cards


def test_what_the_model_says_of_cages_on_a_bus_and_of_direct_ones():
    """Four of either draw faster than one; only a bus has anything left to do then."""
    listed = grown(LIST, 4)
    for piece, merges in (("PMSF", True), ("PDM", False)):
        one, four = (predicted_time(plan(listed, cards=repeated(piece, copies),
                                         memory_ports=2).configuration, listed, False)
                     for copies in (1, 4))
        assert four.draw < one.draw and (four.merge > 0) == merges


@pytest.mark.parametrize("packet", [1, 3, "contiguous"])
def test_a_scene_that_grows(packet):
    """Every copy is wholly before the one drawn earlier, and each node draws all of the picture."""
    assert grown(LIST, 1, packet).depth.tolist() == LIST.depth.tolist()
    many = grown(LIST, 4, packet)
    assert many.triangles == 4 * LIST.triangles
    copies = many.depth.reshape(4, -1)
    assert (copies[:-1].min(axis=1) > copies[1:].max(axis=1)).all()
    np.testing.assert_array_equal(depth_complexity(many), 4 * depth_complexity(LIST))
    winner = draw(many).winner
    assert ((winner < 0) | (winner >= 3 * LIST.triangles)).all()
    shares = Shares(4, many.triangles, packet)
    for node in range(4):
        own = many.chosen(shares.of_node(node))
        assert sorted(map(tuple, own.position.reshape(-1, 6).tolist())) == sorted(
            map(tuple, LIST.position.reshape(-1, 6).tolist()))


def test_the_places():
    found = list(places([Cage("2x(PMC)"), Cage("4x(PMC)"), Cage("2x(PMC)", True), Cage("PMQ")],
                        (4, 1, 4)))
    assert [(place.cage.label, place.copies) for place in found] == [
        ("PMC", 1), ("4x(PMC)", 1), ("4x(PMC)", 4),
        ("PMC retained", 1), ("4x(PMC) retained", 1), ("4x(PMC) retained", 4)]
    assert list(places([Cage("PM")], ())) == []


def test_the_speed_up():
    """Triangles a clock; simulated against simulated, or against the model where that is all."""
    def point(nodes, growing, model, simulated):
        return Point(Place("PMT", False, growing, nodes), 100 * (nodes if growing else 1),
                     FrameTime(model, 0), simulated and FrameTime(simulated, 10))

    fixed, growing = curves_of([point(4, True, 400, None), point(2, False, 200, 230),
                                point(1, False, 400, 470), point(2, True, 400, 470)])
    assert (fixed.growing, growing.growing) == (False, True)
    assert fixed.label == growing.label == "PMT"
    assert [(found.place.nodes, model, simulated)
            for found, model, simulated in fixed.speed_ups()] == [(1, 1, 1), (2, 2, 2)]
    assert [(found.place.nodes, model, simulated)
            for found, model, simulated in growing.speed_ups()] == [
        (1, 1, 1), (2, 2, 2), (4, 4, None)]
    [alone] = curves_of([point(2, False, 200, None), point(4, False, 100, 90)])
    assert [found[1:] for found in alone.speed_ups()] == [(1, None), (2, 2)]


@pytest.mark.parametrize(("cards", "retain"), [("2x(PM)", False), ("2x(PMC)", True),
                                               ("2x(PMT)", False)])
def test_what_the_model_says_is_near_what_is_simulated(small, cards, retain):
    configuration = plan(LIST, cards=cards, retain=retain, clocks_per_pixel=2,
                         packet=DEFAULT_PACKET).configuration
    model = predicted_time(configuration, LIST, retain)
    [run] = [run for run in small().runs if run.cage == Cage(cards, retain)]
    assert model.draw == pytest.approx(run.clocks.draw, rel=0.25)
    assert model.merge == pytest.approx(run.clocks.merge, rel=0.25)


def test_a_sweep(small):
    """Up to two nodes are simulated, the cages of the comparison among them."""
    comparison = small(("2x(PMT)",), retain=False, nodes=(1, 2, 4), simulate=2)
    assert comparison.identical
    fixed, growing = comparison.curves
    assert [point.triangles for point in fixed.points] == [12, 12, 12]
    assert [point.triangles for point in growing.points] == [12, 24, 48]
    for curve in comparison.curves:
        assert [point.simulated is not None for point in curve.points] == [True, True, False]
        for point in curve.points[:2]:
            assert point.model.total == pytest.approx(point.simulated.total, rel=0.25)
    [run] = comparison.runs
    assert fixed.points[1].simulated == FrameTime(run.clocks.draw, run.clocks.merge)
    assert growing.points[0].simulated == fixed.points[0].simulated
    # A tree that merges more than it draws does not get faster; with a greater scene it does.
    assert growing.speed_ups()[2][1] > fixed.speed_ups()[2][1]


def test_nodes_that_there_cannot_be(small):
    comparison = small(("2x(PM)",), nodes=(1, 3), simulate=0)
    assert comparison.identical
    assert [point.place.nodes for curve in comparison.curves for point in curve.points] == [1, 1]
    [line] = comparison.warnings
    assert line.startswith("3x(PM): cards: 3 memory units are not supported yet")
