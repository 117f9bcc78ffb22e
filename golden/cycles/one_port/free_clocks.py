"""Clocks that the scan leaves to the lanes of a processing element, where it is known where the
scan is.

A unit is read for the scan in one clock, as the first of a group of pixels is shown
(``Organisation.scan_group``); whose units these are differs from line to line, and where regions
of the screen are dealt out also along a line.
"""

from __future__ import annotations

from bisect import bisect_left, bisect_right
from collections import deque

import numpy as np
from numpy.typing import NDArray

from ...organisations.organisation import Organisation
from ...specification.queues import FRAGMENTS_WAITING
from .one_port_lanes import LANE_START, SpanAccesses, lane_of

Bool = NDArray[np.bool_]


def lane_slots(organisation: Organisation) -> Bool:
    """bool (rows, pixels of a row, elements, 2): a unit of that lane reads for the scan as that
    pixel begins.  The rows repeat; the pixels are those of the machine's resolution."""
    tile, group = organisation.scan_tile, organisation.scan_group
    rows, columns = tile.shape
    width = organisation.resolution.width
    first = np.arange(0, width, group)
    slots = np.zeros((rows, width, len(organisation.domains) + 1, 2), bool)  # the last: orphans
    y, x = np.mgrid[:rows, :width]
    unit = tile[y, x % columns]
    # All units of a group read at its beginning.
    begin = first[x // group]
    for node, owner in enumerate(organisation.owners):
        if organisation.is_scanned(node):
            slots[y, begin, owner[unit], lane_of(organisation.configuration, unit)] = True
    return slots[:, :, :-1]


class FreeClocks:
    """The clocks of one lane, numbered from ``begin`` clocks after a scan began to show its first
    line.

    ``slots``: bool (rows, pixels), its own of ``lane_slots``.
    """

    def __init__(self, organisation: Organisation, slots: Bool, begin: int) -> None:
        configuration, shifts = organisation.configuration, organisation.resolution
        timing = configuration.timing
        self._line = timing.horizontal_total * configuration.clocks_per_pixel
        patterns, row = np.unique(slots, axis=0, return_inverse=True)
        free = np.ones((len(patterns) + 1, self._line), np.int64)  # the last: nothing is shown
        place = (np.arange(slots.shape[1]) << shifts.x_shift) * configuration.clocks_per_pixel
        free[:-1, place] = ~patterns
        lines = np.arange(timing.vertical_total)
        rows = row.reshape(-1)[(lines >> shifts.y_shift) % len(slots)]
        self._pattern = np.where(lines < timing.vertical_active, rows, len(patterns)).tolist()
        # Free clocks of a line before each of its clocks, and of a scan before each of its lines.
        self._before = np.pad(free.cumsum(axis=1), ((0, 0), (1, 0))).tolist()
        self._lines = np.pad(free.sum(axis=1)[self._pattern].cumsum(), (1, 0)).tolist()
        self._first = self._count(begin)
        self._begin = begin

    def _count(self, clock: float) -> float:
        """Free ones from the scan's first line until then."""
        line, place = divmod(clock, self._line)
        scan, line = divmod(int(line), len(self._pattern))
        before, whole = self._before[self._pattern[line]], int(place)
        part = (place - whole) * (before[whole + 1] - before[whole])
        return float(scan * self._lines[-1] + self._lines[line] + before[whole] + part)

    def before(self, clock: float) -> float:
        """Free ones until then."""
        return self._count(clock + self._begin) - self._first

    def after(self, clock: float, work: float) -> float:
        """When ``work`` free ones have passed since then."""
        scan, left = divmod(self._count(clock + self._begin) + work, self._lines[-1])
        line = bisect_right(self._lines, left) - 1
        left -= self._lines[line]
        before = self._before[self._pattern[line]]
        place = bisect_left(before, left)
        if before[place] > left:  # a part of the clock before
            place -= before[place] - left
        return float((scan * len(self._pattern) + line) * self._line + place - self._begin)


class ScannedLanes:
    """The lanes of a processing element, as ``ElementLanes``, where it is known where the scan is:
    what it leaves to each lane is followed clock by clock.

    ``slots``: bool (rows, pixels, 2), its own of ``lane_slots``.  The first clock is ``begin``
    clocks after a scan began to show its first line.
    """

    def __init__(self, organisation: Organisation, slots: Bool, begin: int) -> None:
        self._free = [FreeClocks(organisation, slots[..., lane], begin) for lane in range(2)]
        self._done = [0.0, 0.0]
        # Of each lane the last spans: fragments, and from when until when it worked for them.
        self._last: list[deque[tuple[float, float, float]]] = [
            deque(maxlen=FRAGMENTS_WAITING) for _ in range(2)]

    @property
    def done(self) -> float:
        return max(self._done)

    def take(self, begin: float, accesses: SpanAccesses) -> float:
        """As ``ElementLanes``."""
        (reads, written, worked), done = accesses, self._done
        sent = reads[0] + reads[1]
        share = [1 - (free.before(begin + sent) - free.before(begin)) / sent
                 for free in self._free]
        # A read is lost where one lane writes while the scan has the other.
        end = begin + sent + written[0] * share[1] + written[1] * share[0]
        for lane in range(2):
            count = reads[lane]
            if count:
                start = max(done[lane], begin + LANE_START)
                done[lane] = self._free[lane].after(start, worked[lane])
                self._last[lane].append((count, start, done[lane]))
                end = max(end, self._room(lane))
        return end

    def _room(self, lane: int) -> float:
        """When no more fragments are left than can wait."""
        waiting: float = FRAGMENTS_WAITING
        for count, start, done in reversed(self._last[lane]):
            if count >= waiting:
                return done - waiting * (done - start) / count
            waiting -= count
        return 0.0
