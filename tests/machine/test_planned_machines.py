"""Machines built for one scene, simulated: the same picture from fewer bits."""

from dataclasses import replace

import numpy as np
import pytest
from frames import check, check_bit_true, random_list, triangles
from suite.cases import EVERY
from wide_machines import wide_machine

from cardcage.golden.cycles.cycle_estimate import estimate_cycles
from cardcage.golden.planning.machine_plan import plan
from cardcage.golden.planning.scene_needs import fitted
from cardcage.golden.reference import exact
from cardcage.golden.scene_display_list import make_display_list
from cardcage.golden.specification import commands
from cardcage.golden.specification.commands import Opcode
from cardcage.golden.specification.errors import InputError
from cardcage.testbenches.command_line.tables.scene_plan import CYCLE_ACCURACY
from cardcage.testbenches.engines.pysim_engine import PysimEngine
from cardcage.testbenches.engines.verilator_engine import VerilatorEngine
from cardcage.testbenches.engines.verilator_tool import ToolMissingError, find_verilator
from cardcage.testbenches.frames.frame_job import frame_commands
from cardcage.testbenches.frames.simulation import simulate

#: Flat; a mesh of small triangles; large ones with a colour at each vertex.
SCENES = {"flat": "tetra:depth=2", "small": "sphereflake:depth=0", "large": "random:n=8,size=30"}


def scene(kind):
    return make_display_list(SCENES[kind], width=16, height=16).display_list


@pytest.mark.parametrize("kind", SCENES)
def test_the_picture_of_the_full_machine(kind):
    display_list = scene(kind)
    planned = plan(display_list, cards="PMM", clocks_per_pixel=2)
    frames = [simulate(configuration, display_list, PysimEngine(), memory_seed=5)
              for configuration in (planned.configuration, planned.full)]
    check(planned.configuration, display_list, frames[0])
    np.testing.assert_array_equal(frames[0].depth, frames[1].depth)
    np.testing.assert_array_equal(frames[0].video, frames[1].video)
    assert len(np.unique(frames[0].depth)) > 10


def test_the_error_asked_for():
    """One LSB at most, and not none: the fraction bits are really fewer."""
    display_list = scene("large")
    exact_bits = plan(display_list, cards="PMM").configuration.fraction_bits
    configuration = plan(display_list, cards="PMM", max_error=1, clocks_per_pixel=2).configuration
    assert configuration.fraction_bits < 8 < exact_bits
    simulation = simulate(configuration, display_list, PysimEngine(), memory_seed=5)
    check_bit_true(configuration, display_list, simulation)
    assert abs(simulation.depth - exact.draw(display_list).depth).max() == 1


@pytest.mark.parametrize(("seed", "fraction_bits"), [
    (1, None), (2, 0), pytest.param(3, 1, marks=EVERY), pytest.param(4, 3, marks=EVERY)])
def test_triangles_far_outside_the_picture(seed, fraction_bits):
    """Words for this list's columns, heights and errors alone."""
    display_list = random_list(seed, 12)
    planned = plan(display_list, cards="PM", clocks_per_pixel=2, fraction_bits=fraction_bits)
    simulation = simulate(planned.configuration, display_list, PysimEngine(), memory_seed=seed)
    check_bit_true(planned.configuration, display_list, simulation)


def test_coordinates_on_a_coarser_grid():
    """Half a pixel's: the machine has one sub-pixel bit, the list eight."""
    display_list = random_list(6, 12)
    display_list = replace(display_list, position=display_list.position >> 7 << 7)
    configuration = plan(display_list, cards="PM", clocks_per_pixel=2).configuration
    assert (display_list.sub_bits, configuration.sub_bits) == (8, 1)
    check(configuration, display_list,
          simulate(configuration, display_list, PysimEngine(), memory_seed=6))


#: A list that fills its words: columns 0 to 8; the greatest depth and colour of their bits.
FULL = triangles([[[0, 0], [8, 0], [0, 8]], [[8, 8], [8, 0], [0, 8]]],
                 [[2048] * 3, [4094] * 3], [[[128] * 3, [255, 0, 0], [0] * 3]] * 2)


@pytest.mark.parametrize("field", ["edge_column_bits", "depth_integer_bits",
                                   "channel_integer_bits"])
def test_one_bit_less_is_wrong(field):
    """Refused; and where the words are sent all the same, another picture."""
    machine = plan(FULL, cards="PM", clocks_per_pixel=2).configuration
    check(machine, FULL, simulate(machine, FULL, PysimEngine(), memory_seed=7))
    narrower = replace(machine, **{field: getattr(machine, field) - 1})
    with pytest.raises(InputError, match="export a machine for this list"):
        frame_commands(narrower, FULL)
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("cardcage.testbenches.frames.frame_job.fitted",
                      lambda _, listed: fitted(machine, listed))
        simulation = simulate(narrower, FULL, PysimEngine(), memory_seed=7)
    with pytest.raises(AssertionError, match="differ"):
        check(machine, FULL, simulation)


def test_the_estimate_of_cycles():
    """Within what ``cardcage plan`` promises, in frames of all kinds on one machine."""
    try:
        find_verilator()
    except ToolMissingError as missing:
        pytest.skip(f"simulator verilator: {missing}")
    scenes = ["teapot:tessellation=3", "sphereflake:depth=1", "tetra", "random:n=60,size=50,seed=2"]
    lists = [make_display_list(name, width=64, height=64).display_list for name in scenes]
    machine = wide_machine(lists[0], cards="2x(PMM)", fraction_bits=8, clocks_per_pixel=2)
    for name, display_list in zip(scenes, lists, strict=True):
        drawn = simulate(machine, display_list, VerilatorEngine())
        estimate = estimate_cycles(machine, display_list)
        print(f"{name}: {drawn.draw_cycles} cycles, {estimate.total} estimated")
        assert [work.fragments for work in drawn.work] == estimate.fragments.tolist()
        assert estimate.total == pytest.approx(drawn.draw_cycles, rel=CYCLE_ACCURACY)


def test_commands_of_a_planned_machine_are_shorter():
    """As many triangles, in fewer bits; none of a triangle that covers no pixel."""
    display_list = scene("flat")
    planned = plan(display_list, cards="PMM")
    assert commands.command_bits(planned.configuration) < commands.command_bits(planned.full)
    sent = frame_commands(planned.configuration, display_list)
    assert len(sent) == planned.needs.drawn + 2 < display_list.triangles + 2
    assert max(sent).bit_length() <= commands.command_bits(planned.configuration)
    assert {word & 0xF for word in sent[1:-1]} == {Opcode.PREPARED_TRIANGLE}
