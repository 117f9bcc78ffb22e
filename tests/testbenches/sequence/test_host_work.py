"""What the host of a sequence has to do for a large picture, and how fast that is simulated."""

from __future__ import annotations

import time

import pytest
from suite.cases import EVERY

from cardcage.golden.planning.machine_plan import plan
from cardcage.golden.scene_display_list import make_display_list
from cardcage.testbenches.engines.verilator_tool import ToolMissingError, find_verilator
from cardcage.testbenches.machine_options import MachineOptions
from cardcage.testbenches.sequence.sequence_run import SequenceCommands
from cardcage.testbenches.speed.engine_speed import measure_engines
from cardcage.testbenches.views.asked_views import machine_for_frames
from cardcage.testbenches.views.scene_frames import SceneFrames

#: Processor seconds of a picture of 50,000 triangles.
MOST_SECONDS = 1.5

#: Clocks a second of a whole frame beside those of a loop that does nothing but clock the model.
LEAST_RATIO = 0.85


@pytest.mark.parametrize("fields", [{}, {"cards": "4x(PMM)", "regions": (8, 8)}], ids=str)
def test_a_picture_of_fifty_thousand_triangles(fields, record_property):
    """Looked at, quantised, prepared, and said in words; and where regions are dealt out, counted
    by golden, and a table packed.  The first one is left out: for it the scene is loaded."""
    options = MachineOptions(size=(128, 128), **fields)
    lists = SceneFrames("teapot:tessellation=29", options, frames=3, turn=None, path=None)
    configuration = machine_for_frames(lists, options)
    said = SequenceCommands(configuration, lists, "last")
    said.of(0)
    began = time.process_time()
    for number in (1, 2):
        words = said.of(number)
        assert lists[number].triangles > 50_000 and len(words) > 20_000
    seconds = (time.process_time() - began) / 2
    record_property("measured", f"host work for a picture of {lists[1].triangles:,} triangles"
                                f"{', regions' * bool(fields)}: {seconds:.2f} processor seconds")
    assert seconds <= MOST_SECONDS


@EVERY  # where nothing else runs
def test_simulation_beside_a_bare_loop(record_property):
    try:
        find_verilator()
    except ToolMissingError as missing:
        pytest.skip(f"simulator verilator: {missing}")
    for size in (64, 256):
        listed = make_display_list("teapot", width=size, height=size).display_list
        machine = plan(listed, cards="4x(PMM)", regions=(8, 8), clocks_per_pixel=2).configuration
        speed = measure_engines(machine, listed, runs=3, pysim_cycles=64)
        ratio = speed.verilator / speed.bare_loop
        record_property("measured", f"4x(PMM), regions, {size}x{size}: simulated at {ratio:.2f} "
                                    "of the bare loop")
        assert ratio >= LEAST_RATIO
