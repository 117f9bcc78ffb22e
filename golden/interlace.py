"""Which memory unit holds a pixel, and at which address (Fuchs & Johnson, figures 13 and 14).

Neighbouring pixels lie in different units.  With ``2**n`` units the low
``x_unit_bits`` bits of x and the low ``y_unit_bits`` bits of y name the unit;
y has the extra bit where n is odd, so that eight units hold pixels 2 apart in
x and 4 in y, as in the paper.  The *most* significant bit of the unit number
is the *least* significant bit of x, the next one that of y, and so on: a
processing element owns consecutive numbers, and so the processing elements
interlace finely and a power-of-two share is itself a regular lattice.

Inside a unit the pixels lie row after row, ``pitch`` words to a row.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TypeVar

import numpy as np
from numpy.typing import NDArray

Coordinate = TypeVar("Coordinate", int, NDArray[np.int64])


def _ceil_shift(value: int, bits: int) -> int:
    return -(-value >> bits)


@dataclass(frozen=True)
class Interlace:
    """The bijection pixel ↔ (unit, address) of a machine of ``2**unit_bits`` units.

    ``width``, ``height``: the machine's own resolution; ``x_shift``, ``y_shift``: the low bits
    of a highest-resolution address that do not exist in it.
    """

    unit_bits: int
    width: int
    height: int
    x_shift: int = 0
    y_shift: int = 0

    @property
    def units(self) -> int:
        return 1 << self.unit_bits

    @property
    def x_unit_bits(self) -> int:
        return self.unit_bits // 2

    @property
    def y_unit_bits(self) -> int:
        return self.unit_bits - self.x_unit_bits

    @property
    def pitch(self) -> int:
        """Words a row takes in each unit; also the scan reads per unit and line, at worst."""
        return _ceil_shift(self.width, self.x_unit_bits)

    @property
    def rows(self) -> int:
        return _ceil_shift(self.height, self.y_unit_bits)

    @property
    def words(self) -> int:
        """Words of each unit that hold the picture."""
        return self.pitch * self.rows

    @property
    def bit_order(self) -> tuple[tuple[str, int], ...]:
        """Source of each bit of the unit number, most significant first: ``("x", 0)`` is x's
        least significant bit."""
        pairs = [pair for bit in range(self.x_unit_bits) for pair in (("x", bit), ("y", bit))]
        if self.unit_bits % 2:
            pairs.append(("y", self.x_unit_bits))
        return tuple(pairs)

    def stride_bits(self, block_bits: int) -> tuple[int, int]:
        """Log2 of the distance in x and in y between neighbouring pixels of an aligned block of
        ``2**block_bits`` units."""
        fixed = [axis for axis, _ in self.bit_order[: self.unit_bits - block_bits]]
        return fixed.count("x"), fixed.count("y")

    def unit(self, x: Coordinate, y: Coordinate) -> Coordinate:
        number = x * 0
        for axis, bit in self.bit_order:
            number = number * 2 + (((x if axis == "x" else y) >> bit) & 1)
        return number

    def address(self, x: Coordinate, y: Coordinate) -> Coordinate:
        return (y >> self.y_unit_bits) * self.pitch + (x >> self.x_unit_bits)

    def pixel(self, unit: Coordinate, address: Coordinate) -> tuple[Coordinate, Coordinate]:
        """The inverse of ``unit`` and ``address``; padding words give pixels off the picture."""
        x = (address % self.pitch) << self.x_unit_bits
        y = (address // self.pitch) << self.y_unit_bits
        for place, (axis, bit) in enumerate(reversed(self.bit_order)):
            value = ((unit >> place) & 1) << bit
            if axis == "x":
                x = x | value
            else:
                y = y | value
        return x, y


def interlace_for(width: int, height: int, *, words: int, units: int) -> Interlace:
    """The interlace of ``units`` units (a power of two) of ``words`` words each.

    Where the memory does not hold ``width`` × ``height``, the picture is halved, y first, then
    x, until it fits: the machine's low address bits do not exist.
    """
    if units < 1 or units & (units - 1):
        raise ValueError(f"units must be a power of two, not {units}")
    if words < 1:
        raise ValueError(f"words must be positive, not {words}")
    x_shift = y_shift = 0
    while True:
        interlace = Interlace(
            unit_bits=units.bit_length() - 1,
            width=_ceil_shift(width, x_shift),
            height=_ceil_shift(height, y_shift),
            x_shift=x_shift,
            y_shift=y_shift,
        )
        if interlace.words <= words:
            return interlace
        if y_shift == x_shift:
            y_shift += 1
        else:
            x_shift += 1
