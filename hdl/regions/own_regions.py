"""Which regions are a processing element's own: a bit for each."""

from amaranth.hdl import *
from amaranth.lib import memory, wiring
from amaranth.lib.wiring import In, Out

from ...golden.specification.configuration import MachineConfiguration
from ..backplane.region_lines import RegionLines
from .region_box import cut

__all__ = ["OwnRegions"]


class OwnRegions(wiring.Component):
    """A bit for every region of both tables, 2 × 2 of them read at once.

    Regions whose columns and rows are even or odd alike are in one RAM, so that of any 2 × 2
    neighbours each is in another one.

    Latency: ``latency`` clock.  Throughput: a place a clock, while the other table is written.

    Members
    -------
    regions: In(RegionLines), element: In(element_bits)
        The tables, and the number that it has in these.
    column: In(column_bits), row: In(row_bits)
        The upper left one of the regions, at any place.
    asked: In(4)
        Row by row, which of the regions are asked for.
    own: Out(4)
        In the next clock, of each: it is asked for and its own, by the table in use.  Right of the
        last column and below the last row bits may be anything.
    some: Out(1)
        As early, one of them is; sooner known than which.

    Ellsworth 1994: the processors that a primitive is sent to, here asked by each of itself.
    """

    latency = 1

    def __init__(self, *, configuration: MachineConfiguration):
        self.configuration = configuration
        regions = configuration.dealt_regions
        super().__init__({
            "regions": In(RegionLines(configuration)),
            "element": In(configuration.element_bits),
            "column": In(regions.column_bits),
            "row": In(regions.row_bits),
            "asked": In(4),
            "own": Out(4),
            "some": Out(1),
        })

    def elaborate(self, platform):
        m = Module()
        lines = self.regions
        odd_column, odd_row = Signal(), Signal()
        m.d.sync += [odd_column.eq(_odd(self.column)), odd_row.eq(_odd(self.row))]
        bits = {(row, column): self._bank(m, row, column)
                for row in range(min(2, 1 << len(lines.row)))
                for column in range(min(2, 1 << len(lines.column)))}

        def at(row, column):
            """That of the RAM for even or odd rows and columns, if there can be any."""
            return bits.get((row, column), C(0))

        own = []
        for down in range(2):
            for right in range(2):
                even, odd = (Mux(odd_column ^ right, at(row, 1), at(row, 0)) for row in range(2))
                own.append(Mux(odd_row ^ down, odd, even))
        m.d.comb += [self.own.eq(Cat(own)), self.some.eq(Cat(bits.values()).any())]
        return m

    def _bank(self, m, row, column):
        """The RAM of rows and columns that are even (0) or odd (1); returns what is read, where its
        region is asked for."""
        lines = self.regions
        half = [max(0, len(place) - 1) for place in (lines.column, lines.row)]
        ram = memory.Memory(shape=1, depth=2 << sum(half), init=[], attrs={"no_rw_check": 1})
        m.submodules[f"own_{row}_{column}"] = ram
        write, read = ram.write_port(), ram.read_port()
        mine = ((_odd(lines.column) == column) & (_odd(lines.row) == row))
        m.d.comb += [
            write.en.eq(lines.valid & mine),
            write.addr.eq(Cat(lines.column[1:], lines.row[1:], lines.bank)),
            write.data.eq(lines.element == self.element),
            # From an odd place the next even one is half of the place after it.
            read.addr.eq(Cat(
                cut((self.column + (1 - column))[1:], half[0]),
                cut((self.row + (1 - row))[1:], half[1]), lines.table)),
        ]
        # The RAM's region is below or right of the place where they are not both even or both odd.
        asked = Signal(name=f"asked_{row}_{column}")
        right, down = _odd(self.column) ^ column, _odd(self.row) ^ row
        upper, lower = (Mux(right[0], self.asked[place + 1], self.asked[place])
                        for place in (0, 2))
        m.d.sync += asked.eq(Mux(down[0], lower, upper))
        return read.data & asked


def _odd(place: Value) -> Value:
    return place[0] if len(place) else C(0, 1)
