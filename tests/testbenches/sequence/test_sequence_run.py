"""Pictures one after another on one machine: each is on the pins in its turn, on every scan."""

from collections.abc import Sequence
from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest
from suite.cases import EVERY

from cardcage.golden.planning.machine_plan import plan
from cardcage.golden.scene_display_list import make_display_list
from cardcage.testbenches.engines import choose_engine
from cardcage.testbenches.engines.verilator_engine import VerilatorEngine
from cardcage.testbenches.engines.verilator_tool import ToolMissingError, find_verilator
from cardcage.testbenches.machine_options import MachineOptions
from cardcage.testbenches.sequence.sequence_run import SequenceCommands, simulate_sequence
from cardcage.testbenches.support.machine_error import MachineError
from cardcage.testbenches.views.scene_frames import SceneFrames

try:
    find_verilator()
except ToolMissingError as missing:
    pytest.skip(f"simulator verilator: {missing}", allow_module_level=True)

SIZE = {"width": 20, "height": 14}
#: Short, longer than a scan, empty, short.
LISTS = [make_display_list(f"random:n={n},size=9,seed={n}", **SIZE).display_list
         for n in (12, 900, 11, 40)]
LISTS[2] = replace(LISTS[2], position=LISTS[2].position[:0], depth=LISTS[2].depth[:0],
                   color=LISTS[2].color[:0])


@pytest.fixture(autouse=True)
def compiled(monkeypatch):
    """Elsewhere one engine takes the place of all."""
    monkeypatch.setattr(choose_engine, "ENGINES", {"verilator": VerilatorEngine})


def machine_for(cards, **fields):
    return plan(LISTS, cards=cards, clocks_per_pixel=2, **fields).configuration


def frames_of(configuration, lists=LISTS, **options):
    return list(simulate_sequence(configuration, lists, "verilator", triangles=900, **options))


@pytest.mark.parametrize(("cards", "fields", "options"), [
    pytest.param("PMM", {}, {}, marks=EVERY),
    ("PMM", {}, {"depths": "all", "stall_seed": 5, "memory_seed": 6}),
    pytest.param("2x(PMC)", {}, {"depths": "all", "stall_seed": 7}, marks=EVERY),
    pytest.param("2x(PMC)", {"retain": True}, {"memory_seed": 8}, marks=EVERY),
    ("2x(PMT)", {"memory_ports": 2}, {"stall_seed": 9}),
])
def test_each_in_its_turn(cards, fields, options):
    configuration = machine_for(cards, **fields)
    frames = frames_of(configuration, **options)
    assert [frame.number for frame in frames] == [0, 1, 2, 3]
    assert all(frame.equal and frame.wrong_scans == 0 for frame in frames)
    # The long one is late, and the picture before it stays meanwhile.
    assert frames[1].simulation.repeated_scans >= 1 and frames[0].scans >= 2
    for one, other in pairwise(frames):
        assert one.first_scan + one.scans == other.first_scan
        assert one.scans == 1 + one.scans_before_next_start + other.simulation.repeated_scans
        if options.get("depths") == "all":  # and the host takes its time
            assert one.scans_before_next_start >= 1
        elif not fields.get("retain"):  # the next one begins at once
            assert one.scans_before_next_start == 0
    assert frames[-1].scans_before_next_start is None
    compared = [frame.comparison.depths_compared for frame in frames]
    everything = SIZE["width"] * SIZE["height"]
    assert compared == [everything if options.get("depths") == "all" else 0] * 3 + [everything]
    drawn = [sum(work.fragments for work in frame.simulation.work) for frame in frames]
    assert drawn[2] == 0 < drawn[0] < drawn[1]


@pytest.mark.parametrize("stall_seed", [None, 5])
def test_a_bus_merges_while_the_next_picture_is_drawn(stall_seed):
    """Nothing is asked in between, and every picture is on the pins in its turn all the same."""
    configuration = machine_for("2x(PMS)FF", memory_ports=2)
    frames = frames_of(configuration, counters="last", stall_seed=stall_seed)
    assert all(frame.equal for frame in frames)
    assert [bool(frame.simulation.work) for frame in frames] == [False, False, False, True]
    for one, other in pairwise(frames):
        assert one.first_scan + one.scans == other.first_scan
        # The start of the next picture is taken before this one is shown.
        assert one.scans_before_next_start == 0
        assert one.scans < 1 + other.simulation.repeated_scans
    asked = frames_of(configuration, stall_seed=stall_seed)
    assert frames[-1].first_scan < asked[-1].first_scan


class Lists(Sequence):
    """Lists of which one is another when it is asked for again."""

    def __init__(self, number, later):
        self.lists, self.number, self.later, self.asked = list(LISTS), number, later, 0

    def __len__(self):
        return len(self.lists)

    def __getitem__(self, number):
        if number == self.number:
            self.asked += 1
            return self.lists[number] if self.asked == 1 else self.later
        return self.lists[number]


@pytest.mark.parametrize("number", range(4))
def test_a_picture_that_is_not_the_golden_one(number):
    other = LISTS[3] if number != 3 else LISTS[0]
    frames = frames_of(machine_for("PMM"), Lists(number, other))
    assert [frame.equal for frame in frames] == [place != number for place in range(4)]
    assert frames[number].comparison.first_difference is not None


@pytest.fixture
def altered(monkeypatch):
    """A function: what becomes of the frames when what left the machine is changed so."""

    def frames(change):
        class Altered(VerilatorEngine):
            def run(self, job, progress=None):
                run = super().run(job, progress)
                return replace(run, scans=change(list(run.scans)))

        monkeypatch.setattr(choose_engine, "ENGINES", {"verilator": Altered})
        return frames_of(machine_for("PMM"))

    return frames


def test_every_scan_is_looked_at(altered):
    whole = frames_of(machine_for("PMM"))
    count = whole[-1].first_scan + whole[-1].scans
    for place in range(whole[0].first_scan, count):
        def torn(scans, place=place):
            picture = scans[place].picture.copy()
            picture[7, 3] ^= 1
            scans[place] = replace(scans[place], picture=picture)
            return scans

        wrong = [frame.number for frame in altered(torn) if not frame.equal]
        assert wrong == [next(frame.number for frame in whole
                              if frame.first_scan <= place < frame.first_scan + frame.scans)]


def test_pictures_in_the_wrong_order(altered):
    first = frames_of(machine_for("PMM"))[1].first_scan

    def swapped(scans):
        scans[first - 1], scans[first] = (replace(scans[first - 1], picture=scans[first].picture),
                                          replace(scans[first], picture=scans[first - 1].picture))
        return scans

    assert [frame.equal for frame in altered(swapped)] == [False, False, True, True]


def test_something_before_the_first_picture(altered):
    def lit(scans):
        scans[0] = replace(scans[0], picture=np.ones_like(scans[0].picture))
        return scans

    with pytest.raises(MachineError, match=r"^something was seen before the first picture"):
        altered(lit)


def test_commands_are_made_one_picture_after_another():
    words = SequenceCommands(machine_for("PMM"), LISTS, "last")
    seen = list(words)
    assert len(words) == len(seen) and words[3] == seen[3]
    assert [seen[place] & 15 for place in words.starts] == [1] * 4


def test_a_turning_scene():
    options = MachineOptions(cards="2x(PMM)", size=(20, 14))
    lists = SceneFrames("teapot:tessellation=2", options, frames=5, turn=40.0, path=None)
    configuration = plan(lists, **options.for_plan()).configuration
    frames = list(simulate_sequence(configuration, lists, "verilator",
                                    triangles=lists.most_triangles))
    assert all(frame.equal for frame in frames)
    videos = {frame.simulation.video.tobytes() for frame in frames}
    assert len(videos) == 5
