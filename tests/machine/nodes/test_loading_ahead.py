"""Lists that are loaded while the last frame is merged and waits for its scan."""

import numpy as np
import pytest
from frames import golden_picture, random_list
from node_frames import (
    CLEAR_LISTS,
    READ_COUNTERS,
    READ_DEPTH,
    compiled,
    frames,
    loads,
    model,
    redrawn,
    run,
)

from cardcage.golden.specification.commands import Opcode, ResponseKind, opcode_of

TREE, CHAIN = "tree of five, vertices, two ports", "chain of two of two elements, two ports"
VERTICES = "chain of three, vertices"


def lists_of(machine, count):
    """Other triangles in every frame, and in every other one many."""
    flat = machine.shading == "flat"
    return [random_list(seed, 4 + 9 * (seed % 2), width=machine.width, height=machine.height,
                        flat=flat) for seed in range(count)]


def sequence(machine, lists):
    """Commands of frames whose lists are each loaded straight after the frame before has ended."""
    return [word for listed in lists
            for word in [CLEAR_LISTS, *loads(machine, listed), *redrawn(machine, listed)]]


@pytest.mark.parametrize("stall_seed", [None, 1, 2])
@pytest.mark.parametrize("name", [TREE, CHAIN, VERTICES])
def test_pictures_stay_exact(name, stall_seed):
    """Every scan shows one of the pictures whole, and they come in order."""
    machine, _ = model(name)
    lists = lists_of(machine, 6)
    last = [READ_DEPTH, READ_COUNTERS]
    answered = run(machine, [*sequence(machine, lists), *last], compiled(), stall_seed=stall_seed)
    shown = [cycle for kind, _, cycle in answered.responses if kind == ResponseKind.FRAME_SHOWN]
    assert len(shown) == len(lists)
    for listed, begin, end in zip(lists, shown, [*shown[1:], answered.cycles], strict=True):
        scans = [scan for scan in answered.scans if begin < scan.cycle < end]
        picture = golden_picture(machine, listed).color
        assert scans or end != answered.cycles
        for scan in scans:
            np.testing.assert_array_equal(scan.picture, picture)


def test_depths_and_what_is_sent_stay_exact():
    """Of every frame, read back before the next one is drawn but after its lists are loaded."""
    machine, _ = model(TREE)
    lists = lists_of(machine, 4)
    each = [([CLEAR_LISTS, *loads(machine, listed), *redrawn(machine, listed)], machine, listed)
            for listed in lists]
    frames(machine, each, compiled(), stall_seed=3)


@pytest.mark.parametrize("name", [TREE, CHAIN])
def test_lists_are_loaded_before_the_last_frame_is_shown(name):
    """By a host that never waits all of the next list is there when the scan begins."""
    machine, _ = model(name)
    lists = lists_of(machine, 4)
    words = sequence(machine, lists)
    answered = run(machine, words, compiled())
    cycles = {kind: [cycle for found, _, cycle in answered.responses if found == kind]
              for kind in ResponseKind}
    taken = answered.accepted.tolist()
    of = {opcode: [taken[place] for place, word in enumerate(words) if opcode_of(word) == opcode]
          for opcode in Opcode}
    frame_loads = [len(loads(machine, listed)) for listed in lists]
    begin = frame_loads[0]
    for number, count in enumerate(frame_loads[1:]):
        drawn, shown = (cycles[kind][number] for kind in (ResponseKind.FRAME_DRAWN,
                                                          ResponseKind.FRAME_SHOWN))
        assert of[Opcode.CLEAR_LISTS][number + 1] == drawn + 1
        assert drawn < of[Opcode.LOAD][begin] and of[Opcode.LOAD][begin + count - 1] < shown
        # All else waits, and not a clock longer.
        assert of[Opcode.FRAME_START][number + 1] == shown + 1
        begin += count


def test_loading_does_not_delay_a_merge():
    """A tree's steps go on while lists are told something in every clock."""
    machine, listed = model(TREE)
    clocks = []
    for after in ([], [CLEAR_LISTS] * 1000):
        words = [CLEAR_LISTS, *loads(machine, listed), *redrawn(machine, listed), *after]
        answered = run(machine, words, compiled())
        [merged] = [value for kind, value, _ in answered.responses if kind == ResponseKind.MERGED]
        clocks.append(merged)
    assert clocks[0] == clocks[1]
