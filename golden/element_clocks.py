"""What each triangle costs each processing element that keeps it, in clocks.

A processing element is two servers in a row: the walker, which finds a row a clock,
and the memory ports, which take clocks for each fragment; between them wait the
spans that were found ahead.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from .configuration import MachineConfiguration
from .lattice_spans import LatticeBlock, LatticeSpans

Bool = NDArray[np.bool_]
Float64 = NDArray[np.float64]
Int64 = NDArray[np.int64]


@dataclass(frozen=True)
class Pipeline:
    """Facts of the processing element's pipeline, in clocks unless said otherwise.

    ``queue``        from a broadcast to the walker's load, where that is idle
    ``latency``      from the load to the read of the first row's first fragment
    ``found``        from a row's turn in the walker until its first pixel is ready to be valued
    ``spans_ahead``  spans that fit between the walker and the fragments
    ``lead``         by how much the walk runs ahead of the fragments, where they are full
    ``valued``       from the pixel's valuing to the end of its fragment's read
    ``first_row``    to find a triangle's first row, in a domain of several blocks of units
    ``block``        from the last row of a block to the first one of the next
    ``again``        from such a domain's last row to the next load
    ``end``          what a triangle's end without a span takes; 0 where it passes while the span
                     before it is drawn
    ``finish``       from the read of the last fragment until the machine is seen to be done
    """

    queue: int = 3
    latency: int = 15
    found: int = 8
    spans_ahead: int = 16
    lead: int = 5
    valued: int = 6
    first_row: int = 2
    block: int = 3
    again: int = 2
    end: int = 1
    finish: int = 4


def pipeline_of(configuration: MachineConfiguration) -> Pipeline:
    """Where a fragment waits for its port an end has passed meanwhile."""
    return Pipeline(end=1 if configuration.memory_ports == 2 else 0)


@dataclass(frozen=True, eq=False)
class ElementClocks:
    """Of the triangles ``begin`` … ``end`` - 1, by (triangle, element); those that miss an element
    cost it nothing and are not among them.

    ``triangle``  int64 (n,): counted from ``begin``
    ``element``   int64 (n,)
    ``walk``      float64 (n,): from this load to the next
    ``draw``      float64 (n,): at the ports
    ``alone``     float64 (n,): from the first row's first fragment to the last fragment's end,
                  where nothing came before
    ``held``      float64 (n,): the last span leaves the walker no sooner than so long before its
                  last fragment's end
    ``left``      float64 (n,): from the last fragment's end until its accesses are done
    """

    triangle: Int64
    element: Int64
    walk: Float64
    draw: Float64
    alone: Float64
    held: Float64
    left: Float64


#: Which element keeps which triangle, the clocks of its walk, and those to each first row.
Walked = tuple[Bool, Int64, Int64]


def walks(blocks: list[LatticeBlock], elements: int, spans: LatticeSpans,
          pipeline: Pipeline) -> Walked:
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


def _blocks_of(blocks: list[LatticeBlock], elements: int) -> Int64:
    return np.bincount([block.element for block in blocks], minlength=elements)


def element_clocks(blocks: list[LatticeBlock], elements: int, spans: LatticeSpans,
                   walked: Walked, clocks: Float64, left: Float64,
                   pipeline: Pipeline) -> ElementClocks:
    """``walked``: what ``walks`` says; ``clocks``: of each span at the ports, float64 (spans,), and
    ``left``: after it."""
    kept, walk, first_row = walked
    again = np.where(_blocks_of(blocks, elements) > 1, pipeline.again, 0)
    triangle, element = np.nonzero(kept)
    # By element, so that what follows one another in one lies together.
    by_element = np.lexsort((triangle, element))
    triangle, element = triangle[by_element], element[by_element]
    pairs = np.full(kept.shape, -1)
    pairs[triangle, element] = np.arange(len(triangle))

    pair, offset, clocks, none = _entries(spans, pairs, clocks, walk, again, first_row,
                                          blocks)
    clocks = (np.where(none, pipeline.end, clocks) if pipeline.end
              else _with_gaps(element[pair], clocks, none))
    begins = np.concatenate([[0.0], np.cumsum(clocks)])
    first = np.searchsorted(pair, np.arange(len(triangle)))
    last = np.searchsorted(pair, np.arange(len(triangle)), "right") - 1
    end = begins[last + 1]
    lowest = np.searchsorted(element[pair], element)  # the element's first span of this part

    def before_end(spans_back: int) -> Float64:
        """From the start of the span so many before the last to the last one's end: a clock each
        at least, also where no span is more than the end of a triangle."""
        place = last - spans_back
        return np.where(place >= lowest,
                        np.maximum(end - begins[np.maximum(place, 0)], spans_back), np.inf)

    alone = end + (np.maximum.reduceat(offset - begins[:-1], first) if len(first) else 0)
    held = before_end(pipeline.spans_ahead) + pipeline.lead
    last_left = np.zeros(len(triangle))
    last_left[pairs[spans.triangle, spans.element]] = left  # the last assignment stays
    order = np.lexsort((element, triangle))
    return ElementClocks(
        triangle[order], element[order], walk[triangle, element][order].astype(np.float64),
        (end - begins[first])[order], alone[order], held[order], last_left[order])


def _entries(spans: LatticeSpans, pairs: Int64, clocks: Float64, walk: Int64, again: Int64,
             first_row: Int64, blocks: list[LatticeBlock]
             ) -> tuple[Int64, Float64, Float64, Bool]:
    """Everything that leaves the walkers: triangle and element, clocks from the first row to it,
    clocks at the ports, and whether it is no span but only the triangle's end.

    A row that crosses several squares is a span in each.
    """
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
    unfinished = np.ones(int(pairs.max(initial=-1)) + 1, bool)
    unfinished[of_span[final]] = False
    ends = np.flatnonzero(unfinished)
    last_row = np.zeros(len(unfinished), np.int64)
    last_row[pairs[pairs >= 0]] = (walk - again - 1)[pairs >= 0]

    pair = np.concatenate([pair, ends])
    offset = np.concatenate([row, last_row[ends]]).astype(np.float64)
    clocks = np.concatenate([(clocks / spans.squares)[source], np.zeros(len(ends))])
    none = np.arange(len(pair)) >= len(source)
    order = np.lexsort((none, offset, pair))
    return pair[order], offset[order], clocks[order], none[order]


def _with_gaps(element: Int64, clocks: Float64, none: Bool) -> Float64:
    """An end without span passes while the span before it is drawn, or it takes a clock."""
    solid = np.flatnonzero(~none)
    following = np.append(solid[1:], len(none))[:len(solid)]
    same = np.searchsorted(element, element[solid], "right")
    clocks = clocks.copy()
    clocks[solid] = np.maximum(clocks[solid], np.minimum(following, same) - solid)
    return clocks
