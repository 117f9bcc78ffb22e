"""Clocks of a processing element's depth test at the ports of one-port memory units.

A fragment reads, and where it is visible writes, at the one port of its unit, which the
scan has now and then.  Units with even and with odd numbers are served side by side,
in two *lanes*: in a clock one lane reads while the other writes.  Where no processing
element has more than one unit there is one lane.  A few fragments wait before each, so
a span goes on while a lane is still at work for the one before, and is held up only
where more would wait than there is room for.

Each lane is followed as one server with so much work, span by span; which line the
scan is at decides how much of its time it has.
"""

from __future__ import annotations

from ...specification.configuration import MachineConfiguration
from ...specification.queues import FRAGMENTS_WAITING
from .scan_reads import Float64, clocks_per_row

#: Three rows for a span, each by lane: its fragments, its visible fragments, and the clocks that
#: its units need for both.
SpanAccesses = list[list[float]]

#: Clocks that a lane loses where nothing waited: two to its first read, and one until the first
#: write has come down its pipeline and the two take turns.
LANE_START = 3


class ElementLanes:
    """The lanes of one processing element, which are told its spans in drawing order.

    ``shares``: float64 (rows, 2), its own of ``scan_shares``.  The scan begins at clock 0.
    ``done`` is when the lanes have done all that they were told.
    """

    def __init__(self, configuration: MachineConfiguration, shares: Float64) -> None:
        self._clocks_per_row = clocks_per_row(configuration)
        self._shares: list[list[float]] = shares.tolist()
        self._done = [0.0, 0.0]

    @property
    def done(self) -> float:
        return max(self._done)

    def take(self, begin: float, accesses: SpanAccesses) -> float:
        """A span with these accesses begins at ``begin``; the clock in which the next one's first
        fragment may come."""
        (reads, written, worked), done = accesses, self._done
        share = self._shares[int(begin / self._clocks_per_row) % len(self._shares)]
        # A read is lost where one lane writes while the scan has the other.
        end = begin + reads[0] + reads[1] + written[0] * share[1] + written[1] * share[0]
        for lane in range(2):
            count = reads[lane]
            if count:
                pace = 1 - share[lane]
                done[lane] = max(done[lane], begin + LANE_START) + worked[lane] / pace
                end = max(end, done[lane] - FRAGMENTS_WAITING * worked[lane] / (count * pace))
        return end
