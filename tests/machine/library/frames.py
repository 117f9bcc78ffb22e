"""One frame through the simulated machine, checked where it leaves: video pins and read-back."""

from dataclasses import replace

import numpy as np

from cardcage.golden import bit_true, exact
from cardcage.golden.commands import ResponseKind
from cardcage.golden.configuration import configure
from cardcage.golden.display_list import DisplayList
from cardcage.testbenches.engine import Job
from cardcage.testbenches.pysim_engine import PysimEngine
from cardcage.testbenches.simulation import expected_video, frame_commands, simulate

BACKGROUND = (12, 34, 56)
PIXEL = [[2.1, 3.1], [3.4, 3.1], [2.1, 4.4]]  # covers the centre of pixel (2, 3) alone


def triangles(position, depth, color, *, width=8, height=8, sub_bits=8, depth_bits=12,
              background=BACKGROUND):
    """A display list from nested lists, positions in pixels."""
    return DisplayList(
        width=width, height=height, sub_bits=sub_bits, depth_bits=depth_bits,
        background=background,
        position=np.round(np.array(position, float).reshape(-1, 3, 2)
                          * 2**sub_bits).astype(np.int32),
        depth=np.array(depth, np.int64).reshape(-1, 3),
        color=np.array(color, np.uint8).reshape(-1, 3, 3),
    )


def random_list(seed, count, *, width=8, height=8, depth_bits=12, flat=False):
    """Triangles of every size, some far outside the picture."""
    source = np.random.default_rng(seed)
    center = source.uniform(-0.2, 1.2, (count, 1, 2))
    size = source.choice([0.1, 0.4, 1.5], (count, 1, 1))
    position = (center + source.uniform(-size, size, (count, 3, 2))) * (width, height)
    low = -(1 << (max(width, height) - 1).bit_length() + 1)
    color = source.integers(0, 256, (count, 3, 3))
    return triangles(
        np.clip(position, low, -low - 1), source.integers(0, (1 << depth_bits) - 1, (count, 3)),
        color[:, :1].repeat(3, axis=1) if flat else color,
        width=width, height=height, depth_bits=depth_bits)


def joined(first, second):
    """One display list after the other."""
    return replace(first, **{field: np.concatenate([getattr(first, field), getattr(second, field)])
                             for field in ("position", "depth", "color")})


def golden_picture(configuration, display_list):
    interlace = configuration.interlace
    return exact.draw(display_list, x_shift=interlace.x_shift, y_shift=interlace.y_shift)


def draw(display_list, *, cards, seed=1, **options):
    """Simulate one frame from random memory and check every pixel; the ``Simulation``."""
    options.setdefault("clocks_per_pixel", 2)
    configuration = configure(display_list, cards=cards, **options)
    simulation = simulate(configuration, display_list, PysimEngine(), memory_seed=seed)
    check(configuration, display_list, simulation)
    return simulation


def check(configuration, display_list, simulation):
    """Colour as it left the pins and depth as it was read back, equal to golden everywhere."""
    interlace = configuration.interlace
    picture = golden_picture(configuration, display_list)
    video = expected_video(configuration, picture.color)
    assert simulation.video.shape == (configuration.height, configuration.width, 3)
    assert simulation.depth.shape == (interlace.height, interlace.width)
    wrong = np.argwhere((simulation.video != video).any(axis=-1))
    assert not len(wrong), f"{len(wrong)} colours differ, first at (y, x) = {wrong[0]}"
    wrong = np.argwhere(simulation.depth != picture.depth)
    assert not len(wrong), f"{len(wrong)} depths differ, first at (y, x) = {wrong[0]}"
    covered = exact.depth_complexity(display_list, x_shift=interlace.x_shift,
                                     y_shift=interlace.y_shift)
    assert sum(work.fragments for work in simulation.work) == covered.sum()


def check_scans():
    """Draw a quick picture, a slow one, the quick one again; every scan shows one of them whole.

    Returns how many scans repeated the old picture while each of the three was drawn.
    """
    # The last pixel drawn is the next picture's first, and nearer than it is there.
    quick = joined(random_list(1, 2), triangles([PIXEL], [[0] * 3], [[[1, 2, 3]] * 3]))
    slow = joined(triangles([PIXEL], [[1] * 3], [[[250, 240, 230]] * 3]), random_list(2, 150))
    configuration = configure(slow, cards="PM", clocks_per_pixel=2)
    job = Job(
        configuration,
        commands=[*frame_commands(configuration, quick), *frame_commands(configuration, slow),
                  *frame_commands(configuration, quick)],
        responses=4 + 3 * 2,
        memory_seed=9,
        maximum_cycles=60 * configuration.cycles_per_scan,
    )
    run = PysimEngine().run(job)
    repeated = [value for kind, value, _ in run.responses if kind == ResponseKind.FRAME_SHOWN]

    whole = {
        "dark": np.zeros((8, 8, 3), np.uint8),  # what the boot leaves in both buffers
        "quick": golden_picture(configuration, quick).color,
        "slow": golden_picture(configuration, slow).color,
    }
    seen = []
    for scan in run.scans[1:]:  # the machine still boots during the first
        names = [name for name, picture in whole.items() if (picture == scan.picture).all()]
        assert len(names) == 1, f"torn scan at cycle {scan.cycle}"
        seen += names
    changes = [name for place, name in enumerate(seen) if place == 0 or seen[place - 1] != name]
    assert changes in (["dark", "quick", "slow", "quick"], ["quick", "slow", "quick"])
    assert seen[seen.index("quick"):seen.index("slow")] == ["quick"] * (1 + repeated[1])
    return repeated


def check_bit_true(configuration, display_list, simulation):
    """As ``check``, against the datapath's model where the precision is below exact."""
    interlace = configuration.interlace
    picture = bit_true.draw(display_list, fraction_bits=configuration.fraction_bits,
                            shading=configuration.shading,
                            x_shift=interlace.x_shift, y_shift=interlace.y_shift)
    np.testing.assert_array_equal(simulation.video, expected_video(configuration, picture.color))
    np.testing.assert_array_equal(simulation.depth, picture.depth)
