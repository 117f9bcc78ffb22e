"""One scene on several cages: identical, or what differs, and which cages there cannot be."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from amaranth.hdl import Fragment
from refusals import listing

from cardcage.golden.merging.cage import merge_cage
from cardcage.golden.organisations.organisation_of import organisation_of
from cardcage.golden.reference.exact import depth_complexity
from cardcage.golden.scene_display_list import make_display_list
from cardcage.golden.specification.commands import ResponseKind, list_word_bits
from cardcage.golden.specification.configuration import MachineConfiguration
from cardcage.golden.specification.errors import InputError
from cardcage.hdl.controller.central_broadcast_controller import CentralBroadcastController
from cardcage.hdl.memory_unit.memory_unit import MemoryUnit
from cardcage.hdl.nodes.chain_merge import ChainMerge
from cardcage.hdl.processing_element.processing_element import ProcessingElement
from cardcage.hdl.video.video_scan_generator import VideoScanGenerator
from cardcage.testbenches.comparison.compare_cages import CompareOptions, expected_steps
from cardcage.testbenches.engines.engine import Scan
from cardcage.testbenches.export.cell_count import Cells
from cardcage.testbenches.machine_options import MachineOptions

LABELS = ["2x(PM)", "2x(PMC)", "2x(PMC) retained", "2x(PMT)", "2x(PMT) retained"]
LIST = make_display_list("random:n=12,size=5,seed=5", width=8, height=8,
                         shading="flat").display_list


def labels(**options):
    return [cage.label for cage in CompareOptions(MachineOptions(), **options).cages()]


def test_which_cages():
    assert labels(cards=("2x(PM)", "2x(PMC)", "2x(PMT)")) == LABELS
    assert labels(cards=("2x(PMC)", "2x(PM)"), retain=True) == ["2x(PMC) retained", "2x(PM)"]
    assert labels(cards=("2x(PMC)", "2x(PMC)"), retain=False) == ["2x(PMC)"]
    assert len(labels()) == 5
    assert labels(cards=("2x(PMC", "PMQ")) == ["2x(PMC", "PMQ"]  # said when they are planned


def test_every_step_is_told(small):
    """As the work begins, and as each cage is done."""
    told = []
    small(("2x(PM)", "2x(PMC)"), nodes=(1, 2), simulate=0, step=told.append)
    assert set(told) == {"12 cages, 1 at a time"}
    assert len(told) == 1 + expected_steps(cards=("2x(PM)", "2x(PMC)"), nodes=(1, 2)) == 13


def test_identical_on_all(small):
    comparison = small()
    assert comparison.identical and comparison.equal
    assert comparison.differences == comparison.refused == comparison.warnings == []
    assert [run.cage.label for run in comparison.runs] == LABELS
    assert len(comparison.pictures) == 1 and len(comparison.pictures[0]) == 5
    fragments = int(depth_complexity(LIST).sum())
    for run in comparison.runs:
        assert run.comparison.pixels_compared == run.comparison.depths_compared == 64
        assert run.fragments == fragments > 0
        # What is sent, in the machine's count, is what golden says, piece by piece.
        golden = merge_cage(run.configuration, LIST)[1]
        assert run.traffic == golden
        assert [node.sent for node in run.nodes] == [node.golden_sent for node in run.nodes]
    shares = [run.busiest_share for run in comparison.runs]
    assert shares[0] == 1 and len(set(shares[1:])) == 1 and 0.5 <= shares[1] < 1
    assert [run.clocks.merge > 0 for run in comparison.runs] == [False] * 3 + [True] * 2
    assert [run.clocks.load is not None for run in comparison.runs] == [
        "retained" in label for label in LABELS]
    assert [run.traffic.busiest_piece for run in comparison.runs][:3] == [0, 64, 64]


def test_memory(small):
    """Lists cost what their words are, and every node has room for a picture."""
    one, chain, chain_retained, tree, tree_retained = small().runs
    for run, retained in ((chain, chain_retained), (tree, tree_retained)):
        words = retained.configuration.list_words
        shares = organisation_of(retained.configuration).shares(LIST)  # of equal work
        assert words == np.bincount(shares.node).max() >= 6
        assert retained.memory_bits - run.memory_bits == (
            2 * words * list_word_bits(retained.configuration))
    pictures = [[memory.words * memory.instances for memory in run.memories if memory.bits > 80
                 and memory.words >= 32] for run in (one, chain, tree)]
    assert pictures == [[64], [2 * 64], [2 * 64]]
    assert one.memory_bits < min(chain.memory_bits, tree.memory_bits)


def test_cells_are_those_of_all_boards(small, tmp_path, monkeypatch):
    """Each kind is counted once."""
    counted = []

    def count(component):
        Fragment.get(component, None)  # Amaranth warns of components that are never elaborated
        counted.append(type(component))
        return Cells(flip_flops=1, gates=1 << 8 * len(counted), multipliers=0, memory=5)

    monkeypatch.setenv("CARDCAGE_CACHE", str(tmp_path))
    monkeypatch.setattr("cardcage.testbenches.export.cell_count.count_cells", count)
    for _ in range(2):  # then they are known
        [run] = small(("2x(PMC)",), retain=False, cells=True).runs
        assert len(counted) == 5
        assert run.cells["flip_flops"] == 1 + 1 + 2 + 2 + 2 and run.cells["multipliers"] == 0
        assert set(run.cells) == {"flip_flops", "gates", "multipliers"}
    number = {kind: run.cells["gates"] >> 8 * place & 255
              for place, kind in enumerate(counted, start=1)}
    assert number == {CentralBroadcastController: 1, VideoScanGenerator: 1, ProcessingElement: 2,
                      MemoryUnit: 2, ChainMerge: 2}


def test_a_picture_that_differs(tampered):
    def darker(run):
        return {"scans": [Scan(scan.cycle, scan.picture // 2) for scan in run.scans]}

    comparison = tampered("PMTPMT", darker, retain=False)
    assert not comparison.equal and not comparison.identical
    [line] = comparison.differences
    assert line.startswith("2x(PMT): ") and "of 64 colours and 0 of 64 depths differ" in line
    assert [[run.cage.label for run in group] for group in comparison.pictures] == [
        ["2x(PM)", "2x(PMC)"], ["2x(PMT)"]]


def test_a_frame_that_differs_from_the_next(tampered):
    def first_scan(run):
        shown = next(cycle for kind, _, cycle in run.responses if kind == ResponseKind.FRAME_SHOWN)
        place = next(place for place, scan in enumerate(run.scans) if scan.cycle > shown)
        scans = list(run.scans)
        scans[place] = Scan(scans[place].cycle, scans[place].picture ^ 1)
        return {"scans": scans}

    [line] = tampered("PMCPMC", first_scan, retain=False).differences
    assert line.startswith("2x(PMC): 1 of ") and "show another picture than the last" in line


@pytest.mark.parametrize(("kind", "line"), [
    (ResponseKind.SENT, "2x(PMT): node 1 sent {1} pixels, golden {0}"),
    (ResponseKind.FRAGMENTS, "2x(PMT): node 1 drew {1} fragments, golden {0}")])
def test_a_counter_that_differs(tampered, kind, line):
    counted = []

    def one_more(run):
        responses = list(run.responses)
        place = max(place for place, (found, *_) in enumerate(responses) if found == kind)
        _, value, cycle = responses[place]
        counted.append(value)
        responses[place] = kind, value + 1, cycle
        return {"responses": responses}

    comparison = tampered("PMTPMT", one_more, retain=False)
    assert comparison.differences == [line.format(counted[0], counted[0] + 1)]
    assert len(comparison.pictures) == 1 and not comparison.identical


def test_a_cage_that_hangs(tampered):
    def hang(run):
        raise TimeoutError("no end after 9 cycles")

    comparison = tampered("PMTPMT", hang, retain=False)
    assert [run.cage.label for run in comparison.runs] == ["2x(PM)", "2x(PMC)"]
    assert comparison.differences == ["2x(PMT): the machine failed: no end after 9 cycles"]
    assert comparison.warnings == [] and not comparison.equal


def test_a_cage_that_there_cannot_be(small):
    comparison = small(("3x(PM)", "2x(PM)", "2x(PMQ)"))
    assert comparison.identical and [run.cage.label for run in comparison.runs] == ["2x(PM)"]
    assert [each.cage.cards for each in comparison.refused] == ["3x(PM)", "2x(PMQ)"]
    three, unknown = comparison.warnings
    assert three.startswith("3x(PM): cards: 3 memory units are not supported yet")
    assert unknown.startswith("2x(PMQ): cards: ") and "'Q'" in unknown


def test_no_cage_at_all(small, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    with pytest.raises(InputError, match=r"no cage to compare: 3x\(PM\): cards: 3 memory units"):
        small(("3x(PM)",), out="out")
    with pytest.raises(InputError, match="no cards were given"):
        small(())
    with pytest.raises(InputError, match="did you mean"):
        small(scene="teapott", out="out")
    with pytest.raises(TypeError, match="crads"):
        small(crads="PM")
    with pytest.raises(InputError, match="nodes: 65 is not from 1 to 64"):
        small(("2x(PM)",), nodes=(1, 65), out="out")
    assert listing() == {}


def test_one_cage_alone(small):
    assert [run.cage.label for run in small("2x(PM)").runs] == ["2x(PM)"]


def test_pictures_of_two_resolutions(small):
    """Too few words make a cage's picture coarser: it is as it should be, and another one."""
    comparison = small(("2x(PM)", "2x(PMC)"), retain=False, words=32)
    assert comparison.equal and not comparison.identical
    assert [[run.cage.label for run in group] for group in comparison.pictures] == [
        ["2x(PM)"], ["2x(PMC)"]]
    assert comparison.warnings == ["2x(PMC): 32 words in each memory unit hold 8x4 pixels, not "
                                   "8x8: the picture is coarser"]


@pytest.mark.parametrize(("cards", "draw", "merge", "frame", "bound"), [
    ("2x(PMC)", 100, 0, 105, "draw"), ("2x(PMC)", 100, 0, 106, "scan"),
    ("2x(PMT)", 60, 40, 104, "draw"), ("2x(PMT)", 40, 60, 104, "merge"),
    ("2x(PMT)", 40, 60, 120, "scan"),
    # The next frame is drawn meanwhile.
    ("2x(PMS)F", 100, 80, 104, "draw"), ("2x(PMS)F", 80, 100, 104, "merge"),
    ("2x(PMS)F", 80, 100, 180, "scan"),
])
def test_what_binds_a_frame(small, cards, draw, merge, frame, bound):
    [run] = [run for run in small().runs if run.cage.label == "2x(PMC)"]
    configuration = MachineConfiguration(cards, 8, 8)
    clocks = replace(run.clocks, draw=draw, merge=merge, frame=frame)
    assert replace(run, configuration=configuration, clocks=clocks).bound_by == bound
