"""When processing elements whose memory units have one port have drawn their triangles.

How long a span takes depends on what waits before the ports when it comes, and on where the scan
is; so each is followed by itself, when its turn is.
"""

from __future__ import annotations

from collections import deque
from itertools import pairwise
from typing import Protocol

import numpy as np

from ...organisations.organisation import Organisation
from ..element_latencies import NEVER, Drawn, Pipeline
from ..row_clocks import Entries, WalkedSpans
from .one_port_lanes import ElementLanes, SpanAccesses
from .port_accesses import PortAccesses
from .scan_reads import lane_slots, scan_shares
from .scanned_lanes import ScannedLanes

#: What leaves the walker for a triangle, each with its ``Entries.offset``; None where it is no span
#: but only the triangle's end.
OnePortCost = list[tuple[int, SpanAccesses | None]]


class Lanes(Protocol):
    """The lanes of a processing element: ``ElementLanes`` or ``ScannedLanes``."""

    @property
    def done(self) -> float: ...

    def take(self, begin: float, accesses: SpanAccesses) -> float: ...


class OnePort:
    """The ports of a node, one of each unit, and the ``elements`` before them.

    ``begin``: the first clock is so many after a scan began to show its first line; None where
    nobody knows.  ``scanned``: as the picture that is shown lies in memory, if otherwise than that
    which is drawn.
    """

    def __init__(self, organisation: Organisation, accesses: PortAccesses,
                 pipeline: Pipeline, node: int = 0, begin: int | None = None,
                 scanned: Organisation | None = None) -> None:
        self._accesses = accesses
        own = [element for element, domain in enumerate(organisation.domains)
               if domain.node == node]
        lanes: list[Lanes]
        if begin is None:
            shares = scan_shares(organisation)
            lanes = [ElementLanes(organisation.configuration, shares[:, element])
                     for element in own]
        else:
            slots = lane_slots(organisation if scanned is None else scanned)
            lanes = [ScannedLanes(organisation, slots[:, :, element], begin) for element in own]
        self.elements = [OnePortElement(each, pipeline) for each in lanes]

    @property
    def bound(self) -> float:
        """Clocks that the busiest unit needs for the spans whose costs were asked for."""
        return self._accesses.bound

    def costs(self, entries: Entries, spans: WalkedSpans) -> list[OnePortCost]:
        """The cost of each pair, as the pair's element takes it; ``spans`` in drawing order."""
        # A span that crosses several squares is an entry in each.
        each: list[SpanAccesses] = (
            self._accesses.of(spans) / spans.squares[:, np.newaxis, np.newaxis]).tolist()
        found = [(offset, each[span] if span >= 0 else None) for offset, span in zip(
            entries.offset.tolist(), entries.span.tolist(), strict=True)]
        return [found[first:end] for first, end in pairwise(entries.first.tolist())]


class OnePortElement:
    """A processing element that is told its triangles in drawing order."""

    def __init__(self, lanes: Lanes, pipeline: Pipeline) -> None:
        self._pipeline = pipeline
        self._lanes = lanes
        # When each of the last spans was begun.
        self._begun = deque([NEVER], pipeline.spans_ahead + 1)
        self._passed = self._drawn = NEVER

    def take(self, load: float, cost: OnePortCost) -> Drawn:
        """A triangle that its walker loads then."""
        pipeline, lanes, begun = self._pipeline, self._lanes, self._begun
        base, passed, drawn = load + pipeline.latency, self._passed, self._drawn
        for offset, accesses in cost:
            begin = max(passed, base + offset)
            if accesses is None:  # takes a clock, in which fragments before it may wait
                passed = begin + 1
            else:
                begin = max(begin, drawn)
                drawn = lanes.take(begin, accesses)
                passed = max(begin + sum(accesses[0]), drawn - 1)
            begun.append(begin)
        drawn = max(drawn, passed)
        self._passed, self._drawn = passed, drawn
        return Drawn(drawn, begun[0] - pipeline.lead, max(drawn, lanes.done))
