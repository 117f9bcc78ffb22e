"""What of each triangle falls to each processing element, as its walker meets it.

A domain is walked as aligned blocks of units; the pixels of a block form a
lattice, so a triangle's covered columns in a row are cut into one span for each
lattice that has pixels in that row.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from .cards import domains
from .configuration import MachineConfiguration
from .coverage import Spans, Triangles, spans
from .interlace import Interlace

Int64 = NDArray[np.int64]

#: Rows of triangles cut up at once.
ROW_LIMIT = 1 << 12


@dataclass(frozen=True)
class LatticeBlock:
    """An aligned power of two of units: pixels 2**bits apart in x and y, from an offset.

    ``place`` counts the blocks of one processing element, ``element``.
    """

    element: int
    place: int
    x_offset: int
    y_offset: int
    x_bits: int
    y_bits: int


@dataclass(frozen=True, eq=False)
class LatticeSpans:
    """The spans of the triangles ``begin`` … ``end`` - 1, in the order of (triangle, element,
    block, row); int64 (n,) each.  None is empty.

    ``triangle``  counted from ``begin``
    ``element``   processing element
    ``place``     block of that element
    ``step``      lattice rows that lie in the triangle above this one
    ``row``       row of the picture
    ``length``    pixels
    ``source``    index of the whole span in ``whole``, the covered columns it is cut from
    ``x_offset`` ``x_bits`` ``y_bits``  of the block
    ``rows``      int64 (end - begin, blocks): lattice rows of each triangle in each block
    """

    begin: int
    end: int
    triangle: Int64
    element: Int64
    place: Int64
    step: Int64
    row: Int64
    length: Int64
    source: Int64
    x_offset: Int64
    x_bits: Int64
    y_bits: Int64
    whole: Spans
    rows: Int64


def lattice_blocks(configuration: MachineConfiguration) -> list[LatticeBlock]:
    """The blocks of every processing element, in the order in which they are walked."""
    interlace = configuration.interlace
    return [block for element, (first, count) in enumerate(domains(configuration.cards))
            for block in _blocks(element, first, first + count, interlace)]


def _blocks(element: int, first: int, end: int, interlace: Interlace) -> Iterator[LatticeBlock]:
    place = 0
    while first < end:
        largest = (end - first).bit_length() - 1
        aligned = (first & -first).bit_length() - 1 if first else largest
        bits = min(largest, aligned)
        x_bits, y_bits = interlace.stride_bits(bits)
        x, y = interlace.pixel(first, 0)
        yield LatticeBlock(element, place, x & ((1 << x_bits) - 1), y & ((1 << y_bits) - 1),
                           x_bits, y_bits)
        first += 1 << bits
        place += 1


def lattice_spans(triangles: Triangles, blocks: list[LatticeBlock],
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


def _cut(triangles: Triangles, blocks: list[LatticeBlock], begin: int, end: int,
         whole: Spans) -> LatticeSpans:
    y_bits = np.array([block.y_bits for block in blocks])
    y_offset = np.array([block.y_offset for block in blocks])
    top, bottom = (rows[begin:end, np.newaxis].astype(np.int64)
                   for rows in (triangles.top, triangles.bottom))
    # Lattice rows before a row r are those of r - offset over the stride, rounded up.
    above = -((y_offset - top) >> y_bits)
    rows = -((y_offset - bottom) >> y_bits) - above
    parts = []
    last = whole.first + whole.length - 1
    for x_bits, y_stride in sorted({(block.x_bits, block.y_bits) for block in blocks}):
        for x_offset in range(1 << x_bits):
            by_row = np.full(1 << y_stride, -1)
            for place, block in enumerate(blocks):
                if (block.x_bits, block.y_bits, block.x_offset) == (x_bits, y_stride, x_offset):
                    by_row[block.y_offset] = place
            block_number = by_row[whole.row & ((1 << y_stride) - 1)]
            length = ((last - x_offset) >> x_bits) - ((whole.first - 1 - x_offset) >> x_bits)
            found = np.flatnonzero((length > 0) & (block_number >= 0))
            parts.append((found, block_number[found], length[found]))
    source, number, length = (np.concatenate(part) for part in zip(*parts, strict=True))
    triangle = whole.triangle[source] - begin
    order = np.lexsort((whole.row[source], number, triangle))  # blocks count by element
    source, number, length, triangle = (array[order] for array in (source, number, length,
                                                                   triangle))
    row = whole.row[source]
    facts = {name: np.array([getattr(block, name) for block in blocks], np.int64)
             for name in ("element", "place", "x_offset", "x_bits", "y_bits")}
    return LatticeSpans(
        begin=begin, end=end, triangle=triangle, row=row, length=length, source=source,
        step=-((y_offset[number] - row) >> y_bits[number]) - above[triangle, number],
        whole=whole, rows=rows, **{name: array[number] for name, array in facts.items()})
