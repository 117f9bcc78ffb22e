"""Single bits that are changed one a clock, and words of them that are taken out."""

from amaranth.hdl import *
from amaranth.lib import data, memory, stream, wiring
from amaranth.lib.wiring import In, Out

__all__ = ["BitMemory", "check_sizes", "word_layout"]


def check_sizes(*, words: int, word_bits: int) -> None:
    """Raise ``ValueError`` unless there are words, whose bits are numbered by whole bits of an
    address."""
    if words < 1:
        raise ValueError(f"words must be positive, not {words!r}")
    if word_bits < 2 or word_bits & (word_bits - 1):
        raise ValueError(f"word_bits must be a power of two from 2, not {word_bits!r}")


def word_layout(*, words: int, word_bits: int) -> data.StructLayout:
    """A word, and which of the memory's it is.

    bits: word_bits
    place: range(words)
    """
    return data.StructLayout({"bits": word_bits, "place": range(words)})


class BitMemory(wiring.Component):
    """A RAM whose words are changed bit by bit, and taken out whole.

    A change reads its word, and writes it a clock later.  What a block RAM reads of a word in the
    clock in which that is written may be anything; so where two changes of one word follow each
    other, the second has from the first what it wrote.  Others find it in the RAM.

    A word that is taken leaves 0 behind, and waits in the RAM's output register until its user
    has it: so the next one is read while the user is busy with this one.  What the words hold
    after power-on is unknown; to take all of them, whoever has the answers, clears them.

    Changes and taking exclude each other: words are taken only while not ``busy``, and bits changed
    only while no word waits; none is taken twice in a row.

    Latency: ``latency`` clocks from a change to ``landed``; one from a place to its word.
    Throughput: a change a clock, or a word.

    Parameters
    ----------
    words: int, positive
    word_bits: int, a power of two, from 2

    Members
    -------
    change: In(1)
        Change a bit.
    place: In(range(words)), bit: In(range(word_bits)), value: In(1)
        Of which word, which one, and to what.
    busy: Out(1)
        A word is not written yet.
    landed: Out(1)
        A change has been written.
    landed_place: Out(range(words)), landed_any: Out(1)
        In which word, and whether that has a bit since.
    takes: In(stream of range(words))
        Places of words to be taken.
    taken: Out(stream of word_layout)
        The words.

    Raises ``ValueError`` for a number out of range.
    """

    latency = 2

    def __init__(self, *, words: int, word_bits: int):
        check_sizes(words=words, word_bits=word_bits)
        self.words = words
        self.word_bits = word_bits
        # No read that is of use meets a write.
        self.storage = memory.Memory(shape=word_bits, depth=words, init=[],
                                     attrs={"no_rw_check": 1})
        super().__init__({
            "change": In(1),
            "place": In(range(words)),
            "bit": In(range(word_bits)),
            "value": In(1),
            "busy": Out(1),
            "landed": Out(1),
            "landed_place": Out(range(words)),
            "landed_any": Out(1),
            "takes": In(stream.Signature(range(words))),
            "taken": Out(stream.Signature(word_layout(words=words, word_bits=word_bits))),
        })

    def elaborate(self, platform):
        m = Module()
        m.submodules.storage = self.storage
        write, read = self.storage.write_port(), self.storage.read_port()

        place = Signal.like(self.place)
        bit = Signal.like(self.bit)
        value = Signal()
        takes = Signal()
        follows = Signal()  # on the change of the same word
        before, after = Signal(self.word_bits), Signal(self.word_bits)
        written = Signal(self.word_bits)
        mask = Signal(self.word_bits)

        m.d.comb += [
            self.takes.ready.eq(~self.taken.valid | self.taken.ready),
            read.en.eq(self.change | (self.takes.valid & self.takes.ready)),
            read.addr.eq(Mux(self.change, self.place, self.takes.payload)),
        ]
        m.d.sync += self.busy.eq(read.en)
        with m.If(self.takes.ready):
            m.d.sync += self.taken.valid.eq(self.takes.valid)
        with m.If(read.en):
            m.d.sync += [
                place.eq(read.addr),
                bit.eq(self.bit),
                value.eq(self.value & self.change),
                takes.eq(~self.change),
                follows.eq(self.busy & (place == self.place)),
            ]
        m.d.comb += [
            # All bits of a word that is taken become 0, or one bit whatever it is changed to.
            mask.eq((1 << bit) | takes.replicate(self.word_bits)),
            before.eq(Mux(follows, written, read.data)),
            after.eq(Mux(value, before | mask, before & ~mask)),
            write.en.eq(self.busy),
            write.addr.eq(place),
            write.data.eq(after),
            self.taken.payload.bits.eq(read.data),
            self.taken.payload.place.eq(place),
            self.landed_any.eq(written.any()),
        ]
        m.d.sync += [
            written.eq(after),
            self.landed.eq(self.busy & ~takes),
            self.landed_place.eq(place),
        ]
        return m
