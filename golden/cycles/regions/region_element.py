"""A processing element that goes from region to region of its triangles."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

from ..broadcast import Element
from ..element_latencies import NEVER, Drawn
from .large_visits import Band, find_visits

#: Clocks from a visit's load until a row is a span, less two in which room for one more shows.
#: Rows behind a span that waits stay that far behind it, so the next visit is loaded as much
#: before it goes.
LOADED_AHEAD = 5


@dataclass(frozen=True)
class TriangleCost:
    """A triangle that an element keeps.

    ``bands``   of its box, where that is large, else None: all its visits are known before
    ``visits``  rows of each; how many of these follow the last one that leaves the walker; and
                what it costs at the ports, None if nothing leaves the walker
    """

    bands: Sequence[Band] | None
    visits: Sequence[tuple[int, int, Any]]


class RegionElement:
    """An element that is told its triangles in drawing order; ``ports`` are told visit by visit.

    A triangle is at the queue's end until its last visit is taken; the walker goes on with that
    while the next one's are found.
    """

    def __init__(self, ports: Element) -> None:
        self._ports = ports
        self._free = NEVER
        self._drawn = Drawn(NEVER, NEVER, NEVER)

    def take(self, load: float, cost: TriangleCost) -> Drawn:
        """A triangle that is at the queue's end from then on.  ``walker`` of what it gives is when
        the next one is."""
        visits = iter(cost.visits)
        taken = NEVER

        def walk(known: float) -> float:
            nonlocal taken
            taken = max(known, self._free)
            rows, following, accesses = next(visits)
            self._free = taken + rows
            if accesses is not None:
                self._drawn = self._ports.take(taken, accesses)
                self._free = max(self._free, self._drawn.walker + following - LOADED_AHEAD)
            return taken

        if cost.bands is None:
            for _ in cost.visits:
                walk(load)
        else:
            find_visits(load, cost.bands, walk)
        drawn, _, done = self._drawn
        return Drawn(drawn, taken + 1, done)
