"""Finds the spans of a triangle on the lattice of pixels that one processing element owns."""

from amaranth.hdl import *
from amaranth.lib import stream, wiring
from amaranth.lib.wiring import In, Out

from ..golden.configuration import MachineConfiguration
from .edge_columns import EdgeColumns
from .lattice import lattice_layout
from .layouts import walked_outline_layout, span_layout
from .row_walker import RowWalker
from .span_clip import SpanClip

__all__ = ["SpanWalker"]


class SpanWalker(wiring.Component):
    """Outlines of triangles in, the spans of this domain out; nothing is searched for.

    ::

        triangles ─▶ RowWalker ─▶ EdgeColumns ─▶ SpanClip ─▶ spans

    Latency: ``latency`` clocks to the first row's span.  Throughput: a row or a
    span a clock, the next triangle without a bubble.

    Members
    -------
    total, first, end: In(id_bits)
        Number of units; this domain, ``end`` excluded.  Static while triangles come.
    width: In(x_bits)
        Columns of the picture, at the machine's resolution.
    triangles: In(stream of walked_outline_layout)
    spans: Out(stream of span_layout)
<<<<<<< HEAD
        Rows downwards, blocks in order; no empty spans.
    preparing, empty_row: Out(1)
        In this clock it loads or takes up the lattice; it passes a row without a span.

    Fuchs & Johnson, figure 13 and the text around it: the regular pattern that
    allows rapid incremental computation.
=======
        Rows downwards, blocks in order.  Each triangle ends with its ``last``, which may be
        ``none``; otherwise no span is empty.
    lattice: Out(lattice_layout), whole: Out(1)
        As of ``RowWalker``.
    busy: Out(1)
        Holds a row or a span.
    preparing: Out(1)
        In this clock it takes up another block of its domain.
    empty_row: Out(1)
        In this clock a row without a span is taken.
>>>>>>> 16eee3a (Rows by multiplication: spans found a row a clock, triangles without a bubble; what misses a processing element costs nothing)
    """

    latency = RowWalker.latency + EdgeColumns.latency + SpanClip.latency

    def __init__(self, *, configuration: MachineConfiguration):
        self.configuration = configuration
        super().__init__({
            "total": In(configuration.id_bits),
            "first": In(configuration.id_bits),
            "end": In(configuration.id_bits),
            "width": In(configuration.x_bits),
            "triangles": In(stream.Signature(walked_outline_layout(configuration))),
            "spans": Out(stream.Signature(span_layout(configuration))),
<<<<<<< HEAD
            "preparing": Out(1),
=======
            "lattice": Out(lattice_layout(configuration)),
            "whole": Out(1),
            "busy": Out(1),
>>>>>>> 16eee3a (Rows by multiplication: spans found a row a clock, triangles without a bubble; what misses a processing element costs nothing)
            "preparing": Out(1),
            "empty_row": Out(1),
        })

    def elaborate(self, platform):
        m = Module()
        m.submodules.rows = rows = RowWalker(configuration=self.configuration)
        m.submodules.columns = columns = EdgeColumns(configuration=self.configuration)
        m.submodules.clip = clip = SpanClip(configuration=self.configuration)
        wiring.connect(m, wiring.flipped(self.triangles), rows.triangles)
        wiring.connect(m, rows.rows, columns.rows)
        wiring.connect(m, columns.extents, clip.extents)
        wiring.connect(m, clip.spans, wiring.flipped(self.spans))
        m.d.comb += [
            rows.total.eq(self.total),
            rows.first.eq(self.first),
            rows.end.eq(self.end),
            columns.width.eq(self.width),
            self.lattice.eq(rows.lattice),
            self.whole.eq(rows.whole),
            self.busy.eq(rows.busy | columns.busy | clip.spans.valid),
            self.preparing.eq(rows.preparing),
            self.empty_row.eq(clip.empty),
        ]
<<<<<<< HEAD

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
=======
>>>>>>> 16eee3a (Rows by multiplication: spans found a row a clock, triangles without a bubble; what misses a processing element costs nothing)
        return m
