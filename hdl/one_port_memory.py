"""The RAM of a memory unit: one port, one access a clock."""

from amaranth.hdl import *
from amaranth.lib import data, memory, wiring
from amaranth.lib.wiring import In, Out

from ..golden.configuration import CHANNEL_BITS, MAXIMUM_WORDS

__all__ = ["OnePortMemory"]


class OnePortMemory(wiring.Component):
    """Three lanes a word, behind one address (figure 6): depth, and two colours.

    One access takes place in each clock: a write of the lanes named, or a read
    when no lane is.  Contents are unknown after power-on.

    Latency: one clock from ``address`` to the data.  Throughput: one access a clock.

    Members
    -------
    address: In(range(words))
    read: In(1)
        Read the word; the data hold until the next read.
    write: In(3)
        Write enable of each lane: depth, colour 0, colour 1.
    depth_in, color_in: In
        What is written.
    depth: Out(depth_bits)
        Depth of the word last read.
    color: Out(24) [2]
        Both colours of the word last read.

    Raises ``ValueError`` for ``words`` or ``depth_bits`` out of range.
    """

    def __init__(self, *, words: int, depth_bits: int):
        if not 1 <= words <= MAXIMUM_WORDS:
            raise ValueError(f"words must be 1 to {MAXIMUM_WORDS}, not {words!r}")
        if not 1 <= depth_bits <= 32:
            raise ValueError(f"depth_bits must be 1 to 32, not {depth_bits!r}")
        self.words = words
        self.depth_bits = depth_bits
        color_bits = 3 * CHANNEL_BITS
        # Lanes of one width, so that it is one RAM with lane enables and not three.
        lane = unsigned(max(depth_bits, color_bits))
        self.storage = memory.Memory(shape=data.ArrayLayout(lane, 3), depth=words, init=[])
        super().__init__({
            "address": In(range(max(2, words))),
            "read": In(1),
            "write": In(3),
            "depth_in": In(depth_bits),
            "color_in": In(color_bits),
            "depth": Out(depth_bits),
            "color": Out(color_bits).array(2),
        })

    @property
    def latency(self) -> int:
        return 1

    def elaborate(self, platform):
        m = Module()
        m.submodules.storage = self.storage
        write, read = self.storage.write_port(granularity=1), self.storage.read_port()
        m.d.comb += [
            write.addr.eq(self.address),
            write.en.eq(self.write),
            write.data[0].eq(self.depth_in),
            write.data[1].eq(self.color_in),
            write.data[2].eq(self.color_in),
            read.addr.eq(self.address),
            # One port: a clock that writes does not read, and the data hold.
            read.en.eq(self.read & ~self.write.any()),
            self.depth.eq(read.data[0]),
            self.color[0].eq(read.data[1]),
            self.color[1].eq(read.data[2]),
        ]
        return m
