"""The RAM of a memory unit of 1979: one port, one access a clock."""

from amaranth.hdl import *
from amaranth.lib import data, memory, wiring
from amaranth.lib.wiring import In

from .memory_access import MemoryAccess, part_answer, part_chosen, part_written
from .word_parts import PARTS, Part

__all__ = ["OnePortMemory"]


class OnePortMemory(wiring.Component):
    """All parts of a word behind one address (figure 6): in each clock one user's access.

    Latency: one clock from a read to the data.  Throughput: one access a clock,
    of whichever kind.

    Members
    -------
    access: In(MemoryAccess)

    Raises ``ValueError`` for a size out of range.
    """

    latency = 1

    def __init__(self, *, words: int, depth_bits: int, tag_bits: int,
                 parts: tuple[Part, ...] = PARTS):
        access = MemoryAccess(words=words, depth_bits=depth_bits, tag_bits=tag_bits, parts=parts)
        self.parts = parts
        self.words = words
        self.depth_bits = depth_bits
        self.tag_bits = tag_bits
        # Parts of one width, so that it is one RAM with an enable for each part, not one RAM each.
        width = max(Shape.cast(access.members[f"{part.kind}_in"].shape).width for part in parts)
        # Synthesis cannot know that a read never meets a write.
        self.storage = memory.Memory(shape=data.ArrayLayout(width, len(parts)), depth=words,
                                     init=[], attrs={"no_rw_check": 1})
        super().__init__({"access": In(access)})

    @property
    def storages(self) -> list[memory.Memory]:
        return [self.storage]

    def elaborate(self, platform):
        m = Module()
        m.submodules.storage = self.storage
        access = self.access
        write, read = self.storage.write_port(granularity=1), self.storage.read_port()
        address = Signal.like(access.scan_address)
        with m.If(access.scan):
            m.d.comb += [address.eq(access.scan_address), read.en.eq(1)]
        with m.Elif(access.write):
            m.d.comb += [address.eq(access.write_address),
                         write.en.eq(Cat(part_chosen(access, part) for part in self.parts))]
        with m.Elif(access.read):
            m.d.comb += [address.eq(access.read_address), read.en.eq(1)]
        with m.Else():
            m.d.comb += [address.eq(access.sweep_address), read.en.eq(access.sweep),
                         write.en.eq(access.erase)]
        m.d.comb += [
            read.addr.eq(address),
            write.addr.eq(address),
            access.write_busy.eq(access.scan),
            access.read_busy.eq(access.scan | access.write),
            access.sweep_busy.eq(access.scan | access.write | access.read),
        ]
        for place, part in enumerate(self.parts):
            written = part_written(access, part)
            # Whatever else is written with it, tag 0 erases.
            m.d.comb += write.data[place].eq(
                Cat(Mux(access.write, written.tag, 0), written.value))
        for place, part in enumerate(self.parts):
            m.d.comb += part_answer(access, part).eq(read.data[place])
        return m
