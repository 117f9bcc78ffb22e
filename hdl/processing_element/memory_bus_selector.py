"""Gives the memory lines of a processing element to one of its parts at a time."""

from amaranth.hdl import *
from amaranth.lib import wiring
from amaranth.lib.wiring import In, Out

from ..backplane.connectors import MemoryBus

__all__ = ["MemoryBusSelector"]


class MemoryBusSelector(wiring.Component):
    """The depth test has the lines, but while a service needs them.  Combinational.

    Answers go to all three; only the one that has the lines asked.

    Parameters: those of ``MemoryBus``.

    Members
    -------
    surveying, reading: In(1)
        The lines are that service's; at most one of the two, and the depth test is idle.
    survey, read_back, depth_test: In(MemoryBus)
        The survey writes depths alone, and at address 0, to which the idle depth test keeps
        that line: the colour is whatever is on the others.  The read-back does not write.
    lines: Out(MemoryBus)

    Inside the processing element of figure 12.
    """

    def __init__(self, *, id_bits: int, address_bits: int, depth_bits: int):
        self.id_bits = id_bits
        self.address_bits = address_bits
        self.depth_bits = depth_bits
        lines = MemoryBus(id_bits=id_bits, address_bits=address_bits, depth_bits=depth_bits)
        super().__init__({
            "surveying": In(1),
            "reading": In(1),
            "survey": In(lines),
            "read_back": In(lines),
            "depth_test": In(lines),
            "lines": Out(lines),
        })

    def elaborate(self, platform):
        m = Module()
        lines = self.lines
        for source in (self.survey, self.read_back, self.depth_test):
            m.d.comb += [
                source.read_busy.eq(lines.read_busy),
                source.read_data.eq(lines.read_data),
                source.write_busy.eq(lines.write_busy),
                source.scanned.eq(lines.scanned),
            ]
        m.d.comb += [lines.read.eq(self.depth_test.read), lines.write.eq(self.depth_test.write)]
        with m.If(self.surveying):
            m.d.comb += [lines.read.eq(self.survey.read)]
            m.d.comb += [lines.write[name].eq(self.survey.write[name])
                         for name in ("valid", "unit", "depth")]
        with m.Elif(self.reading):
            m.d.comb += lines.read.eq(self.read_back.read)
        return m
