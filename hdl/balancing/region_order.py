"""Counts that come slot by slot, put in the order of the regions."""

from amaranth.hdl import *
from amaranth.lib import data, memory, stream, wiring
from amaranth.lib.wiring import In, Out

__all__ = ["RegionOrder", "region_shape"]


def region_shape(*, columns: int, rows: int) -> data.StructLayout:
    """A region.  As numbers they are in order, row by row, with gaps where ``columns`` is no power
    of two.

    column: range(columns), row: range(rows)
    """
    return data.StructLayout({"column": range(columns), "row": range(rows)})


class RegionOrder(wiring.Component):
    """Takes a count for each slot of each processing element, from left to right, and gives the
    count of each region, row by row.

    The counts are kept by element and slot, side by side as an address; then the table says of
    each region where its count lies.

    Latency: ``latency`` clocks from the last count to that of the first region.  Throughput: a
    count a clock, and then a region a clock.

    Parameters
    ----------
    columns, rows, elements, slots, count_bits: int, positive
        Of elements the most there are.

    Members
    -------
    start: In(1)
        Counts come from the next clock on; only before the first time, or after the last region.
    elements: In(range(elements + 1))
        How many there are, from 1; static from ``start`` to the last region.
    counts: In(stream of count_bits)
        ``slots`` of each element; of slots without a region any number.
    asks: Out(1), region: Out(region_shape)
        Where does it lie?
    element: In(range(elements + 1)), slot: In(range(slots))
        There; a clock later.
    put: Out(1), item: Out((weight, label))
        In this clock a region's count, and its name, are given.

    Raises ``ValueError`` for a number that is not positive.
    """

    latency = 3

    def __init__(self, *, columns: int, rows: int, elements: int, slots: int, count_bits: int):
        for name, value in (("columns", columns), ("rows", rows), ("elements", elements),
                            ("slots", slots), ("count_bits", count_bits)):
            if value < 1:
                raise ValueError(f"{name} must be positive, not {value!r}")
        self.columns = columns
        self.rows = rows
        self.slots = slots
        self._most = elements
        self._count_bits = count_bits
        region = region_shape(columns=columns, rows=rows)
        super().__init__({
            "start": In(1),
            "elements": In(range(elements + 1)),
            "counts": In(stream.Signature(count_bits)),
            "asks": Out(1),
            "region": Out(region),
            "element": In(range(elements + 1)),
            "slot": In(range(slots)),
            "put": Out(1),
            "item": Out(data.StructLayout({"weight": count_bits, "label": region})),
        })

    def elaborate(self, platform):
        m = Module()
        place = data.StructLayout({"slot": range(self.slots), "element": range(self._most)})
        m.submodules.storage = storage = memory.Memory(
            shape=self._count_bits, depth=1 << place.size, init=[], attrs={"no_rw_check": 1})
        write, read = storage.write_port(), storage.read_port()

        came = Signal(place)
        answered, answered_region = Signal(), Signal.like(self.region)
        m.d.comb += [
            write.addr.eq(came),
            write.data.eq(self.counts.payload),
            write.en.eq(self.counts.valid & self.counts.ready),
            read.addr.eq(Cat(self.slot, self.element[:place["element"].width])),
            self.item.weight.eq(read.data),
        ]
        m.d.sync += [
            answered.eq(self.asks),
            answered_region.eq(self.region),
            self.put.eq(answered),
            self.item.label.eq(answered_region),
        ]
        with m.FSM():
            with m.State("IDLE"):
                m.d.sync += [came.eq(0), self.region.eq(0)]
                with m.If(self.start):
                    m.next = "COUNTS"
            with m.State("COUNTS"):
                m.d.comb += self.counts.ready.eq(1)
                with m.If(self.counts.valid):
                    m.d.sync += came.slot.eq(came.slot + 1)
                    with m.If(came.slot == self.slots - 1):
                        m.d.sync += [came.slot.eq(0), came.element.eq(came.element + 1)]
                        with m.If(came.element + 1 == self.elements):
                            m.next = "REGIONS"
            with m.State("REGIONS"):
                m.d.comb += self.asks.eq(1)
                m.d.sync += self.region.column.eq(self.region.column + 1)
                with m.If(self.region.column == self.columns - 1):
                    m.d.sync += [self.region.column.eq(0), self.region.row.eq(self.region.row + 1)]
                    with m.If(self.region.row == self.rows - 1):
                        m.next = "IDLE"
        return m
