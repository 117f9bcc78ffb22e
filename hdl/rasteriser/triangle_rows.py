"""The rows of a triangle that one processing element owns, one a clock."""

from amaranth.hdl import *
from amaranth.lib import data, stream, wiring
from amaranth.lib.wiring import In, Out

from ...golden.specification import commands
from ...golden.specification.configuration import MachineConfiguration
from ..backplane.words import row_shape, struct_layout, walked_outline_layout
from ..mapping.lattice import LatticeBlock, first_owned, lattice_layout, next_owned

__all__ = ["TriangleRows", "row_layout"]


def row_layout(configuration: MachineConfiguration) -> data.StructLayout:
    """One row of a triangle, with what its ends are computed from.

    ``y``             the row, at the machine's resolution
    ``rows``          rows from the triangle's top to it
    ``short_rows``    rows from the first one of its short edge to it
    ``long_edge_left``, ``long``, ``short``  the edges that bound it
    ``left``          the triangle's first column, from which interpolants count
    ``lattice``       the columns that are owned
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
        "lattice": lattice_layout(configuration),
        "none": 1,
        "last": 1,
    })


class TriangleRows(wiring.Component):
    """Outlines of triangles in, the rows of this domain out.

    The domain is walked as aligned blocks of units, whose pixels form a regular
    lattice (one block, where the shares are equal powers of two); of each block
    only rows that it owns are visited.  What goes from block to block is built only
    where there may be several (``MachineConfiguration.aligned_domains``).

    Latency: two clocks.  Throughput: a row a clock, the next triangle without a
    bubble.  In a domain of several blocks each costs three clocks more, and one
    without rows a clock.

    Members
    -------
    total, first, end: In(id_bits)
        Number of units; this domain, ``end`` excluded.  Static while triangles come.
    triangles: In(stream of walked_outline_layout)
    rows: Out(stream of row_layout)
    lattice: Out(lattice_layout)
        Of the domain's first block, from the clock after ``end`` has settled.
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
        configuration = self.configuration
        coming, row = self.triangles.payload, self.rows.payload

        # The lattice of the block that is walked, in registers.
        further = Signal()  # not the domain's first block
        settled = Signal(init=1)
        block_first = Signal.like(self.first)
        after = Signal.like(self.first)
        last_block = Signal()
        nobody = Signal()  # the domain has no units
        lattice = Signal(lattice_layout(configuration))
        m.submodules.block = block = LatticeBlock(configuration=configuration)
        m.d.comb += [
            block.total.eq(self.total),
            block.first.eq(Mux(further, block_first, self.first)),
            block.end.eq(self.end),
            self.lattice.eq(lattice),
            self.whole.eq(settled & last_block & ~further),
        ]
        m.d.sync += [
            settled.eq(1),
            lattice.eq(block.lattice),
            after.eq(block.after),
            nobody.eq(self.first == self.end),
        ]

        # The triangle that is walked: this row, the one after it, and whether that is past the end.
        square_bits = configuration.square_bits
        triangle = Signal(walked_outline_layout(configuration), reset_less=True)
        holding = Signal()
        ended = Signal()
        outside = Signal()
        finding = Signal()  # another block: its first row is not known
        priming = Signal()  # that row is known, the one after it is not
        y = Signal(row_shape(configuration))
        following = Signal(row_shape(configuration))
        base = Signal(row_shape(configuration))
        after_base = Signal(row_shape(configuration))
        load = Signal()
        walking = Signal()
        finishes = Signal()
        move = ~self.rows.valid | self.rows.ready
        m.d.comb += [
            walking.eq(holding & ~finding & ~priming),
            finishes.eq(nobody | (ended & last_block)),
            load.eq(settled & ~further & (~holding | (move & walking & finishes))),
            self.triangles.ready.eq(load),
            base.eq(Mux(priming, y, following)),
            after_base.eq(next_owned(base, lattice.y_mask, square_bits)),
        ]
        with m.If(move):
            m.d.sync += self.rows.valid.eq(walking & (finishes | ~outside))
            self._row(m, triangle, y, row)
            m.d.sync += [
                row.lattice.eq(lattice),
                row.none.eq(nobody | outside),
                row.last.eq(finishes),
            ]
            with m.If(walking):
                m.d.sync += y.eq(following)
                with m.If(finishes):
                    m.d.sync += holding.eq(0)
        with m.If(priming | (move & walking)):
            m.d.sync += [following.eq(after_base), ended.eq(after_base >= triangle.bottom)]
        with m.If(load & self.triangles.valid):
            m.d.sync += [
                holding.eq(1),
                triangle.eq(coming),
                y.eq(coming.first_row),
                following.eq(coming.second_row),
                ended.eq(coming.one_row),
            ]
        if configuration.aligned_domains:
            m.d.comb += last_block.eq(1)
        else:
            m.d.sync += last_block.eq(block.after == self.end)
            with m.If(finding & settled):
                m.d.sync += [
                    y.eq(first_owned(triangle.top, lattice.y_offset, lattice.y_mask, square_bits)),
                    finding.eq(0),
                    priming.eq(1),
                ]
            with m.If(priming):
                m.d.sync += [priming.eq(0), outside.eq(y >= triangle.bottom)]
            with m.If(move & walking):
                with m.If(finishes):
                    m.d.sync += [further.eq(0), settled.eq(~further)]
                with m.Elif(ended):
                    m.d.sync += [finding.eq(1), further.eq(1), settled.eq(0), block_first.eq(after)]
            with m.If(load & self.triangles.valid):
                # The first row that came was that of any of the blocks.
                m.d.sync += [outside.eq(0), finding.eq(~last_block & ~nobody)]
        m.d.comb += [
            self.busy.eq(holding | self.rows.valid),
            self.preparing.eq(finding | priming | ~settled),
        ]
        return m

    def _row(self, m, triangle, y, row):
        in_upper = y < triangle.middle
        m.d.sync += [
            row.y.eq(y),
            row.rows.eq(y - triangle.top),
            row.short_rows.eq(y - Mux(in_upper, triangle.top, triangle.middle)),
            row.long_edge_left.eq(triangle.long_edge_left),
            row.long.eq(triangle.long),
            row.short.eq(Mux(in_upper, triangle.upper, triangle.lower)),
            row.left.eq(triangle.left),
        ]
