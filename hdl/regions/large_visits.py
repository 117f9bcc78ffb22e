"""The regions that a triangle of a large box visits."""

from amaranth.hdl import *
from amaranth.lib import data, stream, wiring
from amaranth.lib.wiring import In, Out

from ...golden.specification.configuration import MachineConfiguration
from ..backplane.region_lines import RegionLines
from ..backplane.words import outline_layout
from ..rasteriser.edge_columns import EdgeColumns
from .band_probes import BandProbes
from .band_scan import BandScan, region_layout

__all__ = ["LargeVisits", "visited_region_layout"]


def visited_region_layout(configuration: MachineConfiguration) -> data.StructLayout:
    """A region that a triangle visits.

    ``none``  none at all: the triangle visits no more
    ``last``  the triangle visits no other after it
    """
    return data.StructLayout({**region_layout(configuration).members, "none": 1, "last": 1})


class LargeVisits(wiring.Component):
    """Finds them band by band, while others are walked.

    ::

        outline ─▶ BandProbes ─▶ EdgeColumns ─▶ BandScan ─▶ visits

    A band is what of the box lies in one row of regions.  A region is visited if its columns meet
    those from the least first column to the greatest last one that the triangle has in any of the
    band's rows, empty rows as well: so one may be visited in vain, but none that is beside the
    triangle.

    Latency: ``latency`` clocks from ``start`` to the first region, where this is the leftmost one
    of a band of two probes.  A region is known to be a visit when it is known whether another one
    follows.  Throughput: a region a clock, and as ``BandProbes``.  One triangle at a time.

    Members
    -------
    regions: In(RegionLines), element: In(element_bits)
        The tables, and the number that the processing element has in these.
    outline: In(outline_layout)
        ``top`` above ``bottom``, ``left`` left of ``right``; the rest may be anything.
    start: In(1)
        There is a triangle; both hold until its last visit is taken, and the next may follow at
        once.
    visits: Out(stream of visited_region_layout)
        Ascending.  Where there are no regions, one that is ``none``.
    """

    latency = BandProbes.latency + 1 + EdgeColumns.latency + BandScan.latency + 1

    def __init__(self, *, configuration: MachineConfiguration):
        self.configuration = configuration
        super().__init__({
            "regions": In(RegionLines(configuration)),
            "element": In(configuration.element_bits),
            "outline": In(outline_layout(configuration)),
            "start": In(1),
            "visits": Out(stream.Signature(visited_region_layout(configuration))),
        })

    def elaborate(self, platform):
        m = Module()
        m.submodules.probes = probes = BandProbes(configuration=self.configuration)
        m.submodules.columns = columns = EdgeColumns(configuration=self.configuration)
        m.submodules.scan = scan = BandScan(configuration=self.configuration)
        for part in (probes, scan):
            wiring.connect(m, wiring.flipped(self.regions), part.regions)
            m.d.comb += part.element.eq(self.element)
        wiring.connect(m, probes.rows, columns.rows)
        wiring.connect(m, columns.extents, scan.extents)

        # What is found waits until another one is found, or none can be any more.
        begun = Signal()
        waits = Signal()
        waiting = Signal(region_layout(self.configuration), reset_less=True)
        visit, taken = self.visits.payload, Signal()
        m.d.comb += [
            probes.outline.eq(self.outline),
            probes.begin.eq(self.start & ~begun),
            visit.column.eq(waiting.column),
            visit.row.eq(waiting.row),
            visit.none.eq(~waits),
            visit.last.eq(begun & ~(probes.busy | columns.busy | scan.busy)),
            self.visits.valid.eq(visit.last | (waits & scan.found.valid)),
            taken.eq(self.visits.valid & self.visits.ready),
            scan.found.ready.eq(~waits | self.visits.ready),
        ]
        with m.If(scan.found.valid & scan.found.ready):
            m.d.sync += [waits.eq(1), waiting.eq(scan.found.payload)]
        with m.Elif(taken):
            m.d.sync += waits.eq(0)
        with m.If(self.start):
            m.d.sync += begun.eq(~(taken & visit.last))
        return m
