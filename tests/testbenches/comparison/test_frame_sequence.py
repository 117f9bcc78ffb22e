"""Clocks and latencies of frames one after the other, against what is seen at the pins."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from suite.cases import EVERY

from cardcage.golden.planning.machine_plan import plan
from cardcage.golden.reference import exact
from cardcage.golden.scene_display_list import make_display_list
from cardcage.golden.specification.commands import Opcode, ResponseKind, opcode_of
from cardcage.testbenches.comparison.frame_sequence import FRAMES, FrameSequence
from cardcage.testbenches.engines.pysim_engine import PysimEngine
from cardcage.testbenches.engines.video_monitor import VideoMonitor
from cardcage.testbenches.frames.frame_job import frame_commands

LIST = make_display_list("random:n=12,size=5,seed=5", width=8, height=8,
                         shading="flat").display_list
#: The last triangle covers the middle of the picture, before all others, in a colour of its own.
MARKED = replace(
    LIST, depth=np.concatenate([LIST.depth[:-1], [[0, 0, 0]]]),
    position=np.concatenate([LIST.position[:-1], 256 * np.array([[[2, 3], [7, 3], [2, 7]]],
                                                                np.int32)]),
    color=np.concatenate([LIST.color[:-1], np.full((1, 3, 3), 255, np.uint8)]))
WHITE = 0xFFFFFF


def machine(cards, retained, listed=MARKED, **options):
    return plan(listed, cards=cards, retain=retained, clocks_per_pixel=2, **options).configuration


@pytest.fixture
def seen(monkeypatch):
    """Everything that is on the pins in a run, as (cycle, colour), pixel by pixel, and the runs."""
    found, runs = [], []
    sample, run = VideoMonitor.sample, PysimEngine.run

    def watching(self, cycle, active, vertical_sync, color):
        found.append((cycle, color))
        sample(self, cycle, active, vertical_sync, color)

    def keeping(self, job, progress=None):
        runs.append((job, run(self, job, progress)))
        return runs[-1][1]

    monkeypatch.setattr(VideoMonitor, "sample", watching)
    monkeypatch.setattr(PysimEngine, "run", keeping)
    monkeypatch.setattr("cardcage.testbenches.engines.choose_engine.ENGINES",
                        {"pysim": PysimEngine})
    return found, runs


@pytest.mark.parametrize(("cards", "retained", "options"), [
    ("PM", False, {}), ("2x(PMT)", True, {}), ("2x(PMS)F", False, {}),
    pytest.param("2x(PMC)", False, {"packet": "contiguous"}, marks=EVERY),
    pytest.param("2x(PMS)FF", True, {}, marks=EVERY), pytest.param("PPDM", True, {}, marks=EVERY)])
def test_what_is_said_of_a_frame_is_what_is_seen(seen, cards, retained, options):
    configuration = machine(cards, retained, **options)
    frames = FrameSequence(configuration, MARKED, "pysim", memory_seed=3)
    pixels, [(job, run)] = seen
    cycles = {kind: [cycle for found, _, cycle in run.responses if found == kind]
              for kind in ResponseKind}
    merged = cycles[ResponseKind.MERGED if "M" in cards and cards != "PM"
                    else ResponseKind.FRAME_DRAWN]
    assert len(merged) == len(cycles[ResponseKind.FRAME_SHOWN]) == FRAMES

    taken = dict(zip(range(len(job.commands)), run.accepted.tolist(), strict=True))
    of = {opcode: [place for place, word in enumerate(job.commands) if opcode_of(word) == opcode]
          for opcode in Opcode}
    assert len(of[Opcode.FRAME_START]) == FRAMES
    # The last triangle is the last one that is sent.
    drawing = of[Opcode.DRAW_LISTS] if retained else of[Opcode.PREPARED_TRIANGLE]
    # Where the next frame is drawn meanwhile, the first one is the one that waits for none.
    frame = 0 if "S" in cards else -1
    last = taken[drawing[len(drawing) // FRAMES - 1 if "S" in cards else -1]]
    white = next(cycle for cycle, color in pixels
                 if color == WHITE and cycle > cycles[ResponseKind.FRAME_SHOWN][frame])
    latency = frames.latency(exact.draw(MARKED))
    assert (latency.triangle, latency.pixel) == (11, (2, 3))
    assert latency.pins == white - last
    assert latency.merged == merged[frame] - last

    clocks = frames.clocks
    assert clocks.load == (taken[drawing[0]] - taken[of[Opcode.LOAD][0]] if retained else None)
    assert clocks.frame == merged[2] - merged[1]
    # The next frame begins as the picture is shown, and is merged within the same scan.
    assert clocks.frame == configuration.cycles_per_scan
    assert clocks.draw == frames.simulation.draw_cycles < clocks.frame
    assert (clocks.merge > 0) == ("T" in cards or "S" in cards)
    if "S" in cards:
        assert clocks.merge == merged[0] - cycles[ResponseKind.FRAME_DRAWN][0]
    assert clocks.boot == frames.simulation.boot_cycles
    assert len(frames.shown_scans) >= FRAMES
    assert len(of[Opcode.LOAD]) == (len(MARKED.position) - unsent(configuration)) * retained


def unsent(configuration):
    """Triangles that set-up leaves out."""
    return len(MARKED.position) + 2 - len(frame_commands(
        replace(configuration, list_words=0), MARKED))


@pytest.mark.parametrize(("cards", "options"), [
    ("PM", {}), ("3x(PMT)", {"packet": "contiguous"}), ("2x(PMC)", {"packet": 3}),
    ("2x(PMC)", {"setup": "hardware"})])
def test_the_command_of_each_triangle(cards, options, monkeypatch):
    """It is the one that changes with the triangle's colour."""
    configuration = machine(cards, False, LIST, **options)

    class NoRun:
        def run(self, job, progress=None):
            raise TimeoutError

    monkeypatch.setattr("cardcage.testbenches.engines.choose_engine.ENGINES", {"pysim": NoRun})
    frames = FrameSequence.__new__(FrameSequence)
    with pytest.raises(RuntimeError, match="the machine failed"):
        frames.__init__(configuration, LIST, "pysim")
    whole = frame_commands(configuration, LIST)
    drawn = set(exact.draw(LIST).winner[exact.draw(LIST).winner >= 0].tolist())
    assert len(drawn) > 3
    for triangle in drawn:
        color = LIST.color.copy()
        color[triangle] ^= 1
        other = frame_commands(configuration, replace(LIST, color=color))
        [place] = [place for place, words in enumerate(zip(whole, other, strict=True))
                   if words[0] != words[1]]
        assert frames._command_of(triangle) == place


def test_nothing_is_seen_of_an_empty_list():
    empty = LIST.chosen(np.arange(0))
    frames = FrameSequence(machine("PMT", True, empty), empty, "pysim")
    assert frames.latency(exact.draw(empty)) is None
    assert frames.clocks.load == 0
