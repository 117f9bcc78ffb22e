"""When processing elements whose memory units have two ports have drawn their triangles.

A fragment takes a clock, seen or not.  So the spans of a triangle come to three numbers, made by
whole arrays: what it draws, what it draws alone, and how long its last spans are.
"""

from __future__ import annotations

import numpy as np

from .element_latencies import NEVER, Drawn, Pipeline
from .row_clocks import Entries, WalkedSpans

#: Three numbers of clocks: what a triangle's fragments take; from the first row's first fragment
#: to the last fragment's end, where nothing came before; and how long before that end the last
#: span leaves the walker at the soonest.
TwoPortCost = tuple[float, float, float]


class TwoPorts:
    """The ports of a node, where no fragment waits, and the ``elements`` before them."""

    bound = 0.0

    def __init__(self, elements: int, pipeline: Pipeline) -> None:
        self._pipeline = pipeline
        self.elements = [TwoPortElement(pipeline) for _ in range(elements)]

    def costs(self, entries: Entries, spans: WalkedSpans) -> list[TwoPortCost]:
        """The cost of each pair, as the pair's element takes it."""
        if not len(entries.pair):
            return []
        # Entries of an element one after another, whichever the triangle.
        order = np.argsort(entries.element[entries.pair], kind="stable")
        pair, span = entries.pair[order], entries.span[order]
        # A triangle's end without a span, -1, takes a clock.
        clocks = np.append(spans.length / spans.squares, 1)[span]
        begins = np.concatenate([[0.0], np.cumsum(clocks)])
        changes = np.flatnonzero(np.diff(pair, prepend=-1))
        place = np.argsort(pair[changes])
        first = changes[place]
        last = np.append(changes[1:], len(pair))[place] - 1
        end = begins[last + 1]
        # The first entry of the pair's element.
        lowest = np.searchsorted(entries.element[pair], entries.element)

        back = last - self._pipeline.spans_ahead
        held = (np.where(back >= lowest, end - begins[np.maximum(back, 0)], np.inf)
                + self._pipeline.lead)
        latest = np.maximum.reduceat(entries.offset[order] - begins[:-1], changes)[place]
        return list(zip((end - begins[first]).tolist(), (end + latest).tolist(), held.tolist(),
                        strict=True))


class TwoPortElement:
    """A processing element that is told its triangles in drawing order."""

    def __init__(self, pipeline: Pipeline) -> None:
        self._latency = pipeline.latency
        self._drawn = NEVER

    def take(self, load: float, cost: TwoPortCost) -> Drawn:
        """A triangle that its walker loads then."""
        draw, alone, held = cost
        drawn = max(self._drawn + draw, load + self._latency + alone)
        self._drawn = drawn
        return Drawn(drawn, drawn - held, drawn)
