"""Between which columns a processing element has regions, in each row of them."""

from amaranth.hdl import *
from amaranth.lib import memory, wiring
from amaranth.lib.wiring import In, Out

from ...golden.specification.configuration import MachineConfiguration
from ..backplane.region_lines import RegionLines

__all__ = ["OwnColumns"]


class OwnColumns(wiring.Component):
    """The first and the last of its regions in each row of regions of both tables.

    As a table comes row by row, both are kept in registers while a row comes.

    Latency: ``latency`` clock.

    Members
    -------
    regions: In(RegionLines), element: In(element_bits)
        The tables, and the number that it has in these.
    ask: In(1), row: In(row_bits)
        Read that row of the table in use.
    some: Out(1)
        From the next clock until the one after the next ``ask``: it has a region in that row.
    first: Out(column_bits), last: Out(column_bits)
        As long, the columns of its first one and of its last one.
    """

    latency = 1

    def __init__(self, *, configuration: MachineConfiguration):
        self.configuration = configuration
        regions = configuration.dealt_regions
        super().__init__({
            "regions": In(RegionLines(configuration)),
            "element": In(configuration.element_bits),
            "ask": In(1),
            "row": In(regions.row_bits),
            "some": Out(1),
            "first": Out(regions.column_bits),
            "last": Out(regions.column_bits),
        })

    def elaborate(self, platform):
        m = Module()
        lines = self.regions
        bits = len(lines.column)
        m.submodules.rows = ram = memory.Memory(
            shape=1 + 2 * bits, depth=2 << len(lines.row), init=[], attrs={"no_rw_check": 1})
        write, read = ram.write_port(), ram.read_port()

        # Of the row so far.
        some, first, last = Signal(), Signal(bits), Signal(bits)
        found, own = Signal(), Signal()
        m.d.comb += [
            found.eq(some & (lines.column != 0)),
            own.eq(lines.element == self.element),
            write.en.eq(lines.valid),
            write.addr.eq(Cat(lines.row, lines.bank)),
            write.data.eq(Cat(found | own, Mux(found, first, lines.column),
                              Mux(own, lines.column, last))),
            read.en.eq(self.ask),
            read.addr.eq(Cat(self.row, lines.table)),
            Cat(self.some, self.first, self.last).eq(read.data),
        ]
        with m.If(lines.valid):
            m.d.sync += Cat(some, first, last).eq(write.data)
        return m
