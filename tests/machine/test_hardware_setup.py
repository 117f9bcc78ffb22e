"""Triangles sent as vertices: the frames, pixel for pixel, of triangles that the host prepared."""

from dataclasses import replace

import numpy as np
import pytest
from frames import check, check_bit_true, joined, random_list, triangles
from suite.cases import EVERY
from wide_machines import wide_machine

from cardcage.golden.reference.triangle_setup import prepare
from cardcage.golden.scene_display_list import make_display_list
from cardcage.golden.specification.commands import OPCODE_BITS, Opcode
from cardcage.golden.specification.configuration import MAXIMUM_SETUP_INTERVAL
from cardcage.testbenches.engines.pysim_engine import PysimEngine
from cardcage.testbenches.engines.verilator_engine import VerilatorEngine
from cardcage.testbenches.frames.frame_job import frame_commands
from cardcage.testbenches.frames.simulation import simulate

#: Degenerate, between centres, and off the screen.
INVISIBLE = triangles(
    [[[1, 1], [1, 1], [5, 6]], [[2.6, 2.6], [2.9, 2.6], [2.6, 2.9]], [[-9, 1], [-2, 2], [-3, 7]]],
    [[0] * 3] * 3, [[[255, 0, 0]] * 3] * 3)


def both_ways(display_list, engine, **fields):
    """The frame of one machine, from vertices and from prepared triangles."""
    configuration = wide_machine(display_list, setup="hardware", **fields)
    frames = []
    for opcode, fraction_bits in ((Opcode.TRIANGLE, None),
                                  (Opcode.PREPARED_TRIANGLE, configuration.fraction_bits)):
        words = frame_commands(configuration, display_list, fraction_bits)
        sent = {word & (1 << OPCODE_BITS) - 1 for word in words}
        assert sent == {Opcode.FRAME_START, opcode, Opcode.FRAME_END}
        frames.append(simulate(configuration, display_list, engine, memory_seed=3,
                               fraction_bits=fraction_bits))
    vertices, prepared = frames
    np.testing.assert_array_equal(vertices.video, prepared.video)
    np.testing.assert_array_equal(vertices.depth, prepared.depth)
    assert [work.fragments for work in vertices.work] == [
        work.fragments for work in prepared.work]
    return configuration, vertices, prepared


@pytest.mark.parametrize(("cards", "fields"), [
    ("PM", {"shading": "flat", "fraction_bits": 5}),
    pytest.param("PMM PMM", {"setup_interval": 12}, marks=EVERY),
    ("PM", {"words": 16, "maximum_units": 4, "shading": "flat", "fraction_bits": 20,
            "setup_interval": MAXIMUM_SETUP_INTERVAL}),  # pulled: 4 x 4 of 8 x 8 pixels
])
def test_frames_in_pysim(cards, fields):
    display_list = joined(joined(random_list(4, 8), INVISIBLE), random_list(5, 4))
    configuration, vertices, _ = both_ways(display_list, PysimEngine(), cards=cards,
                                           clocks_per_pixel=2, **fields)
    check_bit_true(configuration, display_list, vertices)


def one_pixel_triangles(display_list, count):
    """Triangles anywhere that cover one pixel each, in the formats of ``display_list``."""
    source = np.random.default_rng(count)
    pixel = source.integers(0, 64, (count, 1, 2))
    position = (pixel + np.array([[0.1, 0.1], [0.9, 0.2], [0.2, 0.95]])) * 2**display_list.sub_bits
    color = source.integers(0, 256, (count, 1, 3), np.uint8).repeat(3, axis=1)
    return replace(display_list, position=position.round().astype(np.int32), color=color,
                   depth=source.integers(0, display_list.depth_limit + 1, (count, 3)))


def test_the_teapot_in_verilator():
    """And fast set-up keeps up: a triangle every three clocks, beside the drawing."""
    display_list = make_display_list("teapot:tessellation=3", width=64, height=64,
                                     shading="flat").display_list
    engine = VerilatorEngine()
    configuration, vertices, prepared = both_ways(display_list, engine, cards="2x(PMM)",
                                                  clocks_per_pixel=2)
    assert configuration.shading == "flat"
    check(configuration, display_list, vertices)
    # What it takes for all of them, one after the other, is mostly hidden.
    divisions = 3 * len(prepare(display_list, fraction_bits=configuration.fraction_bits))
    assert vertices.draw_cycles < prepared.draw_cycles + divisions / 2

    clocks = {}
    for count in (200, 400):
        small = one_pixel_triangles(display_list, count)
        simulation = simulate(configuration, small, engine)
        check(configuration, small, simulation)
        clocks[count] = simulation.draw_cycles
    assert (clocks[400] - clocks[200]) / 200 == pytest.approx(3, abs=0.05)
