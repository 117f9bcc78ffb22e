"""Sends the depth words of a domain to the host."""

from amaranth.hdl import *
from amaranth.lib import stream, wiring
from amaranth.lib.wiring import In, Out

from ..golden.configuration import MachineConfiguration
from .backplane import ProcessingElementLines

__all__ = ["ReadBack"]


class ReadBack(wiring.Component):
    """Reads every word of every unit of the domain: units in order, addresses ascending.

    Latency: a word is offered in the clock after its read.  Throughput: a word
    a clock while it is taken and the unit has its port.

    Members
    -------
    first, end: In(id_bits)
        The domain, ``end`` excluded.
    words: In
        How many words of each unit hold the picture.
    start: In(1)
        Begin; the inputs hold until ``done``.
    done: Out(1)
        High for one clock when the last word has been taken.
    depths: Out(stream of depth words)
    memory: Out(ProcessingElementLines)

    Not in the paper; the lines are those of figure 12.
    """

    latency = 1

    def __init__(self, *, configuration: MachineConfiguration):
        self.configuration = configuration
        super().__init__({
            "first": In(configuration.id_bits),
            "end": In(configuration.id_bits),
            "words": In(range(configuration.words + 1)),
            "start": In(1),
            "done": Out(1),
            "depths": Out(stream.Signature(configuration.depth_bits)),
            "memory": Out(ProcessingElementLines(configuration)),
        })

    def elaborate(self, platform):
        m = Module()
        memory, depths = self.memory, self.depths
        unit = Signal.like(self.first)
        address = Signal(self.configuration.address_bits)
        fresh = Signal()  # the answer is on the lines in this clock only
        held = Signal.like(memory.read_data)
        free = ~depths.valid | depths.ready
        m.d.comb += [
            memory.read.unit.eq(unit),
            memory.read.address.eq(address),
            depths.payload.eq(Mux(fresh, memory.read_data, held)),
        ]
        read = memory.read.valid & ~memory.read_busy
        m.d.sync += fresh.eq(read)
        with m.If(fresh):
            m.d.sync += held.eq(memory.read_data)
        with m.If(free):
            m.d.sync += depths.valid.eq(read)

        with m.FSM():
            with m.State("IDLE"), m.If(self.start):
                m.d.sync += [unit.eq(self.first), address.eq(0)]
                m.next = "READ"
            with m.State("READ"):
                with m.If(unit != self.end):
                    m.d.comb += memory.read.valid.eq(free)
                    with m.If(read):
                        m.d.sync += address.eq(address + 1)
                        with m.If(address + 1 >= self.words):
                            m.d.sync += [address.eq(0), unit.eq(unit + 1)]
                with m.Elif(free):
                    m.d.comb += self.done.eq(1)
                    m.next = "IDLE"
        return m
