"""Sixty-four nodes, as small as can be."""

import numpy as np
from frames import expected_video, golden_picture, random_list
from node_frames import READ_DEPTH, all_tied, compiled, frames, immediate, run
from suite.cases import EVERY

from cardcage.golden.merging.cage import merge_cage
from cardcage.golden.organisations.organisation_of import organisation_of
from cardcage.golden.specification.commands import ResponseKind
from cardcage.golden.specification.configuration import MachineConfiguration

MACHINE = MachineConfiguration(
    cards="64x(PMC)", width=16, height=4, depth_bits=12, fraction_bits=24, shading="flat",
    memory_ports=2, fifo_depth=2, clocks_per_pixel=2, packet=1, order_bits=2)
TIES = all_tied(140, 1, width=16, height=4)
FEW = random_list(5, 5, width=16, height=4, flat=True)


@EVERY
def test_sixty_four_nodes():
    """More triangles than nodes, so that the order decides in ties; and fewer, so that most of
    them draw nothing."""
    assert MACHINE.nodes == MACHINE.words == 64
    each = [(immediate(MACHINE, listed), MACHINE, listed) for listed in (TIES, FEW)]
    frames(MACHINE, each, compiled(), memory_seed=1)


@EVERY
def test_a_frame_begins_when_all_nodes_show_the_last_one():
    """Frame after frame without a pause, in each of which the last node is sent its triangle
    first; that it may be, since of two nodes the order does not matter."""
    lists = [random_list(seed, 64, width=16, height=4, flat=True) for seed in range(3)]
    words = []
    for listed in lists:
        start, *triangles, end = immediate(MACHINE, listed)
        words += [start, *reversed(triangles), end]
    answered = run(MACHINE, [*words, READ_DEPTH], compiled(), memory_seed=2)
    depths = [value for kind, value, _ in answered.responses if kind == ResponseKind.DEPTH]
    picture, _ = merge_cage(MACHINE, lists[-1])
    np.testing.assert_array_equal(organisation_of(MACHINE).depth_image(depths),
                                  picture.picture.depth)
    ends = [cycle for kind, _, cycle in answered.responses if kind == ResponseKind.FRAME_SHOWN]
    shown = [scan.picture for scan in answered.scans if scan.cycle > ends[0]]
    videos = [expected_video(MACHINE, golden_picture(MACHINE, listed).color) for listed in lists]
    seen = [next(number for number, video in enumerate(videos) if (video == picture).all())
            for picture in shown]
    assert seen == sorted(seen) and set(seen) == {0, 1, 2}
