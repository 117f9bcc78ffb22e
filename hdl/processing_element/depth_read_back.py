"""Sends the depth words of a domain to the host."""

from amaranth.hdl import *
from amaranth.lib import stream, wiring
from amaranth.lib.wiring import In, Out

from ..backplane.connectors import MemoryBus

__all__ = ["DepthReadBack"]


class DepthReadBack(wiring.Component):
    """Reads every word of every unit of the domain: units in order, addresses ascending.

    Latency: a word is offered two clocks after its read.  Throughput: a word every
    two clocks while it is taken and the unit has its port.

    Parameters: those of ``MemoryBus``.

    Members
    -------
    first, end: In(id_bits)
        The domain, ``end`` excluded.
    last_word: In(address_bits)
        The last of the words of each unit that hold the picture.
    start: In(1)
        Begin; the inputs hold until ``done``.
    done: Out(1)
        High for one clock when the last word has been taken.
    depths: Out(stream of depth words)
        0 while not valid.
    memory: Out(MemoryBus)

    Not in the paper; the memory bus is that of figure 12.
    """

    latency = 2

    def __init__(self, *, id_bits: int, address_bits: int, depth_bits: int):
        self.id_bits = id_bits
        self.address_bits = address_bits
        self.depth_bits = depth_bits
        memory = MemoryBus(id_bits=id_bits, address_bits=address_bits, depth_bits=depth_bits)
        super().__init__({
            "first": In(id_bits),
            "end": In(id_bits),
            "last_word": In(address_bits),
            "start": In(1),
            "done": Out(1),
            "depths": Out(stream.Signature(depth_bits)),
            "memory": Out(memory),
        })

    def elaborate(self, platform):
        m = Module()
        memory, depths = self.memory, self.depths
        unit = Signal.like(self.first)
        address = Signal(self.address_bits)
        # This address is the last one; the next one is the first.
        last, again = Signal(name="last"), Signal(name="again")
        answering = Signal()  # the answer is on the memory bus in this clock only
        free = ~answering & (~depths.valid | depths.ready)
        m.d.comb += [
            memory.read.unit.eq(unit),
            memory.read.address.eq(address),
            last.eq(address == self.last_word),
        ]
        read = memory.read.valid & ~memory.read_busy
        m.d.sync += answering.eq(read)
        with m.If(answering):
            m.d.sync += [depths.payload.eq(memory.read_data), depths.valid.eq(1)]
        with m.If(depths.valid & depths.ready):  # no answer comes before this
            m.d.sync += [depths.valid.eq(0), depths.payload.eq(0)]

        with m.FSM():
            with m.State("IDLE"):
                m.d.comb += again.eq(1)
                m.d.sync += unit.eq(self.first)
                with m.If(self.start):
                    m.next = "READ"
            with m.State("READ"):
                with m.If(unit != self.end):
                    m.d.comb += memory.read.valid.eq(free)
                    with m.If(read):
                        m.d.comb += again.eq(last)
                        m.d.sync += [address.eq(address + 1), unit.eq(unit + last)]
                with m.Elif(free):
                    m.d.comb += self.done.eq(1)
                    m.next = "IDLE"
        with m.If(again):
            m.d.sync += address.eq(0)
        return m
