"""Cages whose regions are dealt out, beside others: what is asked of them, and what they did."""

import pytest
from golden_machine import GoldenMachine

from cardcage.golden.organisations.region_table import packed_table
from cardcage.golden.scene_display_list import make_display_list
from cardcage.golden.specification.commands import ResponseKind
from cardcage.testbenches.comparison.cage import Cage, CageJob
from cardcage.testbenches.comparison.compare_cages import CompareOptions
from cardcage.testbenches.comparison.comparison_facts import cage_facts
from cardcage.testbenches.comparison.node_sweep import places
from cardcage.testbenches.engines import choose_engine
from cardcage.testbenches.frames.region_figures import golden_counts
from cardcage.testbenches.machine_options import MachineOptions

SCENE = make_display_list("random:n=40,size=7,seed=40", width=20, height=14)


def test_names():
    assert Cage.named(" 4x(PMM) / 8x4 ") == Cage(" 4x(PMM)", False, (8, 4))
    assert Cage.named("4x(PMM)") == Cage("4x(PMM)")
    assert Cage.named("4x(PMM)/8").regions is None and Cage.named("4x(PMM)/8").spelled is None
    assert Cage("3x(PM)", regions=(4, 2)).label == "3x(PM)/4x2"
    options = CompareOptions(MachineOptions(), ("4x(PM)", "4x(PM)/2x2", "2x(PMC)"))
    assert [(cage.cards, cage.regions, cage.retained) for cage in options.cages()] == [
        ("4x(PM)", None, False), ("4x(PM)", (2, 2), False), ("2x(PMC)", None, False),
        ("2x(PMC)", None, True)]
    found = [(place.cage.label, place.growing) for place in places(
        [Cage("4x(PM)"), Cage("4x(PM)", regions=(2, 2))], [1, 3])]
    assert found == [("PM", False), ("3x(PM)", False), ("3x(PM)", True), ("PM/2x2", False),
                     ("3x(PM)/2x2", False), ("3x(PM)/2x2", True)]


def test_what_is_asked_of_each():
    asked = MachineOptions(slots=3, balance="triangles", balancer="hardware", packet=4)
    dealt = Cage("3x(PM)", regions=(4, 2)).options(asked)
    assert (dealt.regions, dealt.slots, dealt.balance, dealt.balancer, dealt.packet) == (
        (4, 2), 3, "triangles", "hardware", None)
    other = Cage("2x(PMC)").options(asked)
    assert (other.regions, other.slots, other.balance, other.balancer, other.packet) == (
        None, None, None, None, 4)


@pytest.mark.parametrize("balancer", ["host", "hardware"])
def test_a_cage_with_regions(monkeypatch, balancer):
    """The frame that is measured is drawn by what the scene itself costs."""
    monkeypatch.setattr(choose_engine, "ENGINES",
                        {"golden": lambda: GoldenMachine([SCENE.display_list])})
    run = CageJob(Cage("3x(PM)", regions=(5, 4)), SCENE, MachineOptions(balancer=balancer),
                  "golden", memories=False).run()
    assert not run.differences and run.comparison.depths_compared == 20 * 14
    packed = packed_table(golden_counts(run.configuration, SCENE.display_list), 3, 9)
    assert run.regions.table.tolist() == packed.tolist()
    facts = cage_facts(run)
    assert facts["regions"]["utilisation"] == run.regions.utilisation > 0.9
    assert facts["label"] == "3x(PM)/5x4" and facts["regions"]["moved"] == 0
    # Of the commands only those before the second frame are many.
    assert run.latency.merged > 0 and run.clocks.frame > 0


def test_a_wrong_count_is_a_difference(monkeypatch):
    def change(kind, number, value):
        return value + (kind == ResponseKind.REGION_COUNT and number == 4)

    monkeypatch.setattr(choose_engine, "ENGINES",
                        {"golden": lambda: GoldenMachine([SCENE.display_list], change)})
    run = CageJob(Cage("3x(PM)", regions=(5, 4)), SCENE, MachineOptions(), "golden",
                  memories=False).run()
    [line] = run.differences
    assert line.startswith("processing element 0 counted ")
