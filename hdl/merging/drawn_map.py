"""Which words of a memory were written since the last merge: exactly these are sent."""

from amaranth.hdl import *
from amaranth.lib import memory, stream, wiring
from amaranth.lib.wiring import In, Out

from ...golden.specification.configuration import MAXIMUM_WORDS
from .bit_memory import BitMemory, check_sizes
from .set_bits import SetBits

__all__ = ["WORD_BITS", "DrawnMap"]

#: Bits of a word of the map, and of its summary.
WORD_BITS = 64


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
        if not 1 <= words <= MAXIMUM_WORDS:
            raise ValueError(f"words must be 1 to {MAXIMUM_WORDS}, not {words!r}")
        check_sizes(words=words, word_bits=word_bits)
        self.words = words
        self.word_bits = word_bits
        self.map_words = -(-words // word_bits)
        self.summary_words = -(-self.map_words // word_bits)
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
        m.submodules.map_words = of_summary = SetBits(words=self.summary_words,
                                                      word_bits=self.word_bits)
        m.submodules.addresses = of_map = SetBits(words=self.map_words, word_bits=self.word_bits)

        clearing = Signal()
        place = Signal(range(self.map_words + 1))  # of the words that are taken in order
        left = Signal()  # of the summary
        m.d.comb += [
            left.eq(place < self.summary_words),
            map_.change.eq(self.change),
            Cat(map_.bit, map_.place).eq(self.address),
            map_.value.eq(self.drawn),
            summary.change.eq(map_.landed),
            Cat(summary.bit, summary.place).eq(map_.landed_place),
            summary.value.eq(map_.landed_any),
            self.settled.eq(self.ready & ~(map_.busy | map_.landed | summary.busy)),

            summary.takes.valid.eq((clearing | self.listing) & left),
            summary.takes.payload.eq(place),
            map_.takes.valid.eq(clearing | of_summary.numbers.valid),
            map_.takes.payload.eq(Mux(clearing, place, of_summary.numbers.payload)),
            of_summary.numbers.ready.eq(map_.takes.ready),
            self.addresses.valid.eq(of_map.numbers.valid),
            self.addresses.payload.eq(of_map.numbers.payload),
            of_map.numbers.ready.eq(self.addresses.ready),
        ]
        for taken, found in ((summary.taken, of_summary), (map_.taken, of_map)):
            m.d.comb += [
                # What is taken to clear it is not looked at.
                found.words_in.valid.eq(taken.valid & self.listing),
                found.words_in.payload.eq(taken.payload),
                taken.ready.eq(found.words_in.ready),
            ]

        with m.FSM():
            with m.State("CLEARING"):
                m.d.comb += clearing.eq(1)
                m.d.sync += place.eq(place + 1)
                with m.If(place == self.map_words - 1):
                    m.next = "READY"
            with m.State("READY"):
                m.d.comb += self.ready.eq(1)
                m.d.sync += place.eq(0)
                with m.If(self.start):
                    m.next = "LISTING"
            with m.State("LISTING"):
                m.d.comb += self.listing.eq(1)
                with m.If(left & summary.takes.ready):
                    m.d.sync += place.eq(place + 1)
                with m.If(~(left | summary.taken.valid | map_.taken.valid)
                          & of_summary.empty & of_map.empty):
                    m.next = "READY"
        return m
