"""The rows of a triangle that one processing element owns, one a clock."""

from amaranth.hdl import *
from amaranth.lib import data, stream, wiring
from amaranth.lib.wiring import In, Out

from ...golden.specification import commands
from ...golden.specification.configuration import MachineConfiguration
from ..backplane.words import row_shape, struct_layout, walked_outline_layout
from ..mapping.lattice import LatticeBlock, first_owned, lattice_layout, next_owned
from ..mapping.region_address import visited_layout

__all__ = ["TriangleRows", "row_layout"]


def row_layout(configuration: MachineConfiguration) -> data.StructLayout:
    """One row of a triangle, with what its ends are computed from.

    ``y``             the row, at the machine's resolution
    ``rows``          rows from the triangle's top to it
    ``short_rows``    rows from the first one of its short edge to it
    ``long_edge_left``, ``long``, ``short``  the edges that bound it
    ``left``          the triangle's first column, from which interpolants count
    ``lattice``       the columns that are owned; where regions are dealt out, ``region`` instead
    ``none``          no row at all: the triangle has none here
    ``last``          nothing of the triangle follows
    """
    edge = struct_layout(commands.edge_layout(configuration))
    return data.StructLayout({
        "y": configuration.y_bits,
        "rows": configuration.y_bits,
        "short_rows": configuration.y_bits,
        "long_edge_left": 1,
        "long": edge,
        "short": edge,
        "left": configuration.x_bits,
        **({"lattice": lattice_layout(configuration)} if configuration.regions is None
           else {"region": visited_layout(configuration)}),
        "none": 1,
        "last": 1,
    })


class TriangleRows(wiring.Component):
    """Outlines of triangles in, the rows of this domain out.

    The domain is walked as aligned blocks of units, whose pixels form a regular
    lattice (one block, where the shares are equal powers of two); of each block
    only rows that it owns are visited.  What goes from block to block is built only
    where there may be several (``MachineConfiguration.aligned_domains``).

    Whatever the triangle, its rows end.  ``bottom`` is at most the picture's height: the
    controller and its set-up see to that.  A row follows only one above ``bottom``, and lies
    below it by what an element skips at most, for which ``row_shape`` has the bits past the
    height: so rows only grow, and one is past ``bottom`` at last.  A first row that is not
    above ``bottom`` already, with ``top`` at most the height too, has none after it; and the
    blocks of a domain have ever higher numbers up to its ``end``.

    Latency: two clocks.  Throughput: a row a clock, the next triangle without a
    bubble.  In a domain of several blocks each costs three clocks more, and one
    without rows a clock.

    Members
    -------
    total, first, end: In(id_bits)
        Number of units; this domain, ``end`` excluded.  Static while triangles come.
    triangles: In(stream of walked_outline_layout)
        ``top`` and ``bottom`` are at most the picture's height; the rest may be anything.
    rows: Out(stream of row_layout)
    lattice: Out(lattice_layout)
        The lattice of the domain's first block, from the clock after ``end`` has settled.
    whole: Out(1)
        The domain is one block.
    busy: Out(1)
        Holds a triangle or a row.
    preparing: Out(1)
        In this clock it takes up another block.

    Fuchs & Johnson, figure 13: pixels of one unit are a constant distance apart.
    """

    latency = 2

    def __init__(self, *, configuration: MachineConfiguration):
        self.configuration = configuration
        unit, row = configuration.id_bits, row_shape(configuration)
        # The block that is walked.
        self._lattice = Signal(lattice_layout(configuration), name="lattice")
        self._settled = Signal(init=1, name="settled")  # the lattice is that of the block
        self._further = Signal(name="further")  # it is not the domain's first one
        self._block_first = Signal(unit, name="block_first")  # where it begins, if so
        self._after = Signal(unit, name="after")  # where the next one begins
        self._last_block = Signal(name="last_block")
        self._nobody = Signal(name="nobody")  # the domain has no units
        # The triangle that is walked.
        self._triangle = Signal(walked_outline_layout(configuration), name="triangle",
                                reset_less=True)
        self._holding = Signal(name="holding")  # there is one
        self._finding = Signal(name="finding")  # another block: its first row is not known
        self._priming = Signal(name="priming")  # that row is known, the one after it is not
        self._outside = Signal(name="outside")  # the block has no row of the triangle
        # Its rows: this one, the next one, and whether that is past the end; the one after
        # ``base``, which is whichever of the two is known last.
        self._y = Signal(row, name="y")
        self._following = Signal(row, name="following")
        self._ended = Signal(name="ended")
        self._base = Signal(row, name="base")
        self._after_base = Signal(row, name="after_base")
        # In this clock: a triangle may be taken; a row is known; it is the triangle's last one.
        self._load = Signal(name="load")
        self._walking = Signal(name="walking")
        self._finishes = Signal(name="finishes")
        super().__init__({
            "total": In(configuration.id_bits),
            "first": In(configuration.id_bits),
            "end": In(configuration.id_bits),
            "triangles": In(stream.Signature(walked_outline_layout(configuration))),
            "rows": Out(stream.Signature(row_layout(configuration))),
            "lattice": Out(lattice_layout(configuration)),
            "whole": Out(1),
            "busy": Out(1),
            "preparing": Out(1),
        })

    def elaborate(self, platform):
        m = Module()
        move = ~self.rows.valid | self.rows.ready
        after = self._follow_block(m)
        self._find_row_after(m, move)
        with m.If(move):
            self._send_row(m)
            with m.If(self._walking):
                m.d.sync += self._y.eq(self._following)
                with m.If(self._finishes):
                    m.d.sync += self._holding.eq(0)
        with m.If(self._priming | (move & self._walking)):
            m.d.sync += [self._following.eq(self._after_base),
                         self._ended.eq(self._after_base >= self._triangle.bottom)]
        self._take_triangle(m)
        if self.configuration.aligned_domains:
            m.d.comb += self._last_block.eq(1)
        else:
            m.d.sync += self._last_block.eq(after == self.end)
            self._go_from_block_to_block(m, move)
        m.d.comb += [
            self.busy.eq(self._holding | self.rows.valid),
            self.preparing.eq(self._finding | self._priming | ~self._settled),
        ]
        return m

    def _follow_block(self, m):
        """The lattice of the block that is walked, in registers.  Returns the unit after it."""
        m.submodules.block = block = LatticeBlock(configuration=self.configuration)
        m.d.comb += [
            block.total.eq(self.total),
            block.first.eq(Mux(self._further, self._block_first, self.first)),
            block.end.eq(self.end),
            self.lattice.eq(self._lattice),
            self.whole.eq(self._settled & self._last_block & ~self._further),
        ]
        m.d.sync += [
            self._settled.eq(1),
            self._lattice.eq(block.lattice),
            self._after.eq(block.after),
            self._nobody.eq(self.first == self.end),
        ]
        return block.after

    def _find_row_after(self, m, move):
        """The row after the next one, and what happens in this clock."""
        m.d.comb += [
            self._walking.eq(self._holding & ~self._finding & ~self._priming),
            self._finishes.eq(self._nobody | (self._ended & self._last_block)),
            self._load.eq(self._settled & ~self._further
                          & (~self._holding | (move & self._walking & self._finishes))),
            self.triangles.ready.eq(self._load),
            self._base.eq(Mux(self._priming, self._y, self._following)),
            self._after_base.eq(next_owned(self._base, self._lattice.y_mask,
                                           self.configuration.square_bits)),
        ]

    def _send_row(self, m):
        row, triangle, y = self.rows.payload, self._triangle, self._y
        in_upper = y < triangle.middle
        m.d.sync += [
            self.rows.valid.eq(self._walking & (self._finishes | ~self._outside)),
            row.y.eq(y),
            row.rows.eq(y - triangle.top),
            row.short_rows.eq(y - Mux(in_upper, triangle.top, triangle.middle)),
            row.long_edge_left.eq(triangle.long_edge_left),
            row.long.eq(triangle.long),
            row.short.eq(Mux(in_upper, triangle.upper, triangle.lower)),
            row.left.eq(triangle.left),
            row.lattice.eq(self._lattice),
            row.none.eq(self._nobody | self._outside),
            row.last.eq(self._finishes),
        ]

    def _take_triangle(self, m):
        coming = self.triangles.payload
        with m.If(self._load & self.triangles.valid):
            m.d.sync += [
                self._holding.eq(1),
                self._triangle.eq(coming),
                self._y.eq(coming.first_row),
                self._following.eq(coming.second_row),
                self._ended.eq(coming.one_row),
            ]

    def _go_from_block_to_block(self, m, move):
        """Behind a block's last row: its neighbour's lattice, first row, and the row after it."""
        triangle, lattice = self._triangle, self._lattice
        with m.If(self._finding & self._settled):
            m.d.sync += [
                self._y.eq(first_owned(triangle.top, lattice.y_offset, lattice.y_mask,
                                       self.configuration.square_bits)),
                self._finding.eq(0),
                self._priming.eq(1),
            ]
        with m.If(self._priming):
            m.d.sync += [self._priming.eq(0), self._outside.eq(self._y >= triangle.bottom)]
        with m.If(move & self._walking):
            with m.If(self._finishes):
                m.d.sync += [self._further.eq(0), self._settled.eq(~self._further)]
            with m.Elif(self._ended):
                m.d.sync += [self._finding.eq(1), self._further.eq(1), self._settled.eq(0),
                             self._block_first.eq(self._after)]
        with m.If(self._load & self.triangles.valid):
            # The first row that came with the triangle is the first owned one of some block, not
            # of this one.
            m.d.sync += [self._outside.eq(0), self._finding.eq(~self._last_block & ~self._nobody)]
