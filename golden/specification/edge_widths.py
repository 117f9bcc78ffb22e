"""Bits of the words that edges are kept in, each with its reason."""

from __future__ import annotations


def edge_column_bits(coordinate_bits: int, sub_bits: int) -> int:
    """Width of ``Edges.column`` as a signed number, on every row where it is used.

    There the edge's intercept X lies between its two ends, so in
    [-2**(b-1), 2**(b-1) - 1], and ceil((X - unit/2) / unit) in
    [-2**(b-1-s), 2**(b-1-s)], both ends included.
    """
    return coordinate_bits - sub_bits + 1


def edge_height_bits(coordinate_bits: int) -> int:
    """Width of an edge's height, ``Edges.denominator``, unsigned.

    An edge is at most 2**b - 1 units high.  ``Edges.remainder`` and ``remainder_step`` are less
    than its height, so they have the same width.
    """
    return coordinate_bits


def edge_fraction_bits(height_bits: int, rows: int) -> int:
    """Fraction bits at which a carried edge is exact on each of up to ``rows`` rows.

    ``CarriedEdges.start`` lies at least 1 / 2D from a whole number, D being the edge's
    height, and so does the value on any later row.  Start and step, each rounded to
    nearest at 2**-f, err by at most (1 + row) * 2**-(f+1) together; hence 2**f > D * rows
    will do, and D is below ``2**height_bits``.
    """
    return (((1 << height_bits) - 1) * rows).bit_length()


def fewest_edge_fraction_bits(height: int, rows_height: int) -> int:
    """The same, where no edge is higher than ``height``, nor its height times the rows it is
    followed down greater than ``rows_height``.

    2**f = D * rows will do as well: D is a power of two then, and start and step are multiples of
    1 / 2D, so that nothing is rounded once 2**f is 2D.
    """
    return max((rows_height - 1).bit_length(), height.bit_length())
