"""The balancer: from what was counted of each region to the table for the next picture."""

from amaranth.hdl import *
from amaranth.lib import data, memory, stream, wiring
from amaranth.lib.wiring import In, Out

from .least_loaded import LeastLoaded
from .merge_sorter import MergeSorter
from .region_order import RegionOrder, region_shape

__all__ = ["Balancer"]


class Balancer(wiring.Component):
    """Packs regions into processing elements as ``golden.organisations.region_table.packed_table``
    does, heaviest first.

    It keeps one table: the one that was dealt last, and after a packing the packed one, until that
    is dealt.  So before the first packing it has what was dealt at boot; and counts are understood
    by the table by which the picture was drawn that they were counted in.

    ::

        counts ─▶ RegionOrder ─▶ MergeSorter ─▶ LeastLoaded ─▶ table ─▶ element
                       ▲                                        │ ▲
                       ╰────────────────────────────────────────╯ ╰─ dealt

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
        self._order = RegionOrder(columns=columns, rows=rows, elements=elements, slots=slots,
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
        m.submodules.order = order = self._order
        m.submodules.sorter = sorter = self._sorter
        m.submodules.packer = packer = self._packer
        m.submodules.places = places = memory.Memory(
            shape=self._place, depth=1 << self._region.size, init=[], attrs={"no_rw_check": 1})
        write, read = places.write_port(), places.read_port()

        wiring.connect(m, wiring.flipped(self.counts), order.counts)
        wiring.connect(m, sorter.sorted, packer.regions)
        packed, dealt = packer.regions.payload, self.dealt
        m.d.comb += [
            order.start.eq(self.start),
            order.elements.eq(self.elements),
            packer.start.eq(self.start),
            packer.elements.eq(self.elements),
            sorter.put.eq(order.put),
            sorter.item.eq(order.item),

            read.addr.eq(Mux(order.asks, order.region, Cat(self.column, self.row))),
            order.element.eq(read.data.element),
            order.slot.eq(read.data.slot),
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
