"""The clocks of pictures whose regions are dealt out, of units with one port, by the machine and
by the cycle model that is told where the scan is, and by which table it reads."""

from __future__ import annotations

import pytest
from frame_paces import first_line
from node_frames import compiled
from suite.cases import chosen

from cardcage.golden.cycles.cycle_model import predict_cycles
from cardcage.golden.cycles.frame_clocks import most_frame_clocks
from cardcage.golden.organisations.organisation_of import organisation_of
from cardcage.golden.specification.commands import ResponseKind
from cardcage.testbenches.engines.engine import Job
from cardcage.testbenches.frames.conversation import responses_owed
from cardcage.testbenches.machine_options import MachineOptions
from cardcage.testbenches.sequence.sequence_run import SequenceCommands
from cardcage.testbenches.views.asked_views import machine_for_frames
from cardcage.testbenches.views.scene_frames import SceneFrames

#: Of the clocks to draw.
ACCURACY = 0.02

FRAMES = 5

MACHINES = {
    "three, by the last picture's clocks": {"cards": "3x(PM)", "balance": "clocks"},
    "three of two units": {"cards": "3x(PMM)"},
    "five of four units": {"cards": "5x(PMMMM)", "balance": "triangles"},
    "sixteen": {"cards": "16x(PM)", "balance": "static"},
    "four clocks a pixel": {"cards": "3x(PM)", "balance": "triangles", "clocks_per_pixel": 4},
}


@pytest.mark.parametrize("depths", ["all", "last"])
@pytest.mark.parametrize("name", chosen(MACHINES, "three, by the last picture's clocks"))
def test_every_picture_takes_the_predicted_clocks(name, depths, record_property):
    """Less than a scan each, begun anywhere in a scan, or as one begins; but for the first one:
    what the scan reads meanwhile says a table that nobody has written."""
    options = MachineOptions(size=(64, 64), regions=(8, 8), **MACHINES[name])
    lists = SceneFrames("teapot", options, frames=FRAMES, turn=None, path=None)
    machine = machine_for_frames(lists, options)
    said = SequenceCommands(machine, lists, depths)
    words = list(said)
    run = compiled().run(Job(
        machine, words, responses_owed(organisation_of(machine), words), memory_seed=4,
        maximum_cycles=FRAMES * most_frame_clocks(machine, len(words))))
    drawn = [value for kind, value, _ in run.responses if kind == ResponseKind.FRAME_DRAWN]
    shown, errors = None, []
    for number, (start, clocks) in enumerate(zip(said.starts, drawn, strict=True)):
        table = said.tables.table(number)
        assert clocks < machine.cycles_per_scan
        if shown is None:
            shown = table
            continue
        begin = int(run.accepted[start + 1]) - first_line(machine)
        predicted = predict_cycles(machine, lists[number], table=table, shown=shown,
                                   begin=begin % machine.cycles_per_scan).cycles
        print(f"picture {number}: {clocks} clocks, predicted {predicted:.0f}")
        errors.append(abs(predicted / clocks - 1))
        shown = table
    record_property("measured", f"{machine.cards} in regions, one port, depths of {depths}: "
                                f"pictures are predicted within {max(errors):.1%}")
    assert max(errors) <= ACCURACY
