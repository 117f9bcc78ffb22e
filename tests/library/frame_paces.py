"""Frames one right after another: how long each takes, and what it waits for."""

from typing import NamedTuple

import numpy as np
from frames import SCREEN, triangles
from node_frames import (
    CLEAR_LISTS,
    READ_COUNTERS,
    READ_DEPTH,
    check_merged,
    compiled,
    immediate,
    loads,
    redrawn,
    run,
)

from cardcage.golden.specification.commands import ResponseKind
from cardcage.testbenches.frames.responses import Answers

#: So many frames are timed.
FRAMES = 8


def first_line(machine):
    """Clocks from the beginning of a scan until it fetches the first pixel."""
    timing = machine.timing
    return machine.clocks_per_pixel * (
        timing.horizontal_sync + timing.horizontal_back
        + (timing.vertical_sync + timing.vertical_back) * timing.horizontal_total)


def cycles_of(answered, kind):
    return [cycle for found, _, cycle in answered.responses if found == kind]


def values_of(answered, kind):
    return [value for found, value, _ in answered.responses if found == kind]


def screens(machine, count, seed, depths):
    """Triangles over the whole screen, of which the nodes that draw them hide all or none."""
    source = np.random.default_rng(seed)
    depth = {"rising": 100 + np.arange(count), "falling": 4000 - np.arange(count)}[depths]
    return triangles([np.array(SCREEN) * [machine.width / 8, machine.height / 8]] * count,
                     depth[:, np.newaxis].repeat(3, axis=1),
                     source.integers(0, 256, (count, 1, 3)).repeat(3, axis=1),
                     width=machine.width, height=machine.height)


class Pace(NamedTuple):
    """Clocks: of a ``frame``, from one merged picture to the next; to ``draw``, to ``merge``;
    ``scan``: of one scan, ``scans``: of as many whole ones as hold the longer of the two."""

    frame: float
    draw: int
    merge: int
    scan: int

    @property
    def scans(self):
        return -(-max(self.draw, self.merge) // self.scan) * self.scan

    @property
    def bound(self):
        """Which of the three takes longest."""
        longest = {"drawing": self.draw, "merging": self.merge, "a scan": self.scan}
        return max(longest, key=longest.get)

    def __str__(self):
        return (f"a frame in {self.frame:.0f} clocks, drawn in {self.draw}, merged in "
                f"{self.merge}, a scan in {self.scan}: bound by {self.bound}"
                f"{', in whole scans' * (self.frame == self.scans)}")


def pace(machine, listed, *, retained):
    """That of ``FRAMES`` frames, from the second merged picture on to the last one, which is
    checked."""
    frame = redrawn(machine, listed) if retained else immediate(machine, listed)
    words = [*([CLEAR_LISTS, *loads(machine, listed)] if retained else []), *frame * FRAMES,
             READ_DEPTH, READ_COUNTERS]
    answered = run(machine, words, compiled())
    check_merged(machine, listed, Answers(machine, answered).frame(FRAMES - 1, reading=0,
                                                                  read_back=0))
    times = cycles_of(answered, ResponseKind.MERGED)
    drawn, merged = (values_of(answered, kind) for kind in (ResponseKind.FRAME_DRAWN,
                                                            ResponseKind.MERGED))
    assert len(times) == FRAMES
    return Pace((times[-1] - times[1]) / (FRAMES - 2), drawn[0], merged[0] - drawn[0],
                machine.cycles_per_scan)
