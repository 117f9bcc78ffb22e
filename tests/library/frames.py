"""One frame through the simulated machine, checked where it leaves: video pins and read-back."""


import numpy as np
from wide_machines import wide_machine

from cardcage.golden.reference import bit_true, exact
from cardcage.golden.specification import commands
from cardcage.golden.specification.commands import Opcode, ResponseKind
from cardcage.golden.specification.display_list import DisplayList
from cardcage.testbenches.engines.engine import Job
from cardcage.testbenches.engines.pysim_engine import PysimEngine
from cardcage.testbenches.frames.frame_job import frame_commands
from cardcage.testbenches.frames.simulation import simulate

BACKGROUND = (12, 34, 56)
SCREEN = [[4, -16], [15.9, 8.5], [-15, 8.5]]  # covers all of 8 by 8 pixels
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
    return first.followed_by(second)


def expected_video(configuration, color):
    """A picture at the machine's resolution as the scan shows it: each pixel as often as the
    highest resolution has it."""
    interlace = configuration.interlace
    rows, columns = np.mgrid[:configuration.height, :configuration.width]
    return color[rows >> interlace.y_shift, columns >> interlace.x_shift]


def golden_picture(configuration, display_list):
    interlace = configuration.interlace
    return exact.draw(display_list, x_shift=interlace.x_shift, y_shift=interlace.y_shift)


def draw(display_list, *, cards, seed=1, **options):
    """Simulate one frame from random memory and check every pixel; the ``Simulation``."""
    options.setdefault("clocks_per_pixel", 2)
    configuration = wide_machine(display_list, cards=cards, **options)
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
    configuration = wide_machine(slow, cards="PM", clocks_per_pixel=2)
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


def spans_twice(width=8, height=8, seed=0):
    """Rows of one to six pixels, each drawn twice in a row: the second time farther, or nearer.

    Whatever the pace, some pixel is drawn again in the clock in which it is written, and the one
    beside it was written since.
    """
    source = np.random.default_rng(seed)
    position, depth = [], []
    for row in range(height):
        for length in range(1, 7):
            left = int(source.integers(0, width - length + 1))
            wedge = [[left + 0.1, row + 0.4], [left + 0.1, row + 0.6],
                     [left + length + 0.2, row + 0.5]]
            near = 500 * length  # so that what shorter rows left can still be seen
            position += [wedge] * 2
            depth += [[near] * 3, [near + int(source.choice([100, 100, -100]))] * 3]
    return triangles(position, depth, source.integers(0, 256, (len(depth), 3, 3)), width=width,
                     height=height)


def check_frames(lists, *, cards="PM", seed=1, abandoned=(), engine=None, **options):
    """Draw many frames one after the other, from random memory, and check every pixel of each.

    Of the frames in ``abandoned`` the host sends all but the end: the next one starts over them.
    Returns (kind, value, cycle) of all responses.
    """
    options.setdefault("clocks_per_pixel", 2)
    configurations = [wide_machine(listed, cards=cards, shading="gouraud", **options)
                      for listed in lists]
    configuration = max(configurations, key=lambda machine: machine.fraction_bits)
    interlace = configuration.interlace
    words, finished = [], []
    for number, listed in enumerate(lists):
        commands_of_frame = frame_commands(configuration, listed)
        if number in abandoned:
            words += commands_of_frame[:-1]
        else:
            words += [*commands_of_frame, commands.command(Opcode.READ_DEPTH)]
            finished.append(listed)
    depths = configuration.units * interlace.words
    job = Job(configuration, commands=words, memory_seed=seed,
              responses=configuration.processing_elements + 3 + len(finished) * (2 + depths),
              maximum_cycles=len(lists) * 40 * configuration.cycles_per_scan)
    run = (engine or PysimEngine()).run(job)
    pictures = [golden_picture(configuration, listed) for listed in finished]

    read = [value for kind, value, _ in run.responses if kind == ResponseKind.DEPTH]
    unit, address = np.meshgrid(np.arange(configuration.units), np.arange(interlace.words),
                                indexing="ij")
    x, y = interlace.pixel(unit, address)
    inside = (x < interlace.width) & (y < interlace.height)
    for number, picture in enumerate(pictures):
        words_read = np.array(read[number * depths:][:depths]).reshape(unit.shape)
        wrong = np.argwhere(words_read[inside] != picture.depth[y[inside], x[inside]])
        assert not len(wrong), f"frame {number}: {len(wrong)} depths differ"

    # Each scan shows one picture whole, the one that was swapped in last.
    videos = [expected_video(configuration, picture.color) for picture in pictures]
    shown = [cycle for kind, _, cycle in run.responses if kind == ResponseKind.FRAME_SHOWN]
    seen = set()
    for scan in run.scans:
        number = sum(cycle < scan.cycle for cycle in shown) - 1
        if number < 0:  # the boot's pictures, black once it is over
            continue
        wrong = np.argwhere((scan.picture != videos[number]).any(axis=-1))
        assert not len(wrong), f"frame {number}: {len(wrong)} colours differ, cycle {scan.cycle}"
        seen.add(number)
    assert seen == set(range(len(pictures)))
    return run.responses


def many_frames(count, seed=0):
    """Lists of every kind, in turn: quick, empty, all pixels visible several times, one pixel."""
    kinds = (lambda n: random_list((seed, n), 4),
             lambda n: triangles([], [], [], background=(n,) * 3),
             lambda n: triangles([SCREEN] * 4,
                                 [[800 - 99 * n % 700 - layer] * 3 for layer in range(4)],
                                 [[[n, 7 * n % 256, layer]] * 3 for layer in range(4)]),
             lambda n: triangles([PIXEL], [[n] * 3], [[[n, 255 - n, 9]] * 3], background=(1, n, 2)))
    return [kinds[number % len(kinds)](number) for number in range(count)]


def check_bit_true(configuration, display_list, simulation):
    """As ``check``, against the datapath's model where the precision is below exact."""
    interlace = configuration.interlace
    picture = bit_true.draw(display_list, fraction_bits=configuration.fraction_bits,
                            shading=configuration.shading,
                            x_shift=interlace.x_shift, y_shift=interlace.y_shift)
    np.testing.assert_array_equal(simulation.video, expected_video(configuration, picture.color))
    np.testing.assert_array_equal(simulation.depth, picture.depth)
