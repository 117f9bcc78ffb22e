"""The triangles that a node keeps, to draw them frame after frame."""

from amaranth.hdl import *
from amaranth.lib import memory, stream, wiring
from amaranth.lib.wiring import In, Out

from ...golden.specification.ranges import MAXIMUM_WORDS

__all__ = ["ListMemory"]


class ListMemory(wiring.Component):
    """Words that are stored one after another, and given back in that order as often as asked.

    What is given waits in the RAM's output register until it is taken; the next word is read in the
    clock in which it is.

    Latency: ``latency`` clocks from ``start`` to the first word.  Throughput: a word a clock, in
    both directions.

    Parameters
    ----------
    words: int, positive
        How many there is room for.
    word_bits: int, positive

    Members
    -------
    store: In(1), word: In(word_bits)
        Keep a word, after all others; only while nothing is given.
    clear: In(1)
        Keep nothing any more.
    full: Out(1)
        Since the last ``clear`` a word came for which there was no room; it is lost.
    start: In(1)
        Give all words; only while nothing is given.
    giving: Out(1)
        From the clock after ``start`` until the last one has been taken.
    given: Out(stream of words)

    Raises ``ValueError`` for a number out of range.

    The subset of the graphics database that a processor keeps (Cox & Hanrahan 1993, section 1).
    """

    latency = 2

    def __init__(self, *, words: int, word_bits: int):
        if not 1 <= words <= MAXIMUM_WORDS:
            raise ValueError(f"words must be 1 to {MAXIMUM_WORDS}, not {words!r}")
        if word_bits < 1:
            raise ValueError(f"word_bits must be positive, not {word_bits!r}")
        self.words = words
        self.word_bits = word_bits
        # Nothing is read in a clock in which something is written.
        self.storage = memory.Memory(shape=word_bits, depth=words, init=[],
                                     attrs={"no_rw_check": 1})
        super().__init__({
            "store": In(1),
            "word": In(word_bits),
            "clear": In(1),
            "full": Out(1),
            "start": In(1),
            "giving": Out(1),
            "given": Out(stream.Signature(word_bits)),
        })

    def elaborate(self, platform):
        m = Module()
        m.submodules.storage = self.storage
        write, read = self.storage.write_port(), self.storage.read_port()
        count = Signal(range(self.words + 1))
        place = Signal(range(self.words + 1))
        left, moves = Signal(), Signal()
        m.d.comb += [
            write.addr.eq(count),
            write.data.eq(self.word),
            write.en.eq(self.store & (count != self.words)),
            left.eq(self.giving & (place != count)),
            moves.eq(~self.given.valid | self.given.ready),
            read.addr.eq(place),
            read.en.eq(left & moves),
            self.given.payload.eq(read.data),
        ]
        with m.If(self.clear):
            m.d.sync += [count.eq(0), self.full.eq(0)]
        with m.Elif(self.store):
            m.d.sync += self.full.eq(self.full | ~write.en)
            with m.If(write.en):
                m.d.sync += count.eq(count + 1)
        with m.If(moves):
            m.d.sync += [self.given.valid.eq(left), place.eq(place + left)]
        with m.If(self.start):
            m.d.sync += [self.giving.eq(1), place.eq(0)]
        with m.Elif(~left & moves):
            m.d.sync += self.giving.eq(0)
        return m
