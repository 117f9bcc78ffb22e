"""What the walkers of processing elements find of each triangle, and when.

A processing element is two servers in a row: the walker, which finds a row a clock,
and the memory ports, which take clocks for each fragment; between them wait the
spans that were found ahead.  What the ports take is ``two_port_element`` and
``one_port_element``.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from ..organisations.organisation import ElementBlock
from .element_latencies import Pipeline
from .element_spans import LatticeSpans
from .one_port.port_accesses import DrawnSpans

Bool = NDArray[np.bool_]
Int64 = NDArray[np.int64]


def walks(blocks: Sequence[ElementBlock], elements: int, spans: LatticeSpans,
          pipeline: Pipeline) -> tuple[Bool, Int64, Int64]:
    """Which element keeps which triangle, bool (triangles, elements); from its load the clocks to
    the next one, alike; and to the first row of each block, (triangles, blocks).

    Where the domain is one block a triangle is dropped by its bounding box; where it is several
    it is walked, row or no row.
    """
    shares = _blocks_of(blocks, elements)
    kept = np.zeros((spans.end - spans.begin, elements), bool)
    clocks = np.where(shares > 1, pipeline.first_row, 0) + np.zeros(kept.shape, np.int64)
    first_row = np.zeros(spans.rows.shape, np.int64)
    for number, block in enumerate(blocks):
        element, rows = block.element, spans.rows[:, number]
        if shares[element] == 1:
            kept[:, element] = spans.met[:, number]
            clocks[:, element] = rows
            continue
        kept[:, element] = True
        first_row[:, number] = clocks[:, element]
        last = block.place == shares[element] - 1
        clocks[:, element] += np.maximum(rows, 1) + (pipeline.again if last else pipeline.block)
    # Squares that a row crosses take a clock each.
    np.add.at(clocks, (spans.triangle, spans.element), spans.squares - 1)
    return kept, np.where(kept, clocks, 0), first_row


def _blocks_of(blocks: Sequence[ElementBlock], elements: int) -> Int64:
    return np.bincount([block.element for block in blocks], minlength=elements)


class WalkedSpans(DrawnSpans, Protocol):
    """Spans as walkers find them.

    ``element``  int64 (n,): whose each is
    ``length``   int64 (n,): pixels
    ``squares``  int64 (n,): entries that each is, one after another
    """

    @property
    def element(self) -> Int64: ...

    @property
    def length(self) -> Int64: ...

    @property
    def squares(self) -> Int64: ...


@dataclass(frozen=True, eq=False)
class Entries:
    """Everything that leaves the walkers for the triangles of some spans.

    A pair is a triangle with an element that keeps it; they are numbered by (triangle, element),
    and the entries lie in the order of the pairs, of each as they are found.

    ``triangle``  int64 (pairs,): counted from the first of these triangles
    ``element``   int64 (pairs,)
    ``walk``      int64 (pairs,): clocks from this load of the walker to the next
    ``pair``      int64 (n,)
    ``offset``    int64 (n,): clocks from the load until this row is found, less those that any row
                  takes
    ``span``      int64 (n,): which of the spans, or -1 where it is only the triangle's end; a span
                  that crosses several squares is an entry in each
    """

    triangle: Int64
    element: Int64
    walk: Int64
    pair: Int64
    offset: Int64
    span: Int64

    @property
    def first(self) -> Int64:
        """int64 (pairs + 1,): where the entries of each pair begin."""
        return np.searchsorted(self.pair, np.arange(len(self.triangle) + 1))


def entries_of(blocks: Sequence[ElementBlock], elements: int, spans: LatticeSpans,
               pipeline: Pipeline) -> Entries:
    """What leaves the walkers for the triangles of ``spans``."""
    kept, walk, first_row = walks(blocks, elements, spans, pipeline)
    triangle, element = np.nonzero(kept)
    pairs = np.full(kept.shape, -1)
    pairs[kept] = np.arange(len(triangle))

    of_span = pairs[spans.triangle, spans.element]
    source = np.repeat(np.arange(len(of_span)), spans.squares)
    pair = of_span[source]
    more = np.arange(len(source)) - np.repeat(np.arange(len(of_span)), spans.squares)
    # Counted from the first span of the same triangle and element.
    order = np.argsort(pair, kind="stable")
    starts = np.searchsorted(pair[order], pair[order])
    more[order] -= more[order][starts]
    row = first_row[spans.triangle, spans.block][source] + spans.step[source] + more

    last_block = {block.element: number for number, block in enumerate(blocks)}
    last = np.array([last_block[block.element] == number for number, block in enumerate(blocks)])
    final = last[spans.block] & (
        spans.step == np.maximum(spans.rows[spans.triangle, spans.block], 1) - 1)
    unfinished = np.ones(len(triangle), bool)
    unfinished[of_span[final]] = False
    ends = np.flatnonzero(unfinished)
    again = np.where(_blocks_of(blocks, elements) > 1, pipeline.again, 0)
    last_row = (walk - again - 1)[kept]

    pair = np.concatenate([pair, ends])
    offset = np.concatenate([row, last_row[ends]])
    span = np.concatenate([source, np.full(len(ends), -1)])
    order = np.lexsort((span < 0, offset, pair))
    return Entries(triangle, element, walk[kept], pair[order], offset[order], span[order])
