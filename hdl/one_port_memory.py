"""The RAM of a memory unit: one port, one access a clock."""

from amaranth.hdl import *
from amaranth.lib import memory, wiring
from amaranth.lib.wiring import In, Out

from ..golden.configuration import CHANNEL_BITS, MAXIMUM_WORDS

__all__ = ["OnePortMemory"]


class OnePortMemory(wiring.Component):
    """Depth and two colours a word, behind one address (figure 6).

    One access takes place in each clock: a read when no lane is written, else a
    write of the lanes named.  The three banks share the address, so that yosys
    or an ASIC flow may build them as one RAM with write enables.  Contents are
    unknown after power-on.

    Latency: one clock from ``address`` to the data.  Throughput: one access a clock.

    Members
    -------
    address: In(range(words))
    read: In(1)
        Read the word; data hold until the next read.
    write_depth, write_color: In(1), In(2)
        Write enables: the depth, and each of the two colours.
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
        self.depth_bank = memory.Memory(shape=unsigned(depth_bits), depth=words, init=[])
        self.color_banks = [memory.Memory(shape=unsigned(color_bits), depth=words, init=[])
                            for _ in range(2)]
        super().__init__({
            "address": In(range(max(2, words))),
            "read": In(1),
            "write_depth": In(1),
            "write_color": In(2),
            "depth_in": In(depth_bits),
            "color_in": In(color_bits),
            "depth": Out(depth_bits),
            "color": Out(color_bits).array(2),
        })

    @property
    def latency(self) -> int:
        return 1

    @property
    def banks(self) -> list[memory.Memory]:
        return [self.depth_bank, *self.color_banks]

    def elaborate(self, platform):
        m = Module()
        ports = [(self.depth_bank, self.write_depth, self.depth_in, self.depth)]
        ports += [(bank, self.write_color[index], self.color_in, self.color[index])
                  for index, bank in enumerate(self.color_banks)]
        writing = self.write_depth | self.write_color.any()
        for index, (bank, enable, data_in, data_out) in enumerate(ports):
            m.submodules[f"bank_{index}"] = bank
            write, read = bank.write_port(), bank.read_port()
            m.d.comb += [
                write.addr.eq(self.address),
                write.en.eq(enable),
                write.data.eq(data_in),
                read.addr.eq(self.address),
                # One port: a clock that writes does not read, and the data hold.
                read.en.eq(self.read & ~writing),
                data_out.eq(read.data),
            ]
        return m
