"""When a processing element whose memory units have one port has drawn its triangles.

How long a span takes depends on what waits before the ports when it comes, and on where the scan
is; so each is followed by itself, when its turn is.
"""

from __future__ import annotations

from collections import deque
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from .configuration import MachineConfiguration
from .element_walks import Entries
from .lanes import ElementLanes, SpanAccesses
from .lattice_spans import LatticeSpans
from .pipeline import NEVER, Drawn, Pipeline

#: What leaves the walker for a triangle: each with the clocks from the first row to it, and None
#: where it is no span but only the triangle's end.
OnePortCost = list[tuple[int, SpanAccesses | None]]


def one_port_costs(entries: Entries, spans: LatticeSpans,
                   accesses: NDArray[np.float64]) -> list[OnePortCost]:
    """Of each of the pairs; ``accesses``: float64 (spans, 3, 2), see ``PortAccesses.of``."""
    # A span that crosses several squares is an entry in each.
    each: list[SpanAccesses] = (accesses / spans.squares[:, np.newaxis, np.newaxis]).tolist()
    found = [(offset, each[span] if span >= 0 else None)
             for offset, span in zip(entries.offset.tolist(), entries.span.tolist(), strict=True)]
    return [found[first:end] for first, end in pairwise(entries.first.tolist())]


class OnePortElement:
    """Told its triangles in drawing order; the scan begins at clock 0."""

    def __init__(self, configuration: MachineConfiguration, element: int,
                 pipeline: Pipeline) -> None:
        self._latency = pipeline.latency
        self._lead = pipeline.lead
        self._lanes = ElementLanes(configuration, element)
        # Of the last spans, when each was begun.
        self._begun = deque([NEVER], pipeline.spans_ahead + 1)
        self._passed = self._drawn = NEVER

    def take(self, load: float, cost: OnePortCost) -> Drawn:
        """A triangle that its walker loads then."""
        base, lanes, begun = load + self._latency, self._lanes, self._begun
        passed, drawn = self._passed, self._drawn
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
        return Drawn(drawn, begun[0] - self._lead, max(drawn, lanes.done))
