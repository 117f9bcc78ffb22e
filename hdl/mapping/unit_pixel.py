"""Which pixel a memory unit holds at an address: the inverse of ``PixelAddress``."""

from amaranth.hdl import *
from amaranth.lib import wiring
from amaranth.lib.wiring import In, Out

from ...golden.specification.configuration import MachineConfiguration
from ...golden.specification.interlace import Interlace
from .interlace import units_moved

__all__ = ["UnitPixel", "reciprocal_shift"]


def reciprocal_shift(pitch: int, words: int) -> int:
    """An s for which ⌊a · ⌈2^s / pitch⌉ / 2^s⌋ is ⌊a / pitch⌋ for each address a < words; every
    greater one is, too.

    The product is too large by a · (⌈2^s / pitch⌉ · pitch - 2^s) / pitch, which does no harm while
    it is less than 2^s / pitch: then no quotient passes a whole number, as the greatest below one
    is a pitch-th part away.
    """
    shift = 0
    while (words - 1) * (-(1 << shift) % pitch) >= 1 << shift:
        shift += 1
    return shift


def _pixel(interlace: Interlace, unit: Value, column: Value, row: Value) -> tuple[Value, Value]:
    """x and y from the number of the unit, and the bits of both that name no unit."""
    axes: dict[str, list[Value]] = {}
    if interlace.diagonal:  # whose units are named by x alone
        unit = unit - units_moved(interlace, row)
    for axis, value in (("x", column), ("y", row)):
        mask = interlace.unit_mask(axis)
        left = iter(Cat(value, C(0, mask.bit_length())))
        # Places of the unit's bits are filled below.
        bits = [C(0, 1) if mask >> place & 1 else next(left)
                for place in range(mask.bit_length())]
        axes[axis] = [*bits, *left]
    for place, (axis, bit) in enumerate(reversed(interlace.bit_order)):
        axes[axis][bit] = unit[place]
    if interlace.skew_bit is not None:
        axis, bit = interlace.bit_order[-1]
        axes[axis][bit] = axes[axis][bit] ^ axes["x"][interlace.skew_bit]
    return Cat(axes["x"]), Cat(axes["y"])


class UnitPixel(wiring.Component):
    """The pixel that lies at an address of a memory unit.

    The row of the address is its quotient by the pitch: a product with the reciprocal, exact for
    every word, or a shift where all pitches are powers of two.

    Latency: ``latency`` clocks.  Throughput: a pixel a clock.

    Members
    -------
    total: In(id_bits)
        Number of memory units among which the picture is interlaced; it holds.
    unit: In(id_bits)
        Number of one of them.
    address: In(address_bits)
        One of its words that hold the picture.
    x, y: Out
        The pixel, at that picture's resolution.

    Fuchs & Johnson 1979, figures 13 and 14.
    """

    latency = 2

    def __init__(self, *, configuration: MachineConfiguration):
        self.configuration = configuration
        super().__init__({
            "total": In(configuration.id_bits),
            "unit": In(configuration.id_bits),
            "address": In(configuration.address_bits),
            "x": Out(configuration.x_bits),
            "y": Out(configuration.y_bits),
        })

    def elaborate(self, platform):
        m = Module()
        interlaces = self.configuration.interlaces()
        aligned = all(interlace.pitch.bit_count() == 1 for interlace in interlaces)
        shift = max(reciprocal_shift(interlace.pitch, interlace.words) for interlace in interlaces)
        pitch = Signal(range(max(interlace.pitch for interlace in interlaces) + 1))
        reciprocal = Signal(range(max(-(-(1 << shift) // interlace.pitch)
                                      for interlace in interlaces) + 1))
        quotient = Signal.like(self.address)
        # A clock later.
        unit, address, row = (Signal.like(early) for early in (self.unit, self.address, quotient))
        column = Signal.like(address)
        with m.Switch(self.total):
            for interlace in interlaces:
                with m.Case(interlace.units):
                    bits = interlace.pitch.bit_length() - 1
                    m.d.comb += [pitch.eq(interlace.pitch),
                                 reciprocal.eq(-(-(1 << shift) // interlace.pitch))]
                    if aligned:
                        m.d.comb += [quotient.eq(self.address >> bits),
                                     column.eq(address[:bits])]
                    x, y = _pixel(interlace, unit, column, row)
                    m.d.sync += [self.x.eq(x), self.y.eq(y)]
        if not aligned:
            m.d.comb += [quotient.eq((self.address * reciprocal) >> shift),
                         column.eq(address - row * pitch)]
        m.d.sync += [unit.eq(self.unit), address.eq(self.address), row.eq(quotient)]
        return m
