"""Gives the memory lines of a processing element to one of its parts at a time."""

from amaranth.hdl import *
from amaranth.lib import wiring
from amaranth.lib.wiring import In, Out

from ..golden.configuration import MachineConfiguration
from .backplane import ProcessingElementLines

__all__ = ["LineSelector"]


class LineSelector(wiring.Component):
    """The source whose ``select`` bit is high drives the lines; the last one, when none is.

    Combinational.  Answers go to every source; only the one selected asked.

    Members
    -------
    select: In(sources - 1)
        At most one bit high.
    sources: In(ProcessingElementLines) [sources]
    lines: Out(ProcessingElementLines)

    Raises ``ValueError`` for fewer than two sources.

    Inside the processing element of figure 12.
    """

    def __init__(self, *, configuration: MachineConfiguration, sources: int):
        if sources < 2:
            raise ValueError(f"sources must be at least 2, not {sources!r}")
        lines = ProcessingElementLines(configuration)
        super().__init__({
            "select": In(sources - 1),
            "sources": In(lines).array(sources),
            "lines": Out(lines),
        })

    def elaborate(self, platform):
        m = Module()
        for source in self.sources:
            m.d.comb += [
                source.read_busy.eq(self.lines.read_busy),
                source.read_data.eq(self.lines.read_data),
                source.write_busy.eq(self.lines.write_busy),
                source.scanned.eq(self.lines.scanned),
            ]
        *selected, default = self.sources
        m.d.comb += [self.lines.read.eq(default.read), self.lines.write.eq(default.write)]
        for source, select in zip(selected, self.select, strict=True):
            with m.If(select):
                m.d.comb += [self.lines.read.eq(source.read), self.lines.write.eq(source.write)]
        return m
