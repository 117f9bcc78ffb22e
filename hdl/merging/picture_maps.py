"""Which words of two pictures are drawn: one is drawn into while the other one is merged."""

from amaranth.hdl import *
from amaranth.lib import memory, stream, wiring
from amaranth.lib.wiring import In, Out

from .drawn_map import WORD_BITS, DrawnMap

__all__ = ["PictureMaps"]


class PictureMaps(wiring.Component):
    """A ``DrawnMap`` of either picture.  Words that are drawn are those of the back one; of the
    front one words are deleted, and it is listed, whatever happens to the other.

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
        self._maps = [DrawnMap(words=words, word_bits=word_bits) for _ in range(2)]
        self.words = words
        self.word_bits = word_bits
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
        """The RAMs of both."""
        return [storage for drawn in self._maps for storage in drawn.storages]

    def elaborate(self, platform):
        m = Module()
        for place, drawn in enumerate(self._maps):
            m.submodules[f"map_{place}"] = drawn
            front = self.front == place
            m.d.comb += [
                drawn.change.eq(Mux(front, self.hidden & drawn.ready, self.change)),
                drawn.address.eq(Mux(front, self.hidden_address, self.address)),
                drawn.drawn.eq(~front & self.drawn),
                drawn.start.eq(front & self.start),
                drawn.addresses.ready.eq(self.addresses.ready),
            ]
        zero, one = self._maps
        m.d.comb += [
            self.ready.eq(Mux(self.front, zero.ready, one.ready)),
            *(getattr(self, name).eq(Mux(self.front, getattr(one, name), getattr(zero, name)))
              for name in ("settled", "listing")),
            self.addresses.valid.eq(zero.addresses.valid | one.addresses.valid),
            self.addresses.payload.eq(
                Mux(self.front, one.addresses.payload, zero.addresses.payload)),
        ]
        return m
