"""Finds the spans of a triangle on the lattice of pixels that one processing element owns."""

from amaranth.hdl import *
from amaranth.lib import stream, wiring
from amaranth.lib.wiring import In, Out

from ...golden.specification.configuration import MachineConfiguration
from ..backplane.words import span_layout, walked_outline_layout
from ..mapping.lattice import lattice_layout
from .edge_columns import EdgeColumns
from .span_clip import SpanClip
from .triangle_rows import TriangleRows

__all__ = ["TriangleSpans"]


class TriangleSpans(wiring.Component):
    """Outlines of triangles in, the spans of this domain out; nothing is searched for.

    ::

        triangles ─▶ TriangleRows ─▶ EdgeColumns ─▶ SpanClip ─▶ spans

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
        Rows downwards, blocks in order.  Each triangle ends with its ``last``, which may be
        ``none``; otherwise no span is empty.
    lattice: Out(lattice_layout), whole: Out(1)
        As of ``TriangleRows``.
    busy: Out(1)
        Holds a row or a span.
    preparing: Out(1)
        In this clock it takes up another block of its domain.
    empty_row: Out(1)
        In this clock a row without a span is taken.

    Fuchs & Johnson, figure 13 and the text around it: the regular pattern that
    allows rapid incremental computation.
    """

    latency = TriangleRows.latency + EdgeColumns.latency + SpanClip.latency

    def __init__(self, *, configuration: MachineConfiguration):
        self.configuration = configuration
        super().__init__({
            "total": In(configuration.id_bits),
            "first": In(configuration.id_bits),
            "end": In(configuration.id_bits),
            "width": In(configuration.x_bits),
            "triangles": In(stream.Signature(walked_outline_layout(configuration))),
            "spans": Out(stream.Signature(span_layout(configuration))),
            "lattice": Out(lattice_layout(configuration)),
            "whole": Out(1),
            "busy": Out(1),
            "preparing": Out(1),
            "empty_row": Out(1),
        })

    def elaborate(self, platform):
        m = Module()
        m.submodules.rows = rows = TriangleRows(configuration=self.configuration)
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
        return m
