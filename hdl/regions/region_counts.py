"""What a processing element counts of each of its slots, by which the next table is made."""

from amaranth.hdl import *
from amaranth.lib import memory, stream, wiring
from amaranth.lib.wiring import In, Out

from ...golden.specification.commands import RESPONSE_VALUE_BITS
from ...golden.specification.configuration import MachineConfiguration
from .region_clip import visited_row_layout

__all__ = ["RegionCounts"]


class RegionCounts(wiring.Component):
    """Adds up the visits of each slot since the frame start.

    With ``balance`` ``"triangles"`` a visit counts one; with ``"clocks"`` as many as it has rows or
    pixels, whichever are more.  Counts are modulo 2³².

    Latency: a visit is counted ``latency`` clocks after its last row.  Throughput: a row, or a
    visit, a clock.  A report is a slot every two clocks while they are taken.

    Members
    -------
    row: In(visited_row_layout)
        A row that has been walked, if it is ``valid``.
    clear: In(1)
        Every count is 0 from the next clock on.
    start: In(1)
        Report, once nothing is left to count; ignored while reporting.
    counts: Out(stream of RESPONSE_VALUE_BITS)
        The slots', in order; 0 while not valid.
    done: Out(1)
        High for one clock when the last one has been taken.

    Ellsworth 1994: the count of primitives in each region, and what else a region may cost.
    """

    latency = 4

    def __init__(self, *, configuration: MachineConfiguration):
        self.configuration = configuration
        super().__init__({
            "row": In(visited_row_layout(configuration)),
            "clear": In(1),
            "start": In(1),
            "counts": Out(stream.Signature(RESPONSE_VALUE_BITS)),
            "done": Out(1),
        })

    def elaborate(self, platform):
        m = Module()
        slots = self.configuration.slots
        m.submodules.sums = ram = memory.Memory(shape=RESPONSE_VALUE_BITS, depth=slots, init=[],
                                                attrs={"no_rw_check": 1})
        write, read = ram.write_port(), ram.read_port()
        counted = Signal(slots)  # of each slot: something, since the frame start
        visit, slot, amount = self._visits(m)

        # A clock later the sum so far is there; that of the clock before is not in the RAM yet.
        adds, again = Signal(), Signal()
        known = Signal()
        before, adds_to, sum_before = (Signal(RESPONSE_VALUE_BITS), Signal.like(slot),
                                       Signal(RESPONSE_VALUE_BITS))
        addend = Signal.like(amount)
        m.d.sync += [
            adds.eq(visit), addend.eq(amount), adds_to.eq(slot),
            again.eq(adds & (adds_to == slot)),
            sum_before.eq(write.data),
        ]
        m.d.comb += [
            before.eq(Mux(known, read.data, 0)),
            write.en.eq(adds),
            write.addr.eq(adds_to),
            write.data.eq(Mux(again, sum_before, before) + addend),
        ]

        reporting, asked, asks, free = Signal(), Signal(), Signal(), Signal()
        place = Signal(range(slots + 1))
        m.d.comb += [
            free.eq(reporting & ~asked & (~self.counts.valid | self.counts.ready)),
            asks.eq(free & (place != slots)),
            self.done.eq(free & (place == slots)),
            read.addr.eq(Mux(reporting, place, slot)),
        ]
        m.d.sync += [known.eq(Array(counted)[read.addr]), asked.eq(asks)]
        with m.If(adds):
            m.d.sync += counted.bit_select(adds_to, 1).eq(1)
        with m.If(self.clear):
            m.d.sync += counted.eq(0)

        with m.If(asks):
            m.d.sync += place.eq(place + 1)
        with m.If(asked):
            m.d.sync += [self.counts.valid.eq(1), self.counts.payload.eq(before)]
        with m.Elif(self.counts.ready):
            m.d.sync += [self.counts.valid.eq(0), self.counts.payload.eq(0)]
        with m.If(self.done):
            m.d.sync += reporting.eq(0)
        with m.Elif(self.start):
            m.d.sync += [reporting.eq(1), place.eq(0)]
        return m

    def _visits(self, m):
        """A visit ends, its slot, what it counts; some clocks after its last row."""
        row = Signal.like(self.row)
        m.d.sync += row.eq(self.row)
        if self.configuration.balance == "triangles":
            return row.valid & row.ends, row.slot, C(1)
        regions = self.configuration.dealt_regions
        rows = Signal(range((1 << regions.y_bits) + 1))
        pixels = Signal(range((1 << regions.x_bits + regions.y_bits) + 1))
        anew = Signal(init=1)  # the last row was a visit's last
        ended = Signal()
        slot = Signal.like(row.slot)
        with m.If(row.valid):
            m.d.sync += [
                rows.eq(Mux(anew, 0, rows) + 1),
                pixels.eq(Mux(anew, 0, pixels) + row.pixels),
                anew.eq(row.ends),
                slot.eq(row.slot),
            ]
        m.d.sync += ended.eq(row.valid & row.ends)
        return ended, slot, Mux(pixels > rows, pixels, rows)
