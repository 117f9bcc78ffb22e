"""The guess at a whole frame's clocks against simulated frames."""

from __future__ import annotations

import pytest
from suite.cases import EVERY
from wide_machines import wide_machine

from cardcage.golden.cycles.frame_clocks import (
    DIVISIONS,
    READ_BACK,
    FrameClocks,
    most_frame_clocks,
    predict_frame,
)
from cardcage.golden.scene_display_list import make_display_list
from cardcage.hdl.processing_element.depth_read_back import DepthReadBack
from cardcage.hdl.triangle_setup.plane_setup import Slot
from cardcage.testbenches.engines.pysim_engine import PysimEngine
from cardcage.testbenches.frames.frame_job import frame_job
from cardcage.testbenches.frames.responses import Answers
from cardcage.testbenches.frames.setup_timing import setup_timing

LIST = make_display_list("random:n=25,size=12,seed=5", width=24, height=16).display_list


SETUP = {"setup": "hardware", "setup_interval": 256}


@pytest.mark.parametrize(("cards", "options"), [
    ("PM", {}), ("2x(PMM)", {"memory_ports": 2}),
    pytest.param("PMPMMM", {}, marks=EVERY), pytest.param("2x(PM)", SETUP, marks=EVERY)])
def test_a_frame(cards, options):
    machine = wide_machine(LIST, cards=cards, clocks_per_pixel=2, **options)
    job = frame_job(machine, LIST)
    run = PysimEngine().run(job)
    found = Answers(machine, run).frame(0, reading=0)
    frame = predict_frame(machine, LIST, setup_timing(machine))
    print(frame, found.boot_cycles, found.draw_cycles, found.cycles)
    assert frame.boot == pytest.approx(found.boot_cycles, rel=0.05, abs=30)
    assert frame.draw == pytest.approx(found.draw_cycles, rel=0.25)
    assert frame.total == pytest.approx(found.cycles, rel=0.05)
    assert found.cycles < most_frame_clocks(machine, len(job.commands)) == job.maximum_cycles


def test_the_parts():
    """Drawn a clock too late for a scan, the picture waits for the next one."""
    assert FrameClocks(boot=100, draw=899, scan=1000, read_back=10).shown == 1000
    assert FrameClocks(boot=100, draw=900, scan=1000, read_back=10).shown == 2000
    assert FrameClocks(boot=100, draw=900, scan=1000, read_back=10).total == 3000
    assert FrameClocks(boot=100, draw=900, scan=1000, read_back=1500).total == 3500


def test_constants_are_those_of_the_components():
    """Those of the survey are held by its own tests."""
    assert Slot.COUNT == DIVISIONS
    assert DepthReadBack.latency == READ_BACK
