"""The part of a row that belongs to one processing element."""

from amaranth.hdl import *
from amaranth.lib import stream, wiring
from amaranth.lib.wiring import In, Out

from ...golden.specification.configuration import MachineConfiguration
from ..backplane.words import span_layout
from ..mapping.lattice import first_owned, row_offset
from .edge_columns import extent_layout

__all__ = ["SpanClip"]


class SpanClip(wiring.Component):
    """Extents in, the spans of the lattice's columns out.

    Interlaced pixel by pixel, an extent has one span of pixels a stride apart;
    interlaced in squares, a span of neighbouring pixels in each owned square that
    it crosses.  An extent without an owned pixel has none, and leaves no trace
    unless it is a triangle's last.

    No extent goes on for ever: ``beyond`` is at most the picture's width (``EdgeColumns``), a
    span goes on to another square only while the next one begins before it, that begins further
    right, and there are bits for the first column of a square that an element owns past the width.
    And every span is a whole number of strides of a column that is before its end, so its pixels
    end, too (``FragmentStepper``).

    Latency: one clock.  Throughput: a span a clock; an extent without span costs one.

    Members
    -------
    extents: In(stream of extent_layout)
    spans: Out(stream of span_layout)
    empty: Out(1)
        In this clock an extent without a span is taken.
    """

    latency = 1

    def __init__(self, *, configuration: MachineConfiguration):
        self.configuration = configuration
        super().__init__({
            "extents": In(stream.Signature(extent_layout(configuration))),
            "spans": Out(stream.Signature(span_layout(configuration))),
            "empty": Out(1),
        })

    def elaborate(self, platform):
        m = Module()
        configuration, square_bits = self.configuration, self.configuration.square_bits
        extent, span = self.extents.payload, self.spans.payload
        lattice = extent.lattice

        underway = Signal()  # a span of this extent has been sent
        past = (configuration.maximum_units + 1) << square_bits
        current = Signal(range(configuration.width + past))
        x = Signal(range(configuration.width + past))
        following = Signal(range(configuration.width + past))
        end = Signal(range(configuration.width + past))
        x_first = first_owned(extent.first, row_offset(lattice, extent.y, configuration),
                              lattice.x_mask, square_bits)
        m.d.comb += [x.eq(Mux(underway, current, x_first)), end.eq(extent.beyond)]
        if square_bits:
            square_end = ((x >> square_bits) + 1) << square_bits
            with m.If(lattice.x_mask == 0):  # every column is owned
                m.d.comb += following.eq(end)
            with m.Else():
                m.d.comb += following.eq(square_end + (lattice.x_mask << square_bits))
                with m.If(square_end < extent.beyond):
                    m.d.comb += end.eq(square_end)
            stride = 1
        else:
            m.d.comb += following.eq(end)
            stride = lattice.x_mask + 1

        move = Signal()
        empty = Signal()
        ended = Signal()
        m.d.comb += [
            move.eq(~self.spans.valid | self.spans.ready),
            empty.eq(extent.none | (x >= extent.beyond)),
            # Interlaced pixel by pixel, one span is all there is.
            ended.eq(empty | (following >= extent.beyond) if square_bits else 1),
            self.extents.ready.eq(move & ended),
            self.empty.eq(self.extents.valid & move & empty),
        ]
        with m.If(move):
            m.d.sync += [
                self.spans.valid.eq(self.extents.valid & (~empty | extent.last)),
                span.x.eq(x),
                span.y.eq(extent.y),
                span.end.eq(end),
                span.left.eq(extent.left),
                span.y_steps.eq(extent.rows),
                span.stride.eq(stride),
                span.none.eq(empty),
                span.last.eq(extent.last & ended),
            ]
            with m.If(self.extents.valid):
                m.d.sync += [underway.eq(~ended), current.eq(following)]
        return m
