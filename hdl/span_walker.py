"""Finds the spans of a triangle on the lattice of pixels that one processing element owns."""

from amaranth.hdl import *
from amaranth.lib import stream, wiring
from amaranth.lib.wiring import In, Out

from ..golden.configuration import MachineConfiguration
from .edge_walker import EdgeWalker
from .interlace import LatticeBlock
from .layouts import prepared_triangle_layout, span_layout

__all__ = ["SpanWalker"]


class SpanWalker(wiring.Component):
    """Prepared triangles in, the spans of this domain out; nothing is searched for.

    The domain is walked as aligned blocks of units, whose pixels form a regular
    lattice.  In each lattice row the long edge and one of the short edges give
    the first and the last column exactly (the top-left rule lies in the rounding
    of the set-up); the span is what of the lattice lies between.  The triangle
    stays at the input until its last block is walked.

    Latency, per block: one clock to load, ``y_stride_bits`` clocks to take up
    the lattice, then the first row's span is offered.  Throughput: a row a
    clock, with or without pixels; a block without any row takes one clock there.

    Members
    -------
    total, first, end: In(id_bits)
        Number of units; this domain, ``end`` excluded.  Static while triangles come.
    triangles: In(stream of prepared triangles)
    spans: Out(stream of span_layout)
        Rows downwards, blocks in order; no empty spans.
    preparing, empty_row: Out(1)
        In this clock it loads or takes up the lattice; it passes a row without a span.

    Fuchs & Johnson, figure 13 and the text around it: the regular pattern that
    allows rapid incremental computation.
    """

    def __init__(self, *, configuration: MachineConfiguration):
        self.configuration = configuration
        super().__init__({
            "total": In(configuration.id_bits),
            "first": In(configuration.id_bits),
            "end": In(configuration.id_bits),
            "triangles": In(stream.Signature(prepared_triangle_layout(configuration))),
            "spans": Out(stream.Signature(span_layout(configuration))),
            "preparing": Out(1),
            "empty_row": Out(1),
        })

    def elaborate(self, platform):
        m = Module()
        triangle = self.triangles.payload
        m.submodules.block = block = LatticeBlock(configuration=self.configuration)
        edges = {name: EdgeWalker(configuration=self.configuration)
                 for name in ("long", "upper", "lower")}
        for name, edge in edges.items():
            m.submodules[f"{name}_edge"] = edge
            m.d.comb += edge.edge.eq(triangle[name])

        started = Signal()  # the block register holds; otherwise the domain's first is next
        after = Signal.like(self.first)
        m.d.comb += [
            block.total.eq(self.total),
            block.first.eq(Mux(started, after, self.first)),
            block.end.eq(self.end),
        ]

        x_offset = Signal.like(block.x_offset)
        y_offset = Signal.like(block.y_offset)
        x_stride_bits = Signal.like(block.x_stride_bits)
        to_double = Signal.like(block.y_stride_bits)
        # One stride may lead past the bottom of a picture smaller than the lattice.
        y = Signal(range(self.configuration.height + 2 * self.configuration.maximum_units))
        y_stride = Signal.like(y)
        upper_steps = Signal.like(y_offset)
        lower_steps = Signal.like(y_offset)

        def rows_to_lattice(row):
            mask = (1 << block.y_stride_bits) - 1
            return (block.y_offset - row) & mask

        with m.FSM():
            with m.State("LOAD"), m.If(self.triangles.valid):
                m.d.comb += self.preparing.eq(1)
                m.d.comb += [edge.load.eq(1) for edge in edges.values()]
                m.d.sync += [
                    after.eq(block.after),
                    x_offset.eq(block.x_offset),
                    x_stride_bits.eq(block.x_stride_bits),
                    to_double.eq(block.y_stride_bits),
                    y_stride.eq(1 << block.y_stride_bits),
                    upper_steps.eq(rows_to_lattice(triangle.top)),
                    lower_steps.eq(rows_to_lattice(triangle.middle)),
                    y.eq(triangle.top + rows_to_lattice(triangle.top)),
                ]
                with m.If(self.first == self.end):  # a domain without units
                    m.d.comb += self.triangles.ready.eq(1)
                with m.Elif(block.y_stride_bits == 0):
                    m.next = "WALK"
                with m.Else():
                    m.next = "STRIDE"
            with m.State("STRIDE"):
                m.d.comb += self.preparing.eq(1)
                m.d.comb += [edge.double.eq(1) for edge in edges.values()]
                m.d.comb += [
                    edges["long"].advance.eq(upper_steps[:1]),
                    edges["upper"].advance.eq(upper_steps[:1]),
                    edges["lower"].advance.eq(lower_steps[:1]),
                ]
                m.d.sync += [
                    upper_steps.eq(upper_steps >> 1),
                    lower_steps.eq(lower_steps >> 1),
                    to_double.eq(to_double - 1),
                ]
                with m.If(to_double == 1):
                    m.next = "WALK"
            with m.State("WALK"):
                empty = self._span(m, edges, y, x_offset, x_stride_bits)
                inside = y < triangle.bottom
                m.d.comb += [self.spans.valid.eq(inside & ~empty),
                             self.empty_row.eq(~inside | empty)]
                with m.If(~inside | empty | self.spans.ready):
                    in_upper = y < triangle.middle
                    m.d.comb += [
                        edges["long"].advance.eq(1),
                        edges["upper"].advance.eq(in_upper),
                        edges["lower"].advance.eq(~in_upper),
                    ]
                    m.d.sync += y.eq(y + y_stride)
                    with m.If(y + y_stride >= triangle.bottom):
                        last = after == self.end
                        m.d.comb += self.triangles.ready.eq(last)
                        m.d.sync += started.eq(~last)
                        m.next = "LOAD"
        return m

    def _span(self, m, edges, y, x_offset, x_stride_bits):
        """Drive the span of this row; whether it holds no lattice pixel."""
        triangle, span = self.triangles.payload, self.spans.payload
        column_shape = edges["long"].column.shape()
        short, left, right = (Signal(column_shape, name=name)
                              for name in ("short", "left", "right"))
        from_column = Signal(self.configuration.x_bits)
        to_column = Signal(self.configuration.x_bits)
        low, high = triangle.left, triangle.right
        m.d.comb += [
            short.eq(Mux(y < triangle.middle, edges["upper"].column, edges["lower"].column)),
            left.eq(Mux(triangle.long_edge_left, edges["long"].column, short)),
            right.eq(Mux(triangle.long_edge_left, short, edges["long"].column)),
            from_column.eq(Mux(left < low, low, Mux(left > high, high, left))),
            to_column.eq(Mux(right < low, low, Mux(right > high, high, right))),
        ]
        mask = Signal(self.configuration.x_bits)
        x = Signal(range(self.configuration.width + self.configuration.maximum_units))
        m.d.comb += [
            mask.eq((1 << x_stride_bits) - 1),
            x.eq(from_column + ((x_offset - from_column) & mask)),
            span.x.eq(x),
            span.y.eq(y),
            span.x_steps.eq(x - triangle.left),
            span.y_steps.eq(y - triangle.top),
            span.more.eq((to_column - 1 - x) >> x_stride_bits),
            span.x_stride_bits.eq(x_stride_bits),
            span.planes.eq(triangle.planes),
        ]
        return x >= to_column
