"""The comparison finds what is wrong, and only that."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from frames import expected_video

from cardcage.golden.planning.machine_plan import plan
from cardcage.golden.reference import bit_true, exact
from cardcage.golden.scene_display_list import make_display_list
from cardcage.testbenches.frames.compare import compare
from cardcage.testbenches.frames.responses import Simulation, Work

SCENE = "random:n=12,size=8,seed=5"
PIXEL = (6, 5)


@pytest.fixture(scope="module")
def listed():
    return make_display_list(SCENE, width=16, height=16).display_list


def frame(configuration, picture) -> Simulation:
    """What a machine that draws ``picture`` would hand back."""
    return Simulation(
        video=expected_video(configuration, picture.color).copy(), depth=picture.depth.copy(),
        resolution=picture.depth.shape[::-1], work=[Work(0, 0, 1, 10, 20)], owned=1, total=1,
        boot_cycles=1, draw_cycles=2, repeated_scans=0, scans=[], engine="none", cycles=3,
        seconds=1.0)


@pytest.fixture
def machine(listed):
    return plan(listed, cards="PM").configuration


@pytest.fixture
def simulation(listed, machine):
    return frame(machine, exact.draw(listed))


def test_equal(listed, machine, simulation):
    comparison = compare(machine, listed, simulation)
    assert comparison.equal
    assert comparison.first_difference is None
    assert (comparison.pixels_compared, comparison.pixels_different) == (256, 0)
    assert (comparison.depths_compared, comparison.depths_different) == (256, 0)
    assert (comparison.depth_max_error, comparison.color_max_error) == (0, 0)


def test_changed_color(listed, machine, simulation):
    x, y = PIXEL
    right = simulation.video[y, x].copy()
    simulation.video[y, x, 1] ^= 0x80
    simulation.video[12, 3] ^= 1  # later in raster order
    comparison = compare(machine, listed, simulation)
    assert not comparison.equal
    assert (comparison.pixels_different, comparison.depths_different) == (2, 0)
    assert comparison.color_max_error == 128
    first = comparison.first_difference
    assert first.pixel == first.machine_pixel == PIXEL
    assert first.expected.color == tuple(right)
    assert first.got.color == tuple(simulation.video[y, x])
    assert first.expected.depth == first.got.depth
    fragments = exact.fragments(listed, pixel=PIXEL)
    assert len(fragments) >= 1
    assert np.array_equal(first.fragments.primitive, fragments.primitive)
    assert np.array_equal(first.fragments.depth, fragments.depth)
    assert np.array_equal(first.fragments.color, fragments.color)
    assert first.winner in fragments.primitive


def test_changed_depth(listed, machine, simulation):
    x, y = PIXEL
    simulation.depth[y, x] += 3
    comparison = compare(machine, listed, simulation)
    assert not comparison.equal
    assert (comparison.pixels_different, comparison.depths_different) == (0, 1)
    assert comparison.depth_max_error == 3
    first = comparison.first_difference
    assert first.pixel == PIXEL
    assert first.got.depth == first.expected.depth + 3


def test_every_single_value_counts(listed, machine, simulation):
    """The first difference is found wherever it is."""
    for y, x in np.random.default_rng(7).integers(0, 16, (20, 2)):
        simulation.video[y, x, x % 3] ^= 1
        assert compare(machine, listed, simulation).first_difference.pixel == (x, y)
        simulation.video[y, x, x % 3] ^= 1
        simulation.depth[y, x] ^= 1
        assert compare(machine, listed, simulation).first_difference.pixel == (x, y)
        simulation.depth[y, x] ^= 1


def test_background_that_nothing_falls_on(listed, machine, simulation):
    y, x = np.argwhere(exact.draw(listed).winner == -1)[0]
    simulation.depth[y, x] = 5
    first = compare(machine, listed, simulation).first_difference
    assert first.winner == -1
    assert len(first.fragments) == 0
    assert first.expected.depth == machine.depth_background


def test_few_fraction_bits_are_held_to_the_bit_true_model(listed):
    machine = plan(listed, cards="PM", fraction_bits=1).configuration
    reference, approximate = exact.draw(listed), bit_true.draw(listed, fraction_bits=1)
    assert not np.array_equal(reference.depth, approximate.depth)
    comparison = compare(machine, listed, frame(machine, approximate))
    assert comparison.equal
    assert comparison.exact_fraction_bits > 1
    assert comparison.depth_max_error == abs(reference.depth - approximate.depth).max()
    # The exact picture is the wrong one for such a machine.
    assert not compare(machine, listed, frame(machine, reference)).equal


def test_coarser_machine(listed):
    """Four shown pixels hang on one of the machine's; each is compared."""
    machine = plan(listed, cards="PM", words=64).configuration
    interlace = machine.interlace
    assert (interlace.width, interlace.height) == (8, 8)
    picture = exact.draw(listed, x_shift=1, y_shift=1)
    right = frame(machine, picture)
    comparison = compare(machine, listed, right)
    assert comparison.equal
    assert (comparison.pixels_compared, comparison.depths_compared) == (256, 64)
    right.video[7, 5] ^= 1
    first = compare(machine, listed, right).first_difference
    assert (first.pixel, first.machine_pixel) == ((5, 7), (2, 3))
    assert first.expected.depth == picture.depth[3, 2]
    right.depth[3, 2] ^= 1
    assert compare(machine, listed, right).first_difference.pixel == (4, 6)


def test_orphans_are_counted_and_not_compared(listed):
    machine = plan(listed, cards="MPM", allow_orphans=True).configuration
    right = frame(machine, exact.draw(listed))
    right.depth[::2] = -1  # two units interlace in y
    right.video[::2] = 99
    comparison = compare(machine, listed, right)
    assert comparison.equal
    assert (comparison.pixels_compared, comparison.depths_compared) == (128, 128)
    assert comparison.color_orphans.sum() == comparison.depth_orphans.sum() == 128
    assert (comparison.depth_max_error, comparison.color_max_error) == (0, 0)


def test_a_real_frame(draw):
    rendering = draw()
    assert rendering.comparison.equal
    listed = rendering.scene.display_list
    assert rendering.fragments == exact.depth_complexity(listed).sum() > 50
    assert 0 < rendering.efficiency <= 1


def test_shading_is_the_machines(draw):
    """A flat machine draws a Gouraud list flat, and that is what it must equal."""
    rendering = draw(shading="flat")
    assert rendering.comparison.equal
    assert rendering.configuration.shading == "flat"


def test_simulation_is_left_alone(listed, machine, simulation):
    before = replace(simulation, video=simulation.video.copy(), depth=simulation.depth.copy())
    compare(machine, listed, simulation)
    assert np.array_equal(before.video, simulation.video)
    assert np.array_equal(before.depth, simulation.depth)
