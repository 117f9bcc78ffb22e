"""Finds the spans of a triangle in the regions that one processing element owns."""

from amaranth.hdl import *
from amaranth.lib import stream, wiring
from amaranth.lib.wiring import In, Out

from ...golden.specification.configuration import MachineConfiguration
from ..backplane.region_lines import RegionLines
from ..backplane.words import span_layout, walked_outline_layout
from ..rasteriser.edge_columns import EdgeColumns
from .region_clip import RegionClip, visited_row_layout
from .region_rows import RegionRows
from .region_visits import RegionVisits

__all__ = ["RegionSpans"]


class RegionSpans(wiring.Component):
    """Outlines of triangles in, the spans of its regions out; in the place of ``TriangleSpans``.

    ::

        triangles ─▶ RegionVisits ─▶ RegionRows ─▶ EdgeColumns ─▶ RegionClip ─▶ spans

    A visit goes over all rows that the triangle's box has in the region, those without a pixel
    as well.

    Latency: ``latency`` clocks to the first row's span, of a large box that of ``LargeVisits``
    more.  Throughput: a row a clock, the next visit and the next triangle without a bubble; the
    visits of a large box are found while earlier ones are walked.

    Members
    -------
    regions: In(RegionLines), element: In(element_bits)
        The tables, and the number that the processing element has in these.
    triangles: In(stream of walked_outline_layout)
        As the ``RegionFilter`` keeps them.
    spans: Out(stream of span_layout)
        Regions ascending, rows downwards.  Each triangle ends with its ``last``, which may be
        ``none``; otherwise no span is empty.
    row: Out(visited_row_layout)
        The row that is cut in this clock.
    busy: Out(1)
        Holds a row or a span.
    preparing: Out(1)
        In this clock it has a triangle, but no region of it that could be walked.
    empty_row: Out(1)
        In this clock a row without a span is taken.
    """

    latency = RegionRows.latency + EdgeColumns.latency + RegionClip.latency

    def __init__(self, *, configuration: MachineConfiguration):
        self.configuration = configuration
        super().__init__({
            "regions": In(RegionLines(configuration)),
            "element": In(configuration.element_bits),
            "triangles": In(stream.Signature(walked_outline_layout(configuration))),
            "spans": Out(stream.Signature(span_layout(configuration))),
            "row": Out(visited_row_layout(configuration)),
            "busy": Out(1),
            "preparing": Out(1),
            "empty_row": Out(1),
        })

    def elaborate(self, platform):
        m = Module()
        m.submodules.visits = visits = RegionVisits(configuration=self.configuration)
        m.submodules.rows = rows = RegionRows(configuration=self.configuration)
        m.submodules.columns = columns = EdgeColumns(configuration=self.configuration)
        m.submodules.clip = clip = RegionClip(configuration=self.configuration)
        wiring.connect(m, wiring.flipped(self.regions), visits.regions, rows.regions)
        wiring.connect(m, wiring.flipped(self.triangles), visits.triangles)
        wiring.connect(m, visits.visits, rows.visits)
        wiring.connect(m, rows.rows, columns.rows)
        wiring.connect(m, columns.extents, clip.extents)
        wiring.connect(m, clip.spans, wiring.flipped(self.spans))
        m.d.comb += [
            visits.element.eq(self.element),
            self.row.eq(clip.row),
            self.busy.eq(rows.busy | columns.busy | clip.spans.valid),
            self.preparing.eq(self.triangles.valid & ~visits.visits.valid & ~rows.busy),
            self.empty_row.eq(clip.empty),
        ]
        return m
