"""When a processing element whose memory units have two ports has drawn its triangles.

A fragment takes a clock, seen or not.  So the spans of a triangle come to three numbers, made by
whole arrays: what it draws, what it draws alone, and how long its last spans are.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from .element_walks import Entries
from .lattice_spans import LatticeSpans
from .pipeline import NEVER, Drawn, Pipeline

Float64 = NDArray[np.float64]

#: Clocks of a triangle's fragments; from the first row's first fragment to the last fragment's
#: end, where nothing came before; and the last span leaves the walker no sooner than so long before
#: its last fragment's end.
TwoPortCost = tuple[float, float, float]


def two_port_costs(entries: Entries, spans: LatticeSpans, pipeline: Pipeline) -> list[TwoPortCost]:
    """Of each of the pairs."""
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
    lowest = np.searchsorted(entries.element[pair], entries.element)  # the element's first entry

    back = last - pipeline.spans_ahead
    held = np.where(back >= lowest, end - begins[np.maximum(back, 0)], np.inf) + pipeline.lead
    latest = np.maximum.reduceat(entries.offset[order] - begins[:-1], changes)[place]
    return list(zip((end - begins[first]).tolist(), (end + latest).tolist(), held.tolist(),
                    strict=True))


class TwoPortElement:
    """Told its triangles in drawing order."""

    def __init__(self, pipeline: Pipeline) -> None:
        self._latency = pipeline.latency
        self._drawn = NEVER

    def take(self, load: float, cost: TwoPortCost) -> Drawn:
        """A triangle that its walker loads then."""
        draw, alone, held = cost
        drawn = max(self._drawn + draw, load + self._latency + alone)
        self._drawn = drawn
        return Drawn(drawn, drawn - held, drawn)
