"""The rows of a triangle in each region that it visits, one a clock."""

from amaranth.hdl import *
from amaranth.lib import memory, stream, wiring
from amaranth.lib.wiring import In, Out

from ...golden.specification.configuration import MachineConfiguration
from ..backplane.region_lines import RegionLines
from ..rasteriser.triangle_rows import row_layout
from .region_visits import visit_layout

__all__ = ["RegionRows"]


class RegionRows(wiring.Component):
    """Visits in, their rows out, and the slot of the region with each.

    Whatever the visit, its rows end: they go down from one that is not below the last one.

    Latency: ``latency`` clocks.  Throughput: a row a clock, the next visit without a bubble; one
    of no region takes a row's clock.

    Members
    -------
    regions: In(RegionLines)
        The tables, of which it keeps the slots.
    visits: In(stream of visit_layout)
        ``first_row`` not below ``last_row``, both in the picture.
    rows: Out(stream of row_layout)
    busy: Out(1)
        Holds a visit or a row.

    In the place of ``TriangleRows``, as Fuchs & Johnson, figure 13.
    """

    latency = 2

    def __init__(self, *, configuration: MachineConfiguration):
        self.configuration = configuration
        super().__init__({
            "regions": In(RegionLines(configuration)),
            "visits": In(stream.Signature(visit_layout(configuration))),
            "rows": Out(stream.Signature(row_layout(configuration))),
            "busy": Out(1),
        })

    def elaborate(self, platform):
        m = Module()
        visit = Signal(visit_layout(self.configuration), reset_less=True)
        holding = Signal()
        y = Signal(self.configuration.y_bits, reset_less=True)
        move, finishes, load = Signal(), Signal(), Signal()
        m.d.comb += [
            move.eq(~self.rows.valid | self.rows.ready),
            finishes.eq(visit.region.none | (y == visit.last_row)),
            self.visits.ready.eq(~holding | (move & finishes)),
            load.eq(self.visits.valid & self.visits.ready),
            self.busy.eq(holding | self.rows.valid),
        ]
        slot = self._slot(m, load) if self.configuration.table_bits else 0

        row, outline = self.rows.payload, visit.outline
        in_upper = y < outline.middle
        with m.If(move):
            m.d.sync += [
                self.rows.valid.eq(holding),
                row.y.eq(y),
                row.rows.eq(y - outline.top),
                row.short_rows.eq(y - Mux(in_upper, outline.top, outline.middle)),
                row.long_edge_left.eq(outline.long_edge_left),
                row.long.eq(outline.long),
                row.short.eq(Mux(in_upper, outline.upper, outline.lower)),
                row.left.eq(outline.left),
                row.region.column.eq(visit.region.column),
                row.region.slot.eq(slot),
                row.region.ends.eq(finishes),
                row.none.eq(visit.region.none),
                row.last.eq(visit.region.last & finishes),
                y.eq(y + 1),
            ]
            with m.If(finishes):
                m.d.sync += holding.eq(0)
        with m.If(load):
            coming = self.visits.payload
            m.d.sync += [holding.eq(1), visit.eq(coming), y.eq(coming.first_row)]
        return m

    def _slot(self, m, load):
        """Of the visit that was loaded last, from the clock after that on."""
        lines, coming = self.regions, self.visits.payload.region
        m.submodules.slots = ram = memory.Memory(
            shape=len(lines.slot), depth=2 << self.configuration.dealt_regions.index_bits,
            init=[], attrs={"no_rw_check": 1})
        write, read = ram.write_port(), ram.read_port()
        m.d.comb += [
            write.en.eq(lines.valid),
            write.addr.eq(Cat(lines.column, lines.row, lines.bank)),
            # Those of other elements' regions are written as well, and never read.
            write.data.eq(lines.slot),
            read.en.eq(load),
            read.addr.eq(Cat(coming.column, coming.row, lines.table)),
        ]
        return read.data
