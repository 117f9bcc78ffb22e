"""What a machine owes and answers, sorted and understood."""

from __future__ import annotations

import numpy as np
import pytest
from suite.cases import EVERY

from cardcage.golden.organisations.organisation_of import organisation_of
from cardcage.golden.specification import commands
from cardcage.golden.specification.commands import Fault, Opcode, ResponseKind, response_value
from cardcage.golden.specification.configuration import MachineConfiguration
from cardcage.testbenches.engines.engine import EngineRun, Job, Scan
from cardcage.testbenches.engines.pysim_engine import PysimEngine
from cardcage.testbenches.frames.conversation import owed_at_boot, owed_to, responses_owed
from cardcage.testbenches.frames.responses import Answers
from cardcage.testbenches.support.machine_error import MachineError

CAGE = MachineConfiguration("PMPM", 4, 4)
BOOT = [*owed_at_boot(organisation_of(CAGE))[:-1], (ResponseKind.BOOTED, 70)]
#: Two frames; of each the depths are read once and the counters twice.
FRAMES = [*BOOT,
          *((kind, value) for frame in (0, 100) for kind, value in (
              (ResponseKind.FRAGMENTS, frame), (ResponseKind.BUSY, frame + 1),
              (ResponseKind.FRAGMENTS, frame + 2), (ResponseKind.BUSY, frame + 3),
              (ResponseKind.FRAME_DRAWN, frame + 4), (ResponseKind.FRAME_SHOWN, frame + 5),
              *((ResponseKind.DEPTH, frame + word) for word in range(16)),
              (ResponseKind.FRAGMENTS, frame + 6), (ResponseKind.BUSY, frame + 7),
              (ResponseKind.FRAGMENTS, frame + 8), (ResponseKind.BUSY, frame + 9)))]


def run_of(responses, activity=()):
    """Each response in the clock of its number, a scan every five."""
    scans = [Scan(cycle, np.full((4, 4, 3), cycle, np.uint8))
             for cycle in range(2, len(responses) + 10, 5)]
    return EngineRun([(ResponseKind(kind), value, cycle) for cycle, (kind, value)
                      in enumerate(responses)], scans, 1000, 1.0, activity=activity)


def test_frames_one_after_another():
    answers = Answers(CAGE, run_of(FRAMES, activity=["a", "b", "c", "d"]))
    assert answers.frames == 2
    assert answers.fragments.tolist() == [[0, 2], [6, 8], [100, 102], [106, 108]]
    assert answers.busy.tolist() == [[1, 3], [7, 9], [101, 103], [107, 109]]
    frame = answers.frame(1, reading=3)
    assert [(work.first_unit, work.units, work.fragments, work.busy_cycles)
            for work in frame.work] == [(0, 1, 106, 107), (1, 1, 108, 109)]
    assert (frame.owned, frame.total, frame.boot_cycles) == (2, 2, 70)
    assert (frame.draw_cycles, frame.repeated_scans) == (104, 105)
    assert sorted(frame.depth.ravel().tolist()) == list(range(100, 116))
    assert frame.activity == "d"
    shown = FRAMES.index((ResponseKind.FRAME_SHOWN, 105))
    # The first scan that begins when the picture has been shown.
    assert shown < frame.video[0, 0, 0] <= shown + 5


def test_counters_of_elements_that_share_all_units():
    cage = MachineConfiguration("PPDMM", 4, 4)
    counters = [(ResponseKind.FRAGMENTS, 1), (ResponseKind.BUSY, 2), (ResponseKind.FRAGMENTS, 3),
                (ResponseKind.BUSY, 4), (ResponseKind.TAKEN, 5), (ResponseKind.FOLLOWED, 6),
                (ResponseKind.TAKEN, 7), (ResponseKind.FOLLOWED, 8)]
    organisation = organisation_of(cage)
    owed = owed_to(organisation, commands.command(Opcode.READ_COUNTERS))
    assert [kind for kind, _ in owed] == [kind for kind, _ in counters]
    shown = [(ResponseKind.FRAME_DRAWN, 30), (ResponseKind.MERGED, 30),
             (ResponseKind.FRAME_SHOWN, 1)]
    assert [kind for kind, _ in owed_to(organisation, commands.command(Opcode.FRAME_END))] == [
        kind for kind, _ in shown]
    boot = [(kind, value or 0) for kind, value in owed_at_boot(organisation)]
    depths = [(ResponseKind.DEPTH, word) for word in range(16)]
    frame = Answers(cage, run_of([*boot, *shown, *depths, *counters])).frame(0, reading=0)
    assert [tuple(vars(work).values()) for work in frame.work] == [(0, 0, 2, 1, 2), (1, 0, 2, 3, 4)]
    assert (frame.taken, frame.followed, frame.sent) == ([5, 7], [6, 8], [1, 3])
    assert (frame.owned, frame.total, frame.merge_cycles) == (2, 2, 30)


def test_a_fault_and_a_wrong_resolution():
    with pytest.raises(MachineError, match=r"fault 2 \(UNITS_UNSUPPORTED\)"):
        Answers(CAGE, run_of([*BOOT[:3], (ResponseKind.ERROR, Fault.UNITS_UNSUPPORTED)]))
    halved = (ResponseKind.PICTURE, response_value(ResponseKind.PICTURE, width=4, height=2))
    with pytest.raises(MachineError, match="draws 4x2, expected 4x4"):
        Answers(CAGE, run_of([*BOOT[:3], halved, BOOT[4]]))


@pytest.mark.parametrize("configuration", [
    CAGE, MachineConfiguration("PMM", 4, 4, setup="hardware"),
    MachineConfiguration("PMMM", 4, 4, words=16, allow_orphans=True),
    pytest.param(MachineConfiguration("PMMC PMPMC", 4, 4), marks=EVERY),
    pytest.param(MachineConfiguration("2x(PMS)FF", 4, 4), marks=EVERY),
    MachineConfiguration("PMMS MPMS FFFF", 4, 4, allow_orphans=True),
    pytest.param(MachineConfiguration("2x(PMS)FFF", 4, 4, allow_orphans=True), marks=EVERY),
    MachineConfiguration("PPPDMM", 4, 4),
    pytest.param(MachineConfiguration("PDMMMM", 4, 4, words=2), marks=EVERY),
    MachineConfiguration("PPDMMM", 4, 4, words=16, allow_orphans=True)],
    ids=lambda configuration: configuration.cards)
def test_what_is_owed_comes(configuration):
    organisation = organisation_of(configuration)
    words = [commands.command(opcode) for opcode in (
        Opcode.FRAME_START, Opcode.TRIANGLE, Opcode.PREPARED_TRIANGLE, 15, Opcode.READ_COUNTERS,
        Opcode.FRAME_END, Opcode.READ_DEPTH)]
    owed = owed_at_boot(organisation) + [answer for word in words
                                         for answer in owed_to(organisation, word)]
    assert responses_owed(organisation, words) == len(owed)
    found = PysimEngine().run(Job(configuration, words, len(owed), maximum_cycles=5000)).responses
    for (kind, value, _), expected in zip(found, owed, strict=True):
        assert kind == expected.kind
        assert expected.value is None or value == expected.value
