"""One edge of a triangle, followed exactly from lattice row to lattice row."""

from amaranth.hdl import *
from amaranth.lib import wiring
from amaranth.lib.wiring import In, Out

from ..golden import commands
from ..golden.configuration import MachineConfiguration
from .layouts import struct_layout

__all__ = ["EdgeWalker"]


class EdgeWalker(wiring.Component):
    """The first pixel column not left of an edge, in row after row.

    Carried in fixed point, with as many fraction bits as make every column
    exact (``golden.setup.carry_edges``), so no row is ever off.  Doubling the
    step turns "next row" into "two rows on", which is how the walker takes up
    the row stride of its own lattice, one power of two a clock; advancing where
    the offset's bit is set takes it to its first row on the way.

    Arithmetic is modulo ``2**edge_word_bits``: only columns at rows inside the
    edge count, and those fit.

    Latency: one clock.  Throughput: one advance (and doubling) a clock.

    Members
    -------
    edge: In(edge_layout)
        The edge as broadcast.
    load: In(1)
        Start at the edge's first row.
    advance: In(1)
        Go on by one step.
    double: In(1)
        Make the step twice as long, for later advances.
    column: Out(signed(edge_column_bits))

    Fuchs & Johnson, figure 13: the constant change from pixel to pixel of one unit.
    """

    def __init__(self, *, configuration: MachineConfiguration):
        self.configuration = configuration
        super().__init__({
            "edge": In(struct_layout(commands.edge_layout(configuration))),
            "load": In(1),
            "advance": In(1),
            "double": In(1),
            "column": Out(signed(configuration.edge_column_bits)),
        })

    def elaborate(self, platform):
        m = Module()
        column, step = (Signal(self.configuration.edge_word_bits, name=name)
                        for name in ("value", "step"))
        with m.If(self.advance):
            m.d.sync += column.eq(column + step)
        with m.If(self.double):
            m.d.sync += step.eq(step << 1)
        with m.If(self.load):
            m.d.sync += [column.eq(self.edge.start), step.eq(self.edge.step)]
        m.d.comb += self.column.eq(column >> self.configuration.edge_fraction_bits)
        return m
