"""Which words of a memory were written since the last merge: exactly these are sent."""

from amaranth.hdl import *
from amaranth.lib import memory, stream, wiring
from amaranth.lib.wiring import In, Out

from ...golden.specification.ranges import MAXIMUM_WORDS
from .bit_memory import BitMemory, check_sizes
from .set_bits import SetBits

__all__ = ["WORD_BITS", "DrawnMap"]

#: Bits of a word of the map, and of its summary.
WORD_BITS = 64


def map_sizes(*, words: int, word_bits: int) -> tuple[int, int]:
    """Words of a map of so many words of memory, and of its summary.  Raises ``ValueError`` for a
    number out of range."""
    if not 1 <= words <= MAXIMUM_WORDS:
        raise ValueError(f"words must be 1 to {MAXIMUM_WORDS}, not {words!r}")
    check_sizes(words=words, word_bits=word_bits)
    map_words = -(-words // word_bits)
    return map_words, -(-map_words // word_bits)


class DrawnMap(wiring.Component):
    """A bit for each word of a memory, and a summary: a bit for each word of the map that has any.

    Map and summary are the same kind of RAM.  What a change leaves of its word of the map is a
    change of the summary's bit, so this is exact once the change has landed.

    A listing takes the summary word by word, of these the words of the map that have bits, and
    gives the addresses of the bits; the next word is read while the bits of one are given.  So
    the time follows what is drawn: a word of the summary without any bits, which stands for
    ``word_bits``² words of the memory, costs a clock.  What was taken is 0: after a listing the map
    is empty.

    After reset the map clears itself, since what RAM holds after power-on is unknown; a clock
    for each word of the map.

    Latency: ``latency`` clocks from ``start`` to the first address, where the first word of the
    summary has a bit; ``settling`` from a change to ``settled``.  Throughput: a change a clock, an
    address a clock.  A listing whose addresses are taken at once takes, from ``start`` to the end
    of ``listing``, at most a clock for each address, one for each word of the summary, and
    ``overhead``.

    Parameters
    ----------
    words: int, positive
        Words of the memory.
    word_bits: int, a power of two, from 2

    Members
    -------
    ready: Out(1)
        It has cleared itself, and lists nothing: changes may come.
    change: In(1)
        Change a bit; only while ``ready``.
    address: In(range(words)), drawn: In(1)
        Which one, and to what.
    settled: Out(1)
        ``ready``, and no change of an earlier clock is on its way.
    start: In(1)
        List; only while ``settled``, and not together with a change.
    listing: Out(1)
        From the clock after ``start`` until all addresses have been taken.
    addresses: Out(stream of addresses)
        Of all bits set, in ascending order.

    Raises ``ValueError`` for a number out of range.
    """

    latency = 9
    overhead = 9
    settling = 4

    def __init__(self, *, words: int, word_bits: int = WORD_BITS):
        self.words = words
        self.word_bits = word_bits
        self.map_words, self.summary_words = map_sizes(words=words, word_bits=word_bits)
        self._map = BitMemory(words=self.map_words, word_bits=word_bits)
        self._summary = BitMemory(words=self.summary_words, word_bits=word_bits)
        address = range(max(2, words))
        super().__init__({
            "ready": Out(1),
            "change": In(1),
            "address": In(address),
            "drawn": In(1),
            "settled": Out(1),
            "start": In(1),
            "listing": Out(1),
            "addresses": Out(stream.Signature(address)),
        })

    @property
    def storages(self) -> list[memory.Memory]:
        """The RAM of the map, and that of the summary."""
        return [self._map.storage, self._summary.storage]

    def elaborate(self, platform):
        m = Module()
        m.submodules.map = map_ = self._map
        m.submodules.summary = summary = self._summary
        listing = Listing(m, self, map_, summary)
        add_changes(m, map_, summary, change=self.change, address=self.address, drawn=self.drawn)
        m.d.comb += self.settled.eq(self.ready & ~unsettled(map_, summary))
        listing.add_to(m, ready=self.ready)
        return m


def add_changes(m: Module, map_: BitMemory, summary: BitMemory, *, change: Value, address: Value,
                drawn: Value) -> None:
    """Bits of a map are changed as a ``DrawnMap`` says, and those of its summary follow."""
    m.d.comb += [
        map_.change.eq(change),
        Cat(map_.bit, map_.place).eq(address),
        map_.value.eq(drawn),
        summary.change.eq(map_.landed),
        Cat(summary.bit, summary.place).eq(map_.landed_place),
        summary.value.eq(map_.landed_any),
    ]


def unsettled(map_: BitMemory, summary: BitMemory) -> Value:
    """A change of an earlier clock is on its way."""
    return map_.busy | map_.landed | summary.busy


class Listing:
    """Has ``lister`` clear a map and its summary after reset and list them, as a ``DrawnMap`` does;
    of both only ``takes`` and ``taken`` are used.

    This is no component: it adds its parts and signals to ``m``, the module of ``lister``.
    """

    def __init__(self, m: Module, lister: wiring.PureInterface, map_: wiring.PureInterface,
                 summary: wiring.PureInterface):
        self._lister, self._map, self._summary = lister, map_, summary
        self._of_summary = SetBits(words=lister.summary_words, word_bits=lister.word_bits)
        self._of_map = SetBits(words=lister.map_words, word_bits=lister.word_bits)
        m.submodules.map_words, m.submodules.addresses = self._of_summary, self._of_map
        #: After a reset, in which no change may come.
        self.clearing = Signal(name="clearing")
        # Of the words that are taken in order, and whether it is one of the summary.
        self._place = Signal(range(lister.map_words + 1), name="place")
        self._left = Signal(name="left")
        m.d.comb += self._left.eq(self._place < lister.summary_words)

    def add_to(self, m: Module, *, ready: Signal) -> None:
        """All else; ``ready``: it neither clears nor lists."""
        lister, map_, summary, place = self._lister, self._map, self._summary, self._place
        of_summary, of_map = self._of_summary, self._of_map
        m.d.comb += [
            summary.takes.valid.eq((self.clearing | lister.listing) & self._left),
            summary.takes.payload.eq(place),
            map_.takes.valid.eq(self.clearing | of_summary.numbers.valid),
            map_.takes.payload.eq(Mux(self.clearing, place, of_summary.numbers.payload)),
            of_summary.numbers.ready.eq(map_.takes.ready),
            lister.addresses.valid.eq(of_map.numbers.valid),
            lister.addresses.payload.eq(of_map.numbers.payload),
            of_map.numbers.ready.eq(lister.addresses.ready),
        ]
        for taken, found in ((summary.taken, of_summary), (map_.taken, of_map)):
            m.d.comb += [
                # What is taken to clear it is not looked at.
                found.words_in.valid.eq(taken.valid & lister.listing),
                found.words_in.payload.eq(taken.payload),
                taken.ready.eq(found.words_in.ready),
            ]

        with m.FSM():
            with m.State("CLEARING"):
                m.d.comb += self.clearing.eq(1)
                m.d.sync += place.eq(place + 1)
                with m.If(place == lister.map_words - 1):
                    m.next = "READY"
            with m.State("READY"):
                m.d.comb += ready.eq(1)
                m.d.sync += place.eq(0)
                with m.If(lister.start):
                    m.next = "LISTING"
            with m.State("LISTING"):
                m.d.comb += lister.listing.eq(1)
                with m.If(self._left & summary.takes.ready):
                    m.d.sync += place.eq(place + 1)
                with m.If(~(self._left | summary.taken.valid | map_.taken.valid)
                          & of_summary.empty & of_map.empty):
                    m.next = "READY"
