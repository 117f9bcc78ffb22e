"""The circuit that makes numbers on the backplane (figure 11)."""

from amaranth.hdl import *
from amaranth.lib import wiring
from amaranth.lib.wiring import In, Out

__all__ = ["IdIncrement"]


class IdIncrement(wiring.Component):
    """Adds one to the ID lines as they pass a memory unit.  Combinational.

    The lines start at 0 at the left end, so a unit's number is what comes in,
    and what leaves the right end is the number of units in the cage.

    Members
    -------
    left: In(bits)
    right: Out(bits)
        ``left`` + 1, modulo ``2**bits``.

    Raises ``ValueError`` when ``bits`` is not positive.
    """

    def __init__(self, *, bits: int):
        if bits < 1:
            raise ValueError(f"bits must be positive, not {bits!r}")
        self.bits = bits
        super().__init__({"left": In(bits), "right": Out(bits)})

    def elaborate(self, platform):
        m = Module()
        m.d.comb += self.right.eq(self.left + 1)
        return m
