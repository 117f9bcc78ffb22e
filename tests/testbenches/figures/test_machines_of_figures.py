"""What is simulated for the page: cages of the last table, and points measured in RTL."""

from __future__ import annotations

from dataclasses import replace

import pytest

from cardcage.golden.merging.cage import merge_cage
from cardcage.golden.planning.machine_plan import plan
from cardcage.golden.specification.errors import InputError
from cardcage.testbenches.engines.engine import Scan
from cardcage.testbenches.figures.figure_scenes import FigureScene
from cardcage.testbenches.figures.figure_tables import merge_table
from cardcage.testbenches.figures.merge_costs import (
    CAGES,
    BoardFigures,
    MergeCage,
    MergeJob,
    board_figures,
    merge_costs,
    merge_size,
)
from cardcage.testbenches.figures.sent_in_rtl import PointJob
from cardcage.testbenches.fpga.boards import BOARDS
from cardcage.testbenches.fpga.place_and_route import Placement
from cardcage.testbenches.support.machine_error import MachineError

SCENE = FigureScene("few", "random:n=12,size=5,seed=5")
CHAIN = MergeCage("C", "2x(PMC)", {"P": "element", "M": "unit-of-chain", "C": "chain-merge"})
POINT = PointJob("2x(PMT)", "round robin", 1, SCENE, (8, 8), "pysim")


@pytest.fixture(autouse=True)
def place(tmp_path, recording, monkeypatch):
    monkeypatch.setenv("CARDCAGE_CACHE", str(tmp_path))
    monkeypatch.setattr("cardcage.testbenches.engines.choose_engine.ENGINES",
                        {"pysim": lambda: recording})


def test_a_cage_of_the_table():
    job = MergeJob(CHAIN, SCENE, (8, 8), "pysim")
    facts = job.run()
    assert facts["equal"] and facts["cards"] == "2x(PMC)" and facts["retained"]
    display_list = SCENE.display_list((8, 8))
    machine = plan(display_list, cards="2x(PMC)", memory_ports=2, packet=1, retain=True,
                   clocks_per_pixel=2).configuration
    assert facts["traffic"]["pixels"] == merge_cage(machine, display_list)[1].pixels == 64
    boards = {"element": BoardFigures(1000, 100.0), "unit-of-chain": BoardFigures(200, 120.0),
              "chain-merge": BoardFigures(100, 150.0)}
    [cost] = merge_costs([job], [facts], boards)
    assert cost.differences == [] and cost.board == boards["chain-merge"]
    assert cost.cage_luts == 2 * (1000 + 200 + 100)
    assert cost.fragments_per_clock == facts["fragments"] / facts["cycles"]["draw"]
    assert cost.per_lut == cost.fragments_per_clock / cost.cage_luts
    [without] = merge_costs([job], [facts], {"element": boards["element"]})
    assert without.board is without.cage_luts is without.per_lut is None
    rows = {row[0]: row[1:] for row in merge_table([cost, without], (8, 8)).rows}
    assert rows["LUTs of a merge card"] == ("100", "--cells")
    assert rows["pixels sent"] == ("64", "64")
    # What was measured is kept.
    assert replace(job, scene=replace(SCENE)).run() == facts


def test_the_screen_of_the_cages():
    assert [merge_size(size) for size in ((8, 300), (256, 256), (512, 100))] == [
        (8, 256), (256, 256), (256, 100)]


def test_a_cage_that_there_cannot_be():
    with pytest.raises(InputError, match="power of two"):
        MergeJob(replace(CHAIN, cards="2x(PMMMC)"), SCENE, (8, 8), "pysim").run()


def test_a_cage_that_hangs(recording, monkeypatch):
    class Hanging:
        name = "pysim"

        def run(self, job, progress=None):
            raise TimeoutError("no response")

    monkeypatch.setattr("cardcage.testbenches.engines.choose_engine.ENGINES",
                        {"pysim": Hanging})
    with pytest.raises(MachineError, match="2x"):
        MergeJob(CHAIN, SCENE, (8, 8), "pysim").run()


def test_points_are_what_the_cards_count():
    point = POINT.run()
    machine = plan(SCENE.display_list((8, 8)), cards="2x(PMT)", memory_ports=2).configuration
    assert list(point.sent) == list(point.golden) == merge_cage(
        machine, SCENE.display_list((8, 8)))[1].sent
    assert point.equal and point.nodes == 2 and sum(point.sent) > 0
    assert not replace(point, sent=[0, 0]).equal
    assert not replace(point, pictures_equal=False).equal
    assert POINT.run() == point


def test_a_point_with_another_picture(recording, monkeypatch):
    class Darker:
        name = "pysim"

        def run(self, job, progress=None):
            run = recording.run(job)
            return replace(run, scans=[Scan(scan.cycle, scan.picture // 2) for scan in run.scans])

    monkeypatch.setattr("cardcage.testbenches.engines.choose_engine.ENGINES", {"pysim": Darker})
    point = POINT.run()
    assert not point.equal and list(point.sent) == list(point.golden)


def test_boards_of_all_cages_can_be_placed(monkeypatch):
    placed, told = [], []

    def place(part, seeds, step):
        placed.append(part.name)
        step("placing")
        return Placement({"LUT4": 5, "CCU2C": 2}, (111.0,))

    monkeypatch.setattr("cardcage.testbenches.fpga.place_and_route.place_and_route", place)
    assert board_figures(False, told.append) == {} and told == []  # nothing was placed before
    found = board_figures(True, told.append)
    names = list(dict.fromkeys(name for cage in CAGES for name in cage.boards.values()))
    assert list(found) == names and set(names) <= set(BOARDS)
    assert found["element"] == BoardFigures(9, 111.0)
    assert told[:2] == ["element: synthesising", "element: placing"]
    assert [BOARDS[name].name for name in names] == placed
