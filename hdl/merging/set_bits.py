"""Which bits of words are set, one after the other."""

from functools import reduce
from operator import or_

from amaranth.hdl import *
from amaranth.lib import stream, wiring
from amaranth.lib.wiring import In, Out

from .bit_memory import check_sizes, word_layout

__all__ = ["SetBits"]


class SetBits(wiring.Component):
    """Numbers all set bits of each word that comes, from the lowest to the highest.

    A word is looked at in groups of bits, as many as a group has bits or half as many, so that
    the lowest of either is found in little logic.  One stage takes from a word the lowest group
    that has bits, the next one from a group the lowest bit, and a third one holds its number.
    A stage is given more in the clock in which its last one goes.

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

    latency = 3

    def __init__(self, *, words: int, word_bits: int):
        check_sizes(words=words, word_bits=word_bits)
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
        group_count = 1 << (self.word_bits - 1).bit_length() // 2
        group_bits = self.word_bits // group_count
        word = Signal.like(words.payload)
        groups = Signal(group_count)  # of the word that are left
        bits = Signal(group_bits)  # of the group that are left
        group = Signal(range(self.words * group_count))  # its number
        lowest_group, other_groups = _lowest_and_others(groups)
        lowest_bit, other_bits = _lowest_and_others(bits)

        moves, next_group = Signal(), Signal()
        m.d.comb += [
            moves.eq(~numbers.valid | numbers.ready),
            next_group.eq(moves & ~other_bits.any()),
            words.ready.eq(next_group & ~other_groups.any()),
            self.empty.eq(~(groups.any() | bits.any() | numbers.valid)),
        ]
        with m.If(moves):
            m.d.sync += [
                numbers.valid.eq(bits.any()),
                numbers.payload.eq(Cat(_number(lowest_bit), group)),
                bits.eq(other_bits),
            ]
        with m.If(next_group):
            m.d.sync += [
                # None where the word has no group left.
                bits.eq(reduce(or_, (
                    part & chosen.replicate(group_bits) for part, chosen
                    in zip(_parts(word.bits, group_bits), lowest_group, strict=True)))),
                group.eq(Cat(_number(lowest_group), word.place)),
                groups.eq(other_groups),
            ]
        with m.If(words.valid & words.ready):
            m.d.sync += [
                word.eq(words.payload),
                groups.eq(Cat(part.any() for part in _parts(words.payload.bits, group_bits))),
            ]
        return m


def _parts(value: Value, width: int) -> list[Value]:
    return [value[begin:begin + width] for begin in range(0, len(value), width)]


def _lowest_and_others(bits: Value) -> tuple[Value, Value]:
    """The lowest bit that is set, alone in its place, and all others; no bit, where none is set."""
    lower = Cat(bits[:place].any() for place in range(len(bits)))
    return bits & ~lower, bits & lower


def _number(lone_bit: Value) -> Value:
    """In which place the only bit is that is set."""
    places = range(len(lone_bit))
    return Cat(Cat(lone_bit[place] for place in places if place >> digit & 1).any()
               for digit in range((len(lone_bit) - 1).bit_length()))
