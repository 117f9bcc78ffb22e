"""How a processing element learns the upper end of its domain."""

from amaranth.hdl import *
from amaranth.lib import wiring
from amaranth.lib.wiring import In, Out

from ..backplane.connectors import MemoryBus

__all__ = ["Survey"]


class Survey(wiring.Component):
    """Writes and reads a word in each possible unit, from the first one on.

    A unit of the domain gives back what was written, twice, with every bit both
    ways; where none answers, the bus reads 0.  The units found are those up to
    the first that does not answer.

    Latency, from ``start``: eight clocks a unit, plus the waits for scan slots;
    then four at the unit that does not answer, or one when all have.

    Parameters: those of ``MemoryBus``.

    Members
    -------
    first, total: In(id_bits)
        From the backplane: the first unit to the right, and the number of all.
    start: In(1)
        Begin; ignored while surveying.
    done: Out(1)
        High for one clock at the end.
    end: Out(id_bits)
        First unit beyond the domain; ``first`` when there is none.
    memory: Out(MemoryBus)
        It drives unit and depth of a write, but not the address: whoever hands the bus on keeps
        that at 0, where it reads (``MemoryBusSelector``).

    Fuchs & Johnson, step (b) after figure 12.
    """

    def __init__(self, *, id_bits: int, address_bits: int, depth_bits: int):
        self.id_bits = id_bits
        self.address_bits = address_bits
        self.depth_bits = depth_bits
        memory = MemoryBus(id_bits=id_bits, address_bits=address_bits, depth_bits=depth_bits)
        super().__init__({
            "first": In(id_bits),
            "total": In(id_bits),
            "start": In(1),
            "done": Out(1),
            "end": Out(id_bits),
            "memory": Out(memory),
        })

    def elaborate(self, platform):
        m = Module()
        depth_bits = self.depth_bits
        memory = self.memory
        second = Signal()  # the complement's turn
        pattern = Signal(depth_bits)
        answered = Signal()
        m.d.comb += [
            # 1010…: neither this nor its complement is what a silent bus reads.
            pattern.eq(Const(0xAAAA_AAAA_AAAA_AAAA, depth_bits) ^ second.replicate(depth_bits)),
            memory.write.unit.eq(self.end),
            memory.read.unit.eq(self.end),
            memory.write.depth.eq(pattern),
        ]
        with m.FSM():
            with m.State("IDLE"), m.If(self.start):
                m.d.sync += [self.end.eq(self.first), second.eq(0)]
                m.next = "WRITE"
            with m.State("WRITE"):
                with m.If(self.end == self.total):
                    m.d.comb += self.done.eq(1)
                    m.next = "IDLE"
                with m.Else():
                    m.d.comb += memory.write.valid.eq(1)
                    with m.If(~memory.write_busy):
                        m.next = "READ"
            with m.State("READ"):
                m.d.comb += memory.read.valid.eq(1)
                with m.If(~memory.read_busy):
                    m.next = "COMPARE"
            with m.State("COMPARE"):
                m.d.sync += answered.eq(memory.read_data == pattern)
                m.next = "DECIDE"
            with m.State("DECIDE"):
                with m.If(~answered):
                    m.d.comb += self.done.eq(1)
                    m.next = "IDLE"
                with m.Else():
                    m.d.sync += [second.eq(~second), self.end.eq(self.end + second)]
                    m.next = "WRITE"
        return m
