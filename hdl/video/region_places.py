"""Where each region of the screen lies."""

from amaranth.hdl import *
from amaranth.lib import memory, wiring
from amaranth.lib.wiring import In, Out

from ...golden.specification.configuration import MachineConfiguration
from ..backplane.connectors import region_place_layout
from ..backplane.region_lines import RegionLines

__all__ = ["RegionPlaces"]


class RegionPlaces(wiring.Component):
    """Keeps the table in use and one that is being filled, by column and row of a region side by
    side, and looks pixels up.

    Latency: ``latency`` clocks.  Throughput: a pixel a clock.

    Members
    -------
    regions: In(RegionLines)
    x, y: In
        A pixel of the picture.
    place: Out(region_place_layout)
        Where its region lies by the table in use; of a pixel off the picture it may be anything.

    Ellsworth 1994; the scan generator's place for it is ours.
    """

    latency = 1

    def __init__(self, *, configuration: MachineConfiguration):
        self.configuration = configuration
        super().__init__({
            "regions": In(RegionLines(configuration)),
            "x": In(configuration.x_bits),
            "y": In(configuration.y_bits),
            "place": Out(region_place_layout(configuration)),
        })

    def elaborate(self, platform):
        m = Module()
        lines, regions = self.regions, self.configuration.dealt_regions
        m.submodules.tables = tables = memory.Memory(
            shape=region_place_layout(self.configuration), depth=2 << regions.index_bits, init=[],
            attrs={"no_rw_check": 1})
        write, read = tables.write_port(), tables.read_port()
        m.d.comb += [
            write.en.eq(lines.valid),
            write.addr.eq(Cat(lines.column, lines.row, lines.bank)),
            write.data.element.eq(lines.element),
            write.data.slot.eq(lines.slot),
            read.addr.eq(Cat((self.x >> regions.x_bits)[:regions.column_bits],
                             (self.y >> regions.y_bits)[:regions.row_bits], lines.table)),
            self.place.eq(read.data),
        ]
        return m
