"""The RAM of a memory unit as an FPGA has it: each part one port to read and one to write."""

from amaranth.hdl import *
from amaranth.lib import memory, wiring
from amaranth.lib.wiring import In

from .memory_access import (
    MemoryAccess,
    part_address,
    part_answer,
    part_asked,
    part_chosen,
    part_written,
)
from .word_parts import PARTS, Part

__all__ = ["TwoPortMemory"]


class TwoPortMemory(wiring.Component):
    """Each part of a word a block RAM of its own, so that the users do not meet.

    The scan reads colours and the processing element depths, and what is written
    goes through the other port: none of them ever waits.  The sweep takes clocks
    in which nobody asks for anything.

    What a block RAM reads in the clock in which that word is written differs from
    one to the next, and may be neither the old word nor the new one.  It happens
    for depths alone, and their reader knows what it writes (``TwoPortDepthTest``).
    The colour that is scanned is not the one that is drawn into, and the sweep is
    alone.

    Latency: one clock from a read to the data.  Throughput: a scan, a write and
    a read a clock.

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
        # `no_rw_check` spares the logic that would make a read beside a write see the old word.
        self.storages = [memory.Memory(shape=access.members[f"{part.kind}_in"].shape, depth=words,
                                       init=[], attrs={"no_rw_check": 1})
                         for part in parts]
        super().__init__({"access": In(access)})

    def elaborate(self, platform):
        m = Module()
        access = self.access
        m.d.comb += access.sweep_busy.eq(access.scan | access.write | access.read)
        sweep = access.sweep & ~access.sweep_busy
        erase = Signal.like(access.erase)
        m.d.comb += erase.eq(Mux(access.sweep_busy, 0, access.erase))

        answers = []
        for place, (part, storage) in enumerate(zip(self.parts, self.storages, strict=True)):
            m.submodules[part.name] = storage
            write, read = storage.write_port(), storage.read_port()
            asked, address = part_asked(access, part), part_address(access, part)
            written = part_written(access, part)
            m.d.comb += [
                read.addr.eq(Mux(asked, address, access.sweep_address)),
                read.en.eq(asked | sweep),
                write.addr.eq(Mux(access.write, access.write_address, access.sweep_address)),
                write.en.eq((access.write & part_chosen(access, part)) | erase[place]),
                # Whatever else is written with it, tag 0 erases.
                write.data.value.eq(written.value),
                write.data.tag.eq(Mux(access.write, written.tag, 0)),
            ]
            answers.append(read.data)

        m.d.comb += [part_answer(access, part).eq(answer)
                     for part, answer in zip(self.parts, answers, strict=True)]
        return m
