"""Which words of two pictures are drawn: one is drawn into while the other one is merged."""

from amaranth.hdl import *
from amaranth.lib import memory, stream, wiring
from amaranth.lib.wiring import In, Out

from .bit_memory import BitMemory, word_layout
from .drawn_map import WORD_BITS, DrawnMap, Listing, add_changes, map_sizes, unsettled

__all__ = ["PictureMaps"]


class PictureMaps(wiring.Component):
    """A map of either picture, as a ``DrawnMap`` has one, that are listed in turn.  Words that are
    drawn are those of the back one; of the front one words are deleted, and it is listed, whatever
    happens to the other.

    Latency and throughput: those of ``DrawnMap``, for both pictures at the same time.

    Parameters: those of ``DrawnMap``.

    Members
    -------
    front: In(1)
        Which one is in front; it changes only while nothing is listed.
    ready: Out(1), change: In(1), address: In(range(words)), drawn: In(1)
        Of the back one, as of ``DrawnMap``.
    hidden: In(1), hidden_address: In(range(words))
        Delete a word of the front one; not while that is listed.
    settled: Out(1), start: In(1), listing: Out(1), addresses: Out(stream of addresses)
        Of the front one, as of ``DrawnMap``.

    Raises ``ValueError`` for a number out of range.
    """

    latency = DrawnMap.latency
    overhead = DrawnMap.overhead
    settling = DrawnMap.settling

    def __init__(self, *, words: int, word_bits: int = WORD_BITS):
        self.words = words
        self.word_bits = word_bits
        self.map_words, self.summary_words = map_sizes(words=words, word_bits=word_bits)
        self._maps, self._summaries = ([BitMemory(words=size, word_bits=word_bits)
                                        for _ in range(2)]
                                       for size in (self.map_words, self.summary_words))
        address = range(max(2, words))
        super().__init__({
            "front": In(1),
            "ready": Out(1),
            "change": In(1),
            "address": In(address),
            "drawn": In(1),
            "hidden": In(1),
            "hidden_address": In(address),
            "settled": Out(1),
            "start": In(1),
            "listing": Out(1),
            "addresses": Out(stream.Signature(address)),
        })

    @property
    def storages(self) -> list[memory.Memory]:
        """The RAM of the map and that of the summary, of one picture and of the other."""
        return [bits.storage for pair in zip(self._maps, self._summaries, strict=True)
                for bits in pair]

    def elaborate(self, platform):
        m = Module()
        free = Signal()  # for deletions
        map_, summary = (self._front_of(bits[0], name) for bits, name in (
            (self._maps, "map"), (self._summaries, "summary")))
        listing = Listing(m, self, map_, summary)
        for both, front, name in ((self._maps, map_, "map"), (self._summaries, summary, "summary")):
            self._choose(m, both, front, name, listing.clearing)
        late = []
        for place, (own_map, own_summary) in enumerate(zip(self._maps, self._summaries,
                                                           strict=True)):
            front = self.front == place
            add_changes(m, own_map, own_summary, change=Mux(front, self.hidden & free, self.change),
                        address=Mux(front, self.hidden_address, self.address),
                        drawn=~front & self.drawn)
            late.append(unsettled(own_map, own_summary))
        m.d.comb += [self.ready.eq(~listing.clearing),
                     self.settled.eq(free & ~Mux(self.front, late[1], late[0]))]
        listing.add_to(m, ready=free)
        return m

    def _front_of(self, bits, name):
        """What is taken of the picture in front, for the listing."""
        return wiring.Signature({
            "takes": In(stream.Signature(range(bits.words))),
            "taken": Out(stream.Signature(word_layout(words=bits.words,
                                                      word_bits=self.word_bits))),
        }).create(path=(name,))

    def _choose(self, m, both, front, name, clearing):
        """Words are taken of the picture in front; of both while these are cleared."""
        takes, taken = front.takes, front.taken
        zero, one = both
        m.d.comb += [
            takes.ready.eq(Mux(self.front, one.takes.ready, zero.takes.ready)),
            taken.valid.eq(Mux(self.front, one.taken.valid, zero.taken.valid)),
            taken.payload.eq(Mux(self.front, one.taken.payload, zero.taken.payload)),
        ]
        for place, bits in enumerate(both):
            m.submodules[f"{name}_{place}"] = bits
            chosen = self.front == place
            m.d.comb += [
                bits.takes.valid.eq(takes.valid & (chosen | clearing)),
                bits.takes.payload.eq(takes.payload),
                bits.taken.ready.eq(taken.ready | ~chosen),
            ]
