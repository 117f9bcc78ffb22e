"""Clocks that the scan leaves to one lane of a processing element, where it is known where the
scan is."""

from __future__ import annotations

from bisect import bisect_left, bisect_right

import numpy as np

from ...organisations.organisation import Organisation
from .scan_reads import Bool


class FreeClocks:
    """The clocks of one lane, numbered from ``begin`` clocks after a scan began to show its first
    line.

    ``slots``: bool (rows, pixels), its own of ``scan_reads.lane_slots``.
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
