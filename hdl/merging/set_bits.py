"""Which bits of words are set, one after the other."""

from amaranth.hdl import *
from amaranth.lib import stream, wiring
from amaranth.lib.wiring import In, Out

from .bit_memory import check_word_bits, word_layout

__all__ = ["SetBits"]


class SetBits(wiring.Component):
    """Numbers all set bits of each word that comes, from the lowest to the highest.

    Two stages: one takes the lowest bit off the word, the other says which one it was.  The next
    word comes as the last bit of this one goes.

    Latency: ``latency`` clocks from a word to its first bit.  Throughput: a bit a clock; a word
    without any takes a clock.

    Parameters
    ----------
    words: int, positive
        There are so many places.
    word_bits: int, a power of two, from 2

    Members
    -------
    words_in: In(stream of word_layout)
    numbers: Out(stream of the numbers of set bits)
        Place of the word times ``word_bits``, and which bit of the word.
    empty: Out(1)
        No bit is left of the words that came.

    Raises ``ValueError`` for a number out of range.
    """

    latency = 2

    def __init__(self, *, words: int, word_bits: int):
        if words < 1:
            raise ValueError(f"words must be positive, not {words!r}")
        check_word_bits(word_bits)
        self.words = words
        self.word_bits = word_bits
        super().__init__({
            "words_in": In(stream.Signature(word_layout(words=words, word_bits=word_bits))),
            "numbers": Out(stream.Signature(range(words * word_bits))),
            "empty": Out(1),
        })

    def elaborate(self, platform):
        m = Module()
        words, numbers = self.words_in, self.numbers
        left = Signal.like(words.payload)
        lowest = Signal.like(words.payload)  # with this one bit
        others = Signal(self.word_bits)
        moves = Signal()

        m.d.comb += [
            others.eq(left.bits & (left.bits - 1)),
            moves.eq(~numbers.valid | numbers.ready),
            words.ready.eq(moves & (others == 0)),
            self.empty.eq(~left.bits.any() & ~numbers.valid),
        ]
        with m.If(moves):
            m.d.sync += [
                numbers.valid.eq(left.bits.any()),
                lowest.bits.eq(left.bits & ~others),
                lowest.place.eq(left.place),
                left.bits.eq(others),
            ]
        with m.If(words.valid & words.ready):
            m.d.sync += left.eq(words.payload)

        bits = range(self.word_bits)
        bit = Cat(Cat(lowest.bits[place] for place in bits if place >> digit & 1).any()
                  for digit in range((self.word_bits - 1).bit_length()))
        m.d.comb += numbers.payload.eq(Cat(bit, lowest.place))
        return m
