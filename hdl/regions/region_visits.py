"""From the triangles that a processing element keeps to visits of its regions."""

from amaranth.hdl import *
from amaranth.lib import data, stream, wiring
from amaranth.lib.wiring import In, Out

from ...golden.specification.configuration import MachineConfiguration
from ..backplane.region_lines import RegionLines
from ..backplane.words import outline_layout, walked_outline_layout
from .large_visits import LargeVisits, visited_region_layout
from .region_box import band_rows, cut, region_box

__all__ = ["RegionVisits", "visit_layout"]


def visit_layout(configuration: MachineConfiguration) -> data.StructLayout:
    """A triangle in one region.

    ``outline``                the triangle
    ``region``                 as in ``visited_region_layout``
    ``first_row``, ``last_row``  the rows of its box there, both included
    """
    return data.StructLayout({
        "outline": outline_layout(configuration),
        "region": visited_region_layout(configuration),
        "first_row": configuration.y_bits,
        "last_row": configuration.y_bits,
    })


class RegionVisits(wiring.Component):
    """Goes from region to region of a triangle's box.

    Of a box of at most 2 × 2 regions each that is the processing element's own is visited, and
    those are known before.  Those of a larger one are found by ``LargeVisits``.

    Latency: none; for a large box that of ``LargeVisits``.  Throughput: a visit a clock, the next
    triangle's follow without a bubble.

    Members
    -------
    regions: In(RegionLines), element: In(element_bits)
        The tables, and the number that the processing element has in these.
    triangles: In(stream of walked_outline_layout)
        As the ``RegionFilter`` keeps them.  Each stays until its last visit is taken: it is held
        nowhere else.
    visits: Out(stream of visit_layout)
        Regions ascending; one at least for every triangle, which may be ``none``.
    """

    def __init__(self, *, configuration: MachineConfiguration):
        self.configuration = configuration
        super().__init__({
            "regions": In(RegionLines(configuration)),
            "element": In(configuration.element_bits),
            "triangles": In(stream.Signature(walked_outline_layout(configuration))),
            "visits": Out(stream.Signature(visit_layout(configuration))),
        })

    def elaborate(self, platform):
        m = Module()
        configuration, lines = self.configuration, self.regions
        triangle, visit = self.triangles.payload, self.visits.payload
        m.submodules.larger = large = LargeVisits(configuration=configuration)
        wiring.connect(m, wiring.flipped(lines), large.regions)

        visited = Signal(4)
        left, lower, right = Signal(4), Signal(), Signal()
        box = region_box(triangle, configuration)
        m.d.comb += [
            left.eq(triangle.own & ~visited),
            lower.eq(~left[:2].any()),
            right.eq(Mux(lower, ~left[2], ~left[0])),
        ]
        outline = Value.cast(triangle)[:outline_layout(configuration).size]
        m.d.comb += [
            large.element.eq(self.element),
            large.outline.eq(outline),
            large.start.eq(self.triangles.valid & triangle.large),
            large.visits.ready.eq(self.visits.ready),
            visit.outline.eq(outline),
        ]
        region, moves = visit.region, self.visits.valid & self.visits.ready
        with m.If(triangle.large):
            m.d.comb += [self.visits.valid.eq(large.visits.valid), region.eq(large.visits.payload)]
        with m.Else():
            m.d.comb += [
                self.visits.valid.eq(self.triangles.valid),
                region.column.eq(cut(box.left + right, len(lines.column))),
                region.row.eq(cut(box.top + lower, len(lines.row))),
                region.last.eq((left & (left - 1))[:4] == 0),
            ]
            with m.If(moves):
                m.d.sync += visited.eq(Mux(region.last, 0, visited | (left & ~(left - 1))))
        bottom = (triangle.bottom - 1)[:configuration.y_bits]
        first, last = band_rows(region.row, triangle.top, bottom, configuration)
        m.d.comb += [
            visit.first_row.eq(first),
            visit.last_row.eq(last),
            self.triangles.ready.eq(moves & region.last),
        ]
        return m
