"""The regions of its own that a processing element finds in each band of a large triangle."""

from amaranth.hdl import *
from amaranth.lib import data, memory, stream, wiring
from amaranth.lib.wiring import In, Out

from ...golden.specification.configuration import MachineConfiguration
from ..backplane.region_lines import RegionLines
from ..rasteriser.edge_columns import extent_layout

__all__ = ["BandScan", "region_layout"]


def region_layout(configuration: MachineConfiguration) -> data.StructLayout:
    """A region, by its column and row."""
    regions = configuration.dealt_regions
    return data.StructLayout({"column": regions.column_bits, "row": regions.row_bits})


class BandScan(wiring.Component):
    """Extents of the rows that ``BandProbes`` sends in; its own regions out, in ascending order,
    that lie between the least first column of a band and the greatest last one.

    Latency: ``latency`` clocks from a band's last extent to its first region, if that is its own.
    Throughput: a region a clock, of other elements' too; a band follows without a bubble, and its
    extents come meanwhile, all but the last one.

    Members
    -------
    regions: In(RegionLines), element: In(element_bits)
        The tables, and the number that the processing element has in these.
    extents: In(stream of extent_layout)
    found: Out(stream of region_layout)
    busy: Out(1)
        A region may still come of what it holds.
    """

    latency = 2

    def __init__(self, *, configuration: MachineConfiguration):
        self.configuration = configuration
        super().__init__({
            "regions": In(RegionLines(configuration)),
            "element": In(configuration.element_bits),
            "extents": In(stream.Signature(extent_layout(configuration))),
            "found": Out(stream.Signature(region_layout(configuration))),
            "busy": Out(1),
        })

    def elaborate(self, platform):
        m = Module()
        configuration, lines, extent = self.configuration, self.regions, self.extents.payload
        regions = configuration.dealt_regions
        m.submodules.own = ram = memory.Memory(shape=1, depth=2 << regions.index_bits, init=[],
                                               attrs={"no_rw_check": 1})
        write, read = ram.write_port(), ram.read_port()
        m.d.comb += [
            write.en.eq(lines.valid),
            write.addr.eq(Cat(lines.column, lines.row, lines.bank)),
            write.data.eq(lines.element == self.element),
        ]

        # The extents of a band, so far and with the one that comes.
        further = Signal()
        least_so_far, most_so_far = (Signal(configuration.x_bits, name=name, reset_less=True)
                                     for name in ("least_so_far", "most_so_far"))
        least, most = (Signal(configuration.x_bits, name=name) for name in ("least", "most"))
        m.d.comb += [
            least.eq(Mux(further & (least_so_far < extent.first), least_so_far, extent.first)),
            most.eq(Mux(further & (most_so_far > extent.beyond), most_so_far, extent.beyond)),
        ]

        # The region whose bit is read, and the last one of its band; the one that was read.
        scanning, asked = Signal(), Signal()
        place = Signal(region_layout(configuration), reset_less=True)
        last_column = Signal(regions.column_bits, reset_less=True)
        candidate = Signal(region_layout(configuration), reset_less=True)
        at_end, moves, passes = Signal(), Signal(), Signal()
        m.d.comb += [
            at_end.eq(place.column == last_column),
            passes.eq(~asked | ~read.data | self.found.ready),
            moves.eq(scanning & passes),
            read.en.eq(moves),
            read.addr.eq(Cat(place.column, place.row, lines.table)),
            self.found.valid.eq(asked & read.data),
            self.found.payload.eq(candidate),
            self.extents.ready.eq(~extent.last | ~scanning | (moves & at_end)),
            self.busy.eq(scanning | asked),
        ]
        with m.If(passes):
            m.d.sync += [asked.eq(scanning), candidate.eq(place)]
        with m.If(moves):
            m.d.sync += [place.column.eq(place.column + 1), scanning.eq(~at_end)]
        with m.If(self.extents.valid & self.extents.ready):
            m.d.sync += [further.eq(~extent.last), least_so_far.eq(least), most_so_far.eq(most)]
            with m.If(extent.last & (least < most)):
                m.d.sync += [
                    scanning.eq(1),
                    place.column.eq(least[regions.x_bits:]),
                    place.row.eq(extent.y[regions.y_bits:]),
                    last_column.eq((most - 1)[regions.x_bits:configuration.x_bits]),
                ]
        return m
