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

    The column is an exact quotient with its remainder, so no row is ever off:
    column + remainder / denominator is a rational number that grows by
    column_step + remainder_step / denominator from row to row.  Doubling that
    step turns "next row" into "two rows on", which is how the walker takes up
    the row stride of its own lattice, one power of two a clock; advancing where
    the offset's bit is set takes it to its first row on the way.

    Column arithmetic is modulo ``2**edge_column_bits``: only columns at rows
    inside the edge count, and those fit.

    Latency: one clock.  Throughput: one advance (and doubling) a clock.

    Members
    -------
    edge: In(edge_layout)
        The edge as broadcast; ``denominator`` must hold until the next ``load``.
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
        column_bits = self.configuration.edge_column_bits
        remainder_bits = self.configuration.edge_remainder_bits
        column = Signal(column_bits)
        column_step = Signal(column_bits)
        remainder = Signal(remainder_bits)
        remainder_step = Signal(remainder_bits)

        def add(quotients, remainders):
            """Quotient and remainder of a sum; the remainders' sum is below twice the divisor."""
            total = Signal(remainder_bits + 1)
            carry = Signal()
            m.d.comb += [total.eq(sum(remainders)), carry.eq(total >= self.edge.denominator)]
            return (sum(quotients) + carry,
                    Mux(carry, total - self.edge.denominator, total)[:remainder_bits])

        with m.If(self.advance):
            next_column, next_remainder = add((column, column_step), (remainder, remainder_step))
            m.d.sync += [column.eq(next_column), remainder.eq(next_remainder)]
        with m.If(self.double):
            next_step, next_remainder_step = add((column_step, column_step),
                                                 (remainder_step, remainder_step))
            m.d.sync += [column_step.eq(next_step), remainder_step.eq(next_remainder_step)]
        with m.If(self.load):
            m.d.sync += [
                column.eq(self.edge.column),
                column_step.eq(self.edge.column_step),
                remainder.eq(self.edge.remainder),
                remainder_step.eq(self.edge.remainder_step),
            ]
        m.d.comb += self.column.eq(column)
        return m
