"""Bits of a machine's words, each with its reason."""

from __future__ import annotations

from .card_order import Cage
from .fixed_point import guard_bits, stays_in_range
from .ranges import CHANNEL_BITS


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


class Widths(Cage):
    """The widths that follow from the numbers of a configuration, which whoever has these can be
    asked."""

    width: int
    height: int
    depth_bits: int
    fraction_bits: int
    words: int
    block: int
    lines: bool
    maximum_nodes: int
    order_bits: int
    depth_integer_bits: int
    channel_integer_bits: int
    edge_column_bits: int
    edge_fraction_bits: int
    regions: tuple[int, int] | None

    @property
    def node_bits(self) -> int:
        """Node lines on the backplane: enough for the total; none where all is one node."""
        return 0 if self.merge is None else self.maximum_nodes.bit_length()

    @property
    def x_bits(self) -> int:
        """0 … width, the exclusive end of a span included."""
        return self.width.bit_length()

    @property
    def y_bits(self) -> int:
        return self.height.bit_length()

    @property
    def address_bits(self) -> int:
        return max(1, (self.words - 1).bit_length())

    @property
    def square_bits(self) -> int:
        """Log2 of the side of the squares that processing elements interlace in."""
        return self.block.bit_length() - 1

    @property
    def equal_shares(self) -> bool:
        """All processing elements have as many memory units: they interlace in squares, in lines
        or in regions."""
        return self.block > 1 or self.lines or self.regions is not None

    @property
    def share_bits(self) -> int:
        """Log2 of the memory units of each processing element, where all have as many.

        It is that of the cards as built: with boards pulled out so that shares differ, the machine
        draws nothing.
        """
        if not self.equal_shares:
            return 0
        return max(1, *self.shares_of_units).bit_length() - 1

    @property
    def edges_on_screen(self) -> bool:
        """No edge's column is off the screen, and none is signed."""
        return self.edge_column_bits <= self.x_bits

    @property
    def edge_word_bits(self) -> int:
        return self.edge_column_bits + self.edge_fraction_bits

    @property
    def stays_in_range(self) -> bool:
        """Interpolants err by so little that they are carried unsigned, and never saturate."""
        return stays_in_range(self.fraction_bits, self.width + self.height - 2)

    @property
    def depth_plane_bits(self) -> int:
        """Carried depth; sums wrap, values at covered pixels fit with their error."""
        return self._plane_bits(self.depth_integer_bits, self.depth_bits)

    @property
    def rank_bits(self) -> int:
        """What is kept of a pixel to compare it by: depth, and below it the order.  Within a node
        an order never decides, since triangles come in ascending order."""
        return self.depth_bits + self.order_bits

    @property
    def node_order_bits(self) -> int:
        """The node's part of an order, its lowest bits: only where fragments of different nodes
        meet in memory, since merge cards know whose a pixel is."""
        return (self.maximum_nodes - 1).bit_length() if self.merges_directly else 0

    @property
    def round_bits(self) -> int:
        """The round's part of an order."""
        return max(0, self.order_bits - self.node_order_bits)

    @property
    def share_of_list_bits(self) -> int:
        """What a triangle's command says of its node and its round."""
        return self.node_bits + self.round_bits

    @property
    def channel_plane_bits(self) -> int:
        return self._plane_bits(self.channel_integer_bits, CHANNEL_BITS)

    def _plane_bits(self, integer_bits: int, value_bits: int) -> int:
        if not integer_bits:
            integer_bits = value_bits
            if not self.stays_in_range:
                integer_bits += guard_bits(value_bits, self.fraction_bits,
                                           self.width + self.height - 2)
        return integer_bits + self.fraction_bits

    @property
    def depth_background(self) -> int:
        return (1 << self.depth_bits) - 1

    @property
    def rank_background(self) -> int:
        """The greatest depth and the greatest order."""
        return (1 << self.rank_bits) - 1
