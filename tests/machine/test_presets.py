"""The named machines: what they hold, and that they draw."""

import numpy as np
import pytest
from amaranth.sim import Simulator
from frames import check, random_list

from cardcage.golden.planning.presets import PRESETS
from cardcage.golden.specification.configuration import MachineConfiguration
from cardcage.golden.specification.video_timing import STANDARD_TIMINGS
from cardcage.hdl.machine import Machine
from cardcage.testbenches.engines.pysim_engine import PysimEngine
from cardcage.testbenches.frames.simulation import simulate


def test_the_paper_preset():
    paper = MachineConfiguration(**PRESETS["paper"])
    assert (paper.processing_elements, paper.units) == (4, 16)
    assert (paper.width, paper.height) == (512, 512)
    assert (paper.interlace.x_unit_bits, paper.interlace.y_unit_bits) == (2, 2)
    assert paper.words * paper.units == 512 * 512


def test_a_standard_picture_has_its_standard_timing():
    machine = MachineConfiguration(**PRESETS["small"] | {"width": 640, "height": 480})
    assert machine.timing == STANDARD_TIMINGS[640, 480]


@pytest.mark.parametrize("name", PRESETS)
def test_each_builds(name):
    Simulator(Machine(configuration=MachineConfiguration(**PRESETS[name])))


def test_tiny_draws():
    configuration = MachineConfiguration(**PRESETS["tiny"], shading="gouraud")
    display_list = random_list(3, 6, width=16, height=16, depth_bits=24)
    simulation = simulate(configuration, display_list, PysimEngine(), memory_seed=8)
    check(configuration, display_list, simulation)
    assert len(np.unique(simulation.video.reshape(-1, 3), axis=0)) > 3
