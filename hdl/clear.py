"""Background into every word of a domain."""

from amaranth.hdl import *
from amaranth.lib import wiring
from amaranth.lib.wiring import In, Out

from ..golden.configuration import CHANNEL_BITS, MachineConfiguration
from .backplane import Lane, ProcessingElementLines

__all__ = ["Clear"]


class Clear(wiring.Component):
    """Writes the background to all units of the domain at once, word after word.

    Latency: ``words`` clocks, plus the waits for scan slots.

    Members
    -------
    words: In
        How many words of each unit hold the picture.
    color: In(24)
    front: In(1)
        Also into the front picture, as after power-on.
    start: In(1)
        Begin; ``color``, ``front`` and ``words`` hold until ``done``.
    done: Out(1)
        High for one clock, with the last write.
    memory: Out(ProcessingElementLines)

    Fuchs & Johnson, step (c) after figure 12: each processing element initialises its buffers.
    """

    def __init__(self, *, configuration: MachineConfiguration):
        self.configuration = configuration
        super().__init__({
            "words": In(range(configuration.words + 1)),
            "color": In(3 * CHANNEL_BITS),
            "front": In(1),
            "start": In(1),
            "done": Out(1),
            "memory": Out(ProcessingElementLines(configuration)),
        })

    def elaborate(self, platform):
        m = Module()
        memory = self.memory
        address = Signal(self.configuration.address_bits)
        m.d.comb += [
            memory.write.every.eq(1),
            memory.write.address.eq(address),
            memory.write.depth.eq(self.configuration.depth_background),
            memory.write.color.eq(self.color),
            memory.write.lanes.eq(Mux(self.front, Lane.DEPTH | Lane.BACK | Lane.FRONT,
                                      Lane.DEPTH | Lane.BACK)),
        ]
        with m.FSM():
            with m.State("IDLE"), m.If(self.start):
                m.d.sync += address.eq(0)
                m.next = "WRITE"
            with m.State("WRITE"):
                m.d.comb += memory.write.valid.eq(1)
                with m.If(~memory.write_busy):
                    m.d.sync += address.eq(address + 1)
                    with m.If(address + 1 >= self.words):
                        m.d.comb += self.done.eq(1)
                        m.next = "IDLE"
        return m
