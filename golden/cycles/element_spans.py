"""What of each triangle falls to each processing element, as its walker meets it.

A domain is walked as aligned blocks of units; the pixels of a block form a
lattice, of single pixels or of squares of them, so a triangle's covered columns in
a row are cut up among the lattices that have pixels in that row.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ..organisations.organisation import ElementBlock
from ..reference.coverage import Spans, Triangles, spans

Bool = NDArray[np.bool_]
Int64 = NDArray[np.int64]

#: Rows of triangles cut up at once.
ROW_LIMIT = 1 << 12


@dataclass(frozen=True, eq=False)
class LatticeSpans:
    """The spans of the triangles ``begin`` … ``end`` - 1, in the order of (triangle, element,
    block, row); int64 (n,) each.  None is empty.

    ``triangle``  counted from ``begin``
    ``element``   processing element
    ``block``     index in the list of blocks
    ``step``      lattice rows that lie in the triangle above this one
    ``row``       row of the picture
    ``length``    pixels
    ``squares``   squares of the lattice that they lie in; 1 where it is one of single pixels
    ``x_offset`` ``x_bits`` ``y_bits``  of the block in this row, in squares of
                  ``2**square_bits`` pixels a side
    ``units``     memory units that its block has
    ``source``    index of the whole span in ``whole``, the covered columns it is cut from
    ``rows``      int64 (end - begin, blocks): lattice rows of each triangle in each block
    ``met``       bool, alike: the triangle's bounding box holds a pixel of the block
    """

    begin: int
    end: int
    triangle: Int64
    element: Int64
    block: Int64
    step: Int64
    row: Int64
    length: Int64
    squares: Int64
    x_offset: Int64
    x_bits: Int64
    y_bits: Int64
    square_bits: int
    units: Int64
    source: Int64
    whole: Spans
    rows: Int64
    met: Bool

    def counted(self, x: Int64, lane: Int64, weights: Bool | None) -> Int64:
        """int64 (n, 2): how many fragments of each span are in each lane, or the sum of their
        weights; ``x`` and ``lane`` of all fragments, triangles ascending, rows ascending, columns
        ascending."""
        # They come in the order of the whole spans and of the columns in each.
        whole = np.repeat(np.arange(len(self.whole)), self.whole.length)
        column = x >> self.square_bits
        counts = np.zeros((len(self), 2), np.int64)
        for bits in np.unique(self.x_bits).tolist():
            key = ((whole << bits) | (column & ((1 << bits) - 1))) * 2 + lane
            found = np.bincount(key, weights, len(self.whole) << bits + 1)
            here = np.flatnonzero(self.x_bits == bits)
            place = (self.source[here] << bits) | self.x_offset[here]
            counts[here] = found.reshape(-1, 2)[place]
        return counts

    def __len__(self) -> int:
        return len(self.length)


def lattice_spans(triangles: Triangles, blocks: Sequence[ElementBlock],
                  row_limit: int = ROW_LIMIT) -> Iterator[LatticeSpans]:
    """All triangles, about ``row_limit`` rows at a time."""
    begin = 0
    for whole in spans(triangles, row_limit):
        end = int(whole.triangle[-1]) + 1 if len(whole) else begin
        if end > begin:
            yield _cut(triangles, blocks, begin, end, whole)
            begin = end
    if begin < len(triangles):  # the last ones cover no pixel
        none = np.zeros(0, np.int64)
        yield _cut(triangles, blocks, begin, len(triangles), Spans(none, none, none, none))


def _before(position: Int64, offset: Int64 | int, bits: Int64 | int, square_bits: int) -> Int64:
    """How many owned columns (or rows) there are from 0 up to ``position``, itself left out."""
    square = position >> square_bits
    ahead = (offset - square) & ((1 << bits) - 1)
    squares = -((offset - square) >> bits)
    within = position & ((1 << square_bits) - 1)
    return np.asarray((squares << square_bits) + np.where(ahead == 0, within, 0))


def _cut(triangles: Triangles, blocks: Sequence[ElementBlock], begin: int, end: int,
         whole: Spans) -> LatticeSpans:
    facts = {name: np.array([getattr(block, name) for block in blocks], np.int64)
             for name in ("element", "x_offset", "y_offset", "x_bits", "y_bits", "shifted",
                          "units")}
    square_bits = blocks[0].square_bits
    left, right, top, bottom = (
        edge[begin:end, np.newaxis].astype(np.int64)
        for edge in (triangles.left, triangles.right, triangles.top, triangles.bottom))
    in_y = facts["y_offset"], facts["y_bits"], square_bits
    # Shifted and other rows of a block, taken together.
    in_x = facts["x_offset"], facts["x_bits"] - facts["shifted"], square_bits
    above = _before(top, *in_y)
    rows = _before(bottom, *in_y) - above
    met = (rows > 0) & (_before(right, *in_x) > _before(left, *in_x))

    parts = []
    beyond = whole.first + whole.length
    for x_bits, y_bits in sorted({(block.x_bits, block.y_bits) for block in blocks}):
        for x_offset in range(1 << x_bits):
            by_row = np.full(2 << y_bits, -1)
            for place, block in enumerate(blocks):
                if (block.x_bits, block.y_bits) == (x_bits, y_bits):
                    for row in (block.y_offset, block.y_offset + (1 << y_bits)):
                        if block.x_offset_of(row) == x_offset:
                            by_row[row] = place
            length, squares = (
                _before(last, x_offset, x_bits, bits) - _before(first, x_offset, x_bits, bits)
                for first, last, bits in (
                    (whole.first, beyond, square_bits),
                    (whole.first >> square_bits, ((beyond - 1) >> square_bits) + 1, 0)))
            if not square_bits or not x_bits:  # one span, whatever it crosses
                squares = np.ones_like(length)
            owner = by_row[(whole.row >> square_bits) & ((2 << y_bits) - 1)]
            found = np.flatnonzero((length > 0) & (owner >= 0))
            parts.append((found, owner[found], length[found], squares[found],
                          np.full(len(found), x_offset)))
    source, number, length, squares, x_offset_of = (
        np.concatenate(part) for part in zip(*parts, strict=True))
    triangle = whole.triangle[source] - begin
    order = np.lexsort((whole.row[source], number, triangle))  # blocks count by element
    source, number, triangle = source[order], number[order], triangle[order]
    row = whole.row[source]
    of_block = {name: values[number] for name, values in facts.items()}
    step = _before(row, of_block["y_offset"], of_block["y_bits"], square_bits)
    return LatticeSpans(
        begin, end, triangle, of_block["element"], number, step - above[triangle, number], row,
        length[order], squares[order], x_offset_of[order], of_block["x_bits"],
        of_block["y_bits"], square_bits, of_block["units"], source, whole, rows, met)
