"""Gives the memory bus of a processing element to one of its parts at a time."""

from amaranth.hdl import *
from amaranth.lib import wiring
from amaranth.lib.wiring import In, Out

from ..backplane.connectors import MemoryBus

__all__ = ["MemoryBusSelector"]


class MemoryBusSelector(wiring.Component):
    """The depth test has the memory bus, except while a service needs it.  Combinational.

    Answers go to all three; only the one that has the bus has asked.

    Parameters: those of ``MemoryBus``.

    Members
    -------
    surveying, reading: In(1)
        The bus is that service's; at most one of the two, and the depth test is idle.
    survey, read_back, depth_test: In(MemoryBus)
        The survey drives neither address nor colour of its writes: both stay those of the depth
        test, which keeps the address 0 while it is idle (``DepthTestSignature``).  The read-back
        does not write.
    lines: Out(MemoryBus)
        The bus that one of them has; the name is that of the ``Connector`` it goes to.

    Inside the processing element of figure 12.
    """

    def __init__(self, *, id_bits: int, address_bits: int, depth_bits: int):
        self.id_bits = id_bits
        self.address_bits = address_bits
        self.depth_bits = depth_bits
        bus = MemoryBus(id_bits=id_bits, address_bits=address_bits, depth_bits=depth_bits)
        super().__init__({
            "surveying": In(1),
            "reading": In(1),
            "survey": In(bus),
            "read_back": In(bus),
            "depth_test": In(bus),
            "lines": Out(bus),
        })

    def elaborate(self, platform):
        m = Module()
        bus = self.lines
        for source in (self.survey, self.read_back, self.depth_test):
            m.d.comb += [
                source.read_busy.eq(bus.read_busy),
                source.read_data.eq(bus.read_data),
                source.write_busy.eq(bus.write_busy),
                source.scanned.eq(bus.scanned),
            ]
        m.d.comb += [bus.read.eq(self.depth_test.read), bus.write.eq(self.depth_test.write)]
        with m.If(self.surveying):
            m.d.comb += [bus.read.eq(self.survey.read)]
            m.d.comb += [bus.write[name].eq(self.survey.write[name])
                         for name in ("valid", "unit", "depth")]
        with m.Elif(self.reading):
            m.d.comb += bus.read.eq(self.read_back.read)
        return m
