"""The part of a row that lies in the region where it is walked."""

from amaranth.hdl import *
from amaranth.lib import data, stream, wiring
from amaranth.lib.wiring import In, Out

from ...golden.specification.configuration import MachineConfiguration
from ..backplane.words import span_layout
from ..rasteriser.edge_columns import extent_layout

__all__ = ["RegionClip", "visited_row_layout"]


def visited_row_layout(configuration: MachineConfiguration) -> data.StructLayout:
    """What is counted of a row.

    ``valid``   in this clock there is one
    ``pixels``  how many it has in the region
    ``ends``    it is the last one of a visit
    ``slot``    where the region lies
    """
    return data.StructLayout({
        "valid": 1,
        "pixels": range((1 << configuration.dealt_regions.x_bits) + 1),
        "ends": 1,
        "slot": configuration.table_bits,
    })


class RegionClip(wiring.Component):
    """Extents in, their spans out, cut to the columns of a region; all its pixels are the
    processing element's.

    An extent without a pixel there has none, and leaves no trace unless it is a triangle's last.
    No span leaves the picture, whatever the extent: ``beyond`` is at most its width.

    Latency: one clock.  Throughput: an extent a clock.

    Members
    -------
    extents: In(stream of extent_layout)
    spans: Out(stream of span_layout)
    empty: Out(1)
        In this clock an extent without a span is taken.
    row: Out(visited_row_layout)
        The extent that is taken in this clock, if its row is one of a region.

    In the place of ``SpanClip``.
    """

    latency = 1

    def __init__(self, *, configuration: MachineConfiguration):
        self.configuration = configuration
        super().__init__({
            "extents": In(stream.Signature(extent_layout(configuration))),
            "spans": Out(stream.Signature(span_layout(configuration))),
            "empty": Out(1),
            "row": Out(visited_row_layout(configuration)),
        })

    def elaborate(self, platform):
        m = Module()
        configuration = self.configuration
        extent, span = self.extents.payload, self.spans.payload
        inside = configuration.dealt_regions.x_bits
        region = extent.region

        # The region's first column, and that right of its last one.
        begin = Signal(configuration.x_bits + 1)
        end = Signal(configuration.x_bits + 1)
        x, beyond = Signal(configuration.x_bits), Signal(configuration.x_bits)
        move, empty = Signal(), Signal()
        m.d.comb += [
            begin.eq(region.column << inside),
            end.eq((region.column + 1) << inside),
            x.eq(Mux(extent.first[inside:] < region.column, begin, extent.first)),
            beyond.eq(Mux(extent.beyond[inside:] > region.column, end, extent.beyond)),
            # What is cut is not waited for.
            empty.eq(extent.none | (extent.first >= extent.beyond) | (extent.beyond <= begin)
                     | (extent.first[inside:] > region.column)),
            move.eq(~self.spans.valid | self.spans.ready),
            self.extents.ready.eq(move),
            self.empty.eq(self.extents.valid & move & empty),
            self.row.valid.eq(self.extents.valid & move & ~extent.none),
            self.row.pixels.eq(Mux(empty, 0, beyond - x)),
            self.row.ends.eq(region.ends),
            self.row.slot.eq(region.slot),
        ]
        with m.If(move):
            m.d.sync += [
                self.spans.valid.eq(self.extents.valid & (~empty | extent.last)),
                span.x.eq(x),
                span.y.eq(extent.y),
                span.end.eq(beyond),
                span.left.eq(extent.left),
                span.y_steps.eq(extent.rows),
                span.slot.eq(region.slot),
                span.none.eq(empty),
                span.last.eq(extent.last),
            ]
        return m
