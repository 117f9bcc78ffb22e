"""Items in order of their weight, one memory read a clock."""

from amaranth.hdl import *
from amaranth.lib import data, memory, stream, wiring
from amaranth.lib.wiring import In, Out

__all__ = ["MergeSorter"]


class MergeSorter(wiring.Component):
    """Takes a fixed number of items and gives them back heaviest first, equals as they came.

    Bottom-up merge sort: a pass merges pairs of neighbouring runs, each sorted, into runs of twice
    the length, from one half of the memory into the other.  What is merged next waits in two
    registers, one for each run of the pair; an item is merged in one clock, and the one behind it
    read in the next.  The results of the last pass are not written but given.

    Latency: ``latency`` clocks from the last item to the first that is given; of these a pass, but
    not the last one, takes two for each item and two for each pair.  Throughput: an item a clock
    is taken, one in two clocks is given.

    Parameters
    ----------
    items: int, positive
        How many are sorted at a time.
    weight_bits: int, positive
    label: shape
        What goes with a weight.

    Members
    -------
    put: In(1), item: In((weight, label))
        An item comes; not before all that were sorted before have been taken.
    sorted: Out(stream of (weight, label, last))
        ``last`` marks the last one.

    Raises ``ValueError`` for a number that is not positive.
    """

    def __init__(self, *, items: int, weight_bits: int, label: ShapeLike):
        for name, value in (("items", items), ("weight_bits", weight_bits)):
            if value < 1:
                raise ValueError(f"{name} must be positive, not {value!r}")
        self.items = items
        self.passes = max(1, (items - 1).bit_length())
        self.layout = data.StructLayout({"weight": weight_bits, "label": label})
        # Each half has a power of two of places, so that the half is a bit of the address.
        self.storage = memory.Memory(shape=self.layout, depth=2 << self.passes, init=[],
                                     attrs={"no_rw_check": 1})
        super().__init__({
            "put": In(1),
            "item": In(self.layout),
            "sorted": Out(stream.Signature(data.StructLayout({**self.layout.members, "last": 1}))),
        })

    @property
    def latency(self) -> int:
        """Three before the first item of a pass is merged, and one on either side."""
        return 5 + sum(2 * self.items + 2 * -(-self.items >> number + 1)
                       for number in range(self.passes - 1))

    def elaborate(self, platform):
        m = Module()
        m.submodules.storage = self.storage
        write, read = self.storage.write_port(), self.storage.read_port()

        half = Signal()  # the one that is merged
        place = Signal(self.passes)  # of the item that is written or given
        within = Signal(self.passes, init=1)  # the bits of a place that count within its pair
        run = within & ~(within >> 1)  # the length of a run, a power of two
        left, right = (_Run(self, name) for name in ("left", "right"))
        for side in (left, right):
            m.d.comb += side.here.eq(side.next)
            m.d.sync += side.comes.eq(side.asks)
            with m.If(side.asks):
                m.d.comb += read.addr.eq(Cat(side.here[:self.passes], half))
                m.d.sync += side.next.eq(side.here + 1)
            with m.If(side.comes):
                m.d.sync += side.first.eq(read.data)
        # A pair begins at a multiple of twice the run, so only places of its right run have this
        # bit.  There may be no right run, or less than one.
        with m.If(left.asks):
            m.d.sync += left.over.eq((left.here & run).any())
        with m.If(right.asks):
            m.d.sync += right.over.eq(~(right.here & run).any() | (right.here >= self.items))

        takes_left = Signal()
        merged = Signal(self.layout)
        last = Signal()
        gives = within.all()  # instead of writing
        m.d.comb += [
            takes_left.eq(~left.over
                          & (right.over | (left.first.weight >= right.first.weight))),
            merged.eq(Mux(takes_left, left.first, right.first)),
            last.eq(place == self.items - 1),
            write.addr.eq(Cat(place, ~half)),
            write.data.eq(merged),
        ]
        with m.If(self.sorted.ready):
            m.d.sync += self.sorted.valid.eq(0)
        with m.FSM():
            with m.State("FILL"):
                m.d.comb += [
                    write.en.eq(self.put),
                    write.addr.eq(Cat(place, half)),
                    write.data.eq(self.item),
                ]
                with m.If(self.put):
                    m.d.sync += place.eq(place + 1)
                    with m.If(last):
                        m.d.sync += place.eq(0)
                        m.next = "PAIR"
            with m.State("PAIR"):
                m.d.comb += [left.asks.eq(1), left.here.eq(place)]
                m.next = "RIGHT"
            with m.State("RIGHT"):
                m.d.comb += [right.asks.eq(1), right.here.eq(place + run)]
                m.next = "READ"
            with m.State("READ"):
                m.next = "MERGE"
            with m.State("MERGE"):
                m.d.comb += write.en.eq(1)
                with m.If(~gives | ~self.sorted.valid | self.sorted.ready):
                    m.d.comb += [left.asks.eq(takes_left), right.asks.eq(~takes_left)]
                    m.d.sync += [
                        place.eq(place + 1),
                        self.sorted.valid.eq(gives),
                        self.sorted.payload.weight.eq(merged.weight),
                        self.sorted.payload.label.eq(merged.label),
                        self.sorted.payload.last.eq(last),
                    ]
                    m.next = "READ"
                    with m.If(last):
                        m.d.sync += [place.eq(0), half.eq(~half), within.eq(Cat(1, within))]
                        m.next = "PAIR"
                        with m.If(gives):
                            m.d.sync += [half.eq(0), within.eq(1)]
                            m.next = "FILL"
                    with m.Elif((place | ~within).all()):
                        m.next = "PAIR"
        return m


class _Run:
    """One of the two runs that are merged: its first item, and where it goes on."""

    def __init__(self, sorter: MergeSorter, name: str):
        self.asks = Signal(name=f"{name}_asks")  # for its next item
        self.here = Signal(sorter.passes + 1, name=f"{name}_here")
        self.next = Signal(sorter.passes + 1, name=f"{name}_next")
        self.comes = Signal(name=f"{name}_comes")
        self.first = Signal(sorter.layout, name=f"{name}_first")
        self.over = Signal(name=f"{name}_over")  # there was no next one
