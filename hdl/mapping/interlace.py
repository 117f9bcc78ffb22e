"""Pixel ↔ unit arithmetic, as each board does it from the backplane alone (figures 13, 14)."""

from amaranth.hdl import *
from amaranth.lib import wiring
from amaranth.lib.wiring import In, Out

from ...golden.specification.configuration import MachineConfiguration
from ...golden.specification.interlace import Interlace

__all__ = ["PixelAddress", "ScanAddress", "group_mask", "unit_number", "units_moved", "without"]


def unit_number(interlace: Interlace, x: Value, y: Value) -> Value:
    """The number of the unit that holds pixel (x, y): some low bits of both, reordered; where units
    interlace diagonally, of x and of as many times y as units that each row is moved."""
    # A picture may have fewer rows or columns than there are units along them.
    axes = {axis: Cat(value, C(0, interlace.unit_mask(axis).bit_length()))
            for axis, value in (("x", x), ("y", y))}
    number = [axes[axis][bit] for axis, bit in reversed(interlace.bit_order)]
    if interlace.skew_bit is not None and interlace.skew_bit < len(x):
        number[0] ^= x[interlace.skew_bit]
    if interlace.diagonal:
        return (Cat(number) + units_moved(interlace, y))[:interlace.unit_bits]
    return Cat(number)


def units_moved(interlace: Interlace, row: Value) -> Value:
    """By how many units a row is moved where they interlace diagonally, modulo their number.

    A product with a constant, written as its sums: synthesis would take a multiplier for the few
    bits that count, at less than half the clock rate.
    """
    step, row = interlace.diagonal_step, row[:interlace.unit_bits]
    return sum(row << bit for bit in range(step.bit_length()) if step >> bit & 1)


def without(value: Value, mask: int) -> Value:
    """``value`` with the bits of ``mask`` left out, those above moved down."""
    return Cat(value[bit] for bit in range(len(value)) if not mask >> bit & 1)


def group_mask(interlace: Interlace) -> int:
    """The bits of the unit's number in which pixels side by side that are fetched together are the
    same."""
    inside = [axis == "x" and bit < interlace.group_bits
              for axis, bit in reversed(interlace.bit_order)]
    return sum((not bit) << place for place, bit in enumerate(inside))


class PixelAddress(wiring.Component):
    """Where a pixel lies in the memory units.  Combinational.

    Members
    -------
    total: In(id_bits)
        Number of memory units, from the total-units lines.
    x, y: In
        A pixel at the machine's own resolution.
    unit: Out(id_bits)
        Number of the unit that holds it.
    address: Out(address_bits)
        Its word there.  Both are 0 while ``total`` is no supported number.
    last_word: Out(address_bits)
        The last of the words of each unit that hold the picture.
    width: Out(x_bits)
        Columns of the picture.
    """

    def __init__(self, *, configuration: MachineConfiguration):
        self.configuration = configuration
        super().__init__({
            "total": In(configuration.id_bits),
            "x": In(configuration.x_bits),
            "y": In(configuration.y_bits),
            "unit": Out(configuration.id_bits),
            "address": Out(configuration.address_bits),
            "last_word": Out(configuration.address_bits),
            "width": Out(configuration.x_bits),
        })

    def elaborate(self, platform):
        m = Module()
        interlaces = self.configuration.interlaces()
        # Rows whose words are a power of two lie side by side without arithmetic.
        aligned = all(interlace.pitch.bit_count() == 1 for interlace in interlaces)
        row = Signal.like(self.y)
        column = Signal.like(self.x)
        # The one more makes no difference: where the largest is a power of two, all are, each the
        # half of another rounded up, and nobody reads it.
        pitch = Signal(range(max(interlace.pitch for interlace in interlaces) + 1))
        with m.Switch(self.total):
            for interlace in interlaces:
                with m.Case(interlace.units):
                    m.d.comb += [
                        self.unit.eq(unit_number(interlace, self.x, self.y)),
                        row.eq(without(self.y, interlace.unit_mask("y"))),
                        column.eq(without(self.x, interlace.unit_mask("x"))),
                        pitch.eq(interlace.pitch),
                        self.last_word.eq(interlace.words - 1),
                        self.width.eq(interlace.width),
                    ]
                    if aligned:
                        m.d.comb += self.address.eq(
                            Cat(column[:interlace.pitch.bit_length() - 1], row))
        if not aligned:
            m.d.comb += self.address.eq(row * pitch + column)
        return m


class ScanAddress(wiring.Component):
    """What a scan address means to one memory unit.  Combinational.

    Scan addresses are at the highest resolution; the low bits that this
    machine's picture does not have are ignored here, as the paper has it.

    Members
    -------
    total, id: In(id_bits)
        Number of memory units and this unit's own number.
    x, y: In
        Scan address.
    selected: Out(1)
        This unit holds the pixel.
    fetch: Out(1)
        The address is the first of a group of pixels that lie in different units, one of them in
        this unit: the time to read ``address`` for the whole group.
    address: Out(address_bits)
        This unit's word of that group.
    """

    def __init__(self, *, configuration: MachineConfiguration):
        self.configuration = configuration
        super().__init__({
            "total": In(configuration.id_bits),
            "id": In(configuration.id_bits),
            "x": In(configuration.x_bits),
            "y": In(configuration.y_bits),
            "selected": Out(1),
            "fetch": Out(1),
            "address": Out(configuration.address_bits),
        })

    def elaborate(self, platform):
        m = Module()
        m.submodules.pixel = pixel = PixelAddress(configuration=self.configuration)
        m.d.comb += [
            pixel.total.eq(self.total),
            self.selected.eq(pixel.unit == self.id),
            self.address.eq(pixel.address),
        ]
        with m.Switch(self.total):
            for interlace in self.configuration.interlaces():
                groups = group_mask(interlace)
                group_bits = interlace.x_shift + interlace.group_bits
                with m.Case(interlace.units):
                    m.d.comb += [
                        pixel.x.eq(self.x >> interlace.x_shift),
                        pixel.y.eq(self.y >> interlace.y_shift),
                        self.fetch.eq((self.x[:group_bits] == 0)
                                      & (((pixel.unit ^ self.id) & groups) == 0)),
                    ]
        return m
