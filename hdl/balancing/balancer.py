"""The balancer: from what was counted of each region to the table for the next picture."""

from amaranth.hdl import *
from amaranth.lib import data, memory, stream, wiring
from amaranth.lib.wiring import In, Out

from .least_loaded import LeastLoaded
from .merge_sorter import MergeSorter
from .region_counts import RegionCounts, region_shape

__all__ = ["Balancer"]


class Balancer(wiring.Component):
    """Packs regions into processing elements as ``golden.organisations.region_table.packed_table``
    does, heaviest first.

    It keeps one table: as it was dealt last, from then on to the next packing; after that the packed
    one.  So the table that is dealt at boot is the first one, and the counts that come are
    understood by the table that was dealt before the picture that they were counted in.

    ::

        counts ─▶ RegionCounts ─▶ MergeSorter ─▶ LeastLoaded ─▶ table ─▶ element
                        ▲                                         │  ▲
                        ╰─────────────────────────────────────────╯  ╰─ dealt

    Latency, from the first count to ``done``, where no count is waited for: what
    ``golden.balancing.balancer_clocks`` says.

    Parameters
    ----------
    columns, rows: int, positive
        Of the regions.
    elements: int, positive
        The most processing elements there are.
    slots: int, positive
        Regions that each has room for.
    count_bits: int, positive

    Members
    -------
    elements: In(range(elements + 1))
        How many there are, from 1, with room for all regions; static from ``start`` to ``done``.
    dealt: In((valid, column, row, element, slot))
        The table that pictures are drawn by from now on, as it is dealt: all regions, row by row,
        with the processing element of each and how many lower regions that one has.  Not while
        busy.
    start: In(1)
        Counts come from the next clock on; not while busy.
    counts: In(stream of count_bits)
        As the processing elements send them from left to right, ``slots`` of each; of slots without
        a region any number.
    busy: Out(1)
        From the clock after ``start`` to that of ``done``.
    done: Out(1)
        High for one clock at the end; from the next one on the table is the packed one.
    column: In(range(columns)), row: In(range(rows))
        A region; not while busy.
    element: Out(range(elements + 1))
        Its processing element by the table, a clock later.  Of a region that is dealt in the clock
        in which it is asked for it may be anything.

    Raises ``ValueError`` for a number that is not positive, or for more regions than there is room
    for.

    Ellsworth 1994, the greedy multiple-bin packing before figure 3.
    """

    def __init__(self, *, columns: int, rows: int, elements: int, slots: int,
                 count_bits: int = 32):
        self._counts = RegionCounts(columns=columns, rows=rows, elements=elements, slots=slots,
                                    count_bits=count_bits)
        if columns * rows > elements * slots:
            raise ValueError(f"slots: {slots} in each of {elements} elements are too few for "
                             f"{columns * rows} regions")
        self._region = region_shape(columns=columns, rows=rows)
        self._sorter = MergeSorter(items=columns * rows, weight_bits=count_bits,
                                   label=self._region)
        self._packer = LeastLoaded(elements=elements, slots=slots, count_bits=count_bits,
                                   label=self._region)
        self._place = data.StructLayout({"slot": range(slots), "element": range(elements + 1)})
        super().__init__({
            "elements": In(range(elements + 1)),
            "dealt": In(wiring.Signature({"valid": Out(1), "column": Out(range(columns)),
                                          "row": Out(range(rows)),
                                          "element": Out(range(elements + 1)),
                                          "slot": Out(range(slots))})),
            "start": In(1),
            "counts": In(stream.Signature(count_bits)),
            "busy": Out(1),
            "done": Out(1),
            "column": In(range(columns)),
            "row": In(range(rows)),
            "element": Out(range(elements + 1)),
        })

    def elaborate(self, platform):
        m = Module()
        m.submodules.counts = counts = self._counts
        m.submodules.sorter = sorter = self._sorter
        m.submodules.packer = packer = self._packer
        m.submodules.table = table = memory.Memory(
            shape=self._place, depth=1 << self._region.size, init=[], attrs={"no_rw_check": 1})
        write, read = table.write_port(), table.read_port()

        wiring.connect(m, wiring.flipped(self.counts), counts.counts)
        wiring.connect(m, sorter.sorted, packer.regions)
        packed, dealt = packer.regions.payload, self.dealt
        m.d.comb += [
            counts.start.eq(self.start),
            counts.elements.eq(self.elements),
            packer.start.eq(self.start),
            packer.elements.eq(self.elements),
            sorter.put.eq(counts.put),
            sorter.item.eq(counts.item),

            read.addr.eq(Mux(counts.asks, counts.region, Cat(self.column, self.row))),
            counts.element.eq(read.data.element),
            counts.slot.eq(read.data.slot),
            self.element.eq(read.data.element),

            write.en.eq(packer.given | dealt.valid),
            write.addr.eq(Mux(packer.given, packed.label, Cat(dealt.column, dealt.row))),
            # Slots are known when all is packed: then they are counted, and dealt.
            write.data.element.eq(Mux(packer.given, packer.element, dealt.element)),
            write.data.slot.eq(dealt.slot),

            self.done.eq(packer.given & packed.last),
        ]
        with m.If(self.start):
            m.d.sync += self.busy.eq(1)
        with m.Elif(self.done):
            m.d.sync += self.busy.eq(0)
        return m
