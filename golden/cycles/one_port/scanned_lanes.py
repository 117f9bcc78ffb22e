"""The lanes of a processing element where it is known where the scan is: what it leaves to each is
followed clock by clock."""

from __future__ import annotations

from collections import deque

from ...organisations.organisation import Organisation
from ...specification.queues import FRAGMENTS_WAITING
from .free_clocks import FreeClocks
from .one_port_lanes import LANE_START, SpanAccesses
from .scan_reads import Bool


class ScannedLanes:
    """As ``ElementLanes``; its first clock is ``begin`` clocks after a scan began to show its first
    line.

    ``slots``: bool (rows, pixels, 2), its own of ``scan_reads.lane_slots``.
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
