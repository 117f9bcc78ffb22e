"""Which memory unit holds a pixel, and at which address (Fuchs & Johnson, figures 13 and 14).

Neighbouring pixels lie in different units.  With ``2**n`` units some n bits of x
and y name the unit; y has the extra bit where n is odd, so that eight units hold
pixels 2 apart in x and 4 in y, as in the paper.  The *most* significant bit of the
unit number is the *least* significant bit of x, the next one that of y, and so on:
a processing element owns consecutive numbers, and so the processing elements
interlace finely and a power-of-two share is itself a regular lattice.

Where processing elements interlace in squares, of ``2**square_bits`` pixels a side,
the bits of x and y above those inside a square name the processing element; the
units of one, ``2**share_bits``, still interlace pixel by pixel, inside its squares.

Where they interlace in lines, as Blazek's scan lines do (1991), the low bits of y are the number
of the processing element: of n elements element i has the lines i, n + i, 2n + i and so on.
Its units interlace along each line, by the low bits of x.

The least significant bit of the number is one of y, so two units of a processing
element have its rows in turn.  Skewed, the bit is that one xor the lowest bit of x
that names no unit: they alternate along each row too, and the pixels of one of them
are a lattice of which every other row is shifted by half its distance in x.

Diagonally, for processing elements that each draw any pixel, n units hold n pixels side
by side, and each row has the units of the row above moved along by ``diagonal_step``:
unit = (x + step · y) mod n.  So elements that walk the rows of like triangles at the same
time seldom need the same unit.

Inside a unit the pixels lie row after row, ``pitch`` words to a row; the bits of x
and y that name the unit are left out.
"""

from __future__ import annotations

from collections.abc import Set
from dataclasses import dataclass
from typing import TypeVar

import numpy as np
from numpy.typing import NDArray

from .errors import InputError
from .regions import MAXIMUM_REGIONS

MAXIMUM_BLOCK = 32

Coordinate = TypeVar("Coordinate", int, NDArray[np.int64])


def _ceil_shift(value: int, bits: int) -> int:
    return -(-value >> bits)


@dataclass(frozen=True)
class Interlace:
    """The bijection pixel ↔ (unit, address) of a machine of ``2**unit_bits`` units.

    ``width``, ``height``: the machine's own resolution; ``x_shift``, ``y_shift``: the low bits
    of a highest-resolution address that do not exist in it.  ``square_bits``: log2 of the side of
    the squares in which processing elements interlace, of ``2**share_bits`` units each; both 0
    where all units interlace pixel by pixel, whomever they belong to.  ``skew``: the last bit of
    the number is skewed; not in squares.  ``diagonal``: none of these; each row begins at another
    unit.  ``lines``: processing elements of ``2**share_bits`` units have lines in turn.

    Raises ``ValueError`` where there are fewer units than in a share, or fewer pixels in a square,
    or squares are to be skewed, or either is to be diagonal, or any of these is to be in lines.
    """

    unit_bits: int
    width: int
    height: int
    x_shift: int = 0
    y_shift: int = 0
    square_bits: int = 0
    share_bits: int = 0
    skew: bool = False
    diagonal: bool = False
    lines: bool = False

    def __post_init__(self) -> None:
        most = self.unit_bits if self.lines else min(self.unit_bits, 2 * self.square_bits)
        if not 0 <= self.share_bits <= most:
            raise ValueError(f"share_bits must be 0 to {most}, not {self.share_bits}")
        if self.skew and self.square_bits:
            raise ValueError("skew wants square_bits 0: in squares units alternate along x already")
        if self.diagonal and (self.square_bits or self.skew):
            raise ValueError("diagonal wants neither skew nor squares")
        if self.lines and (self.square_bits or self.skew or self.diagonal):
            raise ValueError("lines want neither squares nor skew nor diagonal")

    @property
    def units(self) -> int:
        return 1 << self.unit_bits

    @property
    def bit_order(self) -> tuple[tuple[str, int], ...]:
        """Source of each bit of the unit number, most significant first: ``("x", 0)`` is x's
        least significant bit.  ``skew_bit`` changes the last, ``diagonal_step`` adds to all."""
        if self.diagonal:
            return tuple(("x", bit) for bit in reversed(range(self.unit_bits)))
        lattice_bits = self.unit_bits - self.share_bits
        if self.lines:
            return (*(("y", bit) for bit in reversed(range(lattice_bits))),
                    *(("x", bit) for bit in reversed(range(self.share_bits))))
        order = [("xy"[place % 2], self.square_bits + place // 2) for place in range(lattice_bits)]
        if lattice_bits % 2:
            order[-1] = ("y", order[-1][1])
        inside = [("xy"[place % 2], place // 2) for place in range(self.share_bits)]
        return (*order, *inside)

    @property
    def skew_bit(self) -> int | None:
        """The bit of x that is added (xor) to the last bit of the unit number; None adds none."""
        return self.x_unit_bits if self.skew and self.unit_bits else None

    @property
    def diagonal_step(self) -> int:
        """Units by which each row is moved from the one above: an odd number near 5/8 of all, with
        which small triangles seldom meet (``docs/organisations.md``)."""
        return (5 * self.units // 8) | 1 if self.diagonal else 0

    @property
    def x_unit_bits(self) -> int:
        return self.unit_mask("x").bit_count()

    @property
    def y_unit_bits(self) -> int:
        return self.unit_mask("y").bit_count()

    def unit_mask(self, axis: str) -> int:
        """The bits of ``"x"`` or ``"y"`` that name the unit."""
        return sum(1 << bit for name, bit in self.bit_order if name == axis)

    @property
    def group_bits(self) -> int:
        """Log2 of how many pixels side by side lie in different units, at every such place: a
        unit that has one of them reads it for the scan as they begin."""
        mask = self.unit_mask("x")
        return (~mask & (mask + 1)).bit_length() - 1

    @property
    def pitch(self) -> int:
        """Words a row takes in each unit; two rows share them where they are skewed."""
        return _extent(self.width, self.unit_mask("x"))

    @property
    def scan_reads(self) -> int:
        """Scan reads per unit and line, at worst."""
        skewed = 0 if self.skew_bit is None else 1 << self.skew_bit
        return _extent(self.width, self.unit_mask("x") | skewed)

    @property
    def tile(self) -> NDArray[np.int64]:
        """int64 (rows, columns): the unit of each pixel of a piece that repeats over the
        picture."""
        columns = 1 << max((self.skew_bit or 0) + 1, self.unit_mask("x").bit_length())
        rows = self.units if self.diagonal else 1 << self.unit_mask("y").bit_length()
        y, x = np.mgrid[:rows, :columns]
        return np.asarray(self.unit(x, y))

    @property
    def rows(self) -> int:
        return _extent(self.height, self.unit_mask("y"))

    @property
    def words(self) -> int:
        """Words of each unit that hold the picture."""
        return self.pitch * self.rows

    def stride_bits(self, unit_block_bits: int) -> tuple[int, int]:
        """Log2 of the distance in x and in y between neighbouring squares of an aligned block of
        ``2**unit_block_bits`` units, a whole share at least; a distance of 1 is that of squares
        side by side.  Where the block is ``shifted`` the one in y is that of neighbouring rows."""
        fixed = [axis for axis, _ in self.bit_order[: self.unit_bits - unit_block_bits]]
        shifted = self.shifted(unit_block_bits)
        return fixed.count("x") + shifted, fixed.count("y") - shifted

    def shifted(self, unit_block_bits: int) -> bool:
        """Every other row of an aligned block of ``2**unit_block_bits`` units is shifted by half
        the distance in x."""
        return self.skew_bit is not None and unit_block_bits == 0

    def unit(self, x: Coordinate, y: Coordinate) -> Coordinate:
        number = x * 0
        for axis, bit in self.bit_order:
            number = number * 2 + (((x if axis == "x" else y) >> bit) & 1)
        return ((number ^ self._skewed(x)) + self.diagonal_step * y) & (self.units - 1)

    def address(self, x: Coordinate, y: Coordinate) -> Coordinate:
        return (_without(y, self.unit_mask("y")) * self.pitch
                + _without(x, self.unit_mask("x")))

    def pixel(self, unit: Coordinate, address: Coordinate) -> tuple[Coordinate, Coordinate]:
        """The inverse of ``unit`` and ``address``; padding words give pixels off the picture."""
        x = _with_gaps(address % self.pitch, self.unit_mask("x"))
        y = _with_gaps(address // self.pitch, self.unit_mask("y"))
        unit = ((unit - self.diagonal_step * y) & (self.units - 1)) ^ self._skewed(x)
        for place, (axis, bit) in enumerate(reversed(self.bit_order)):
            value = ((unit >> place) & 1) << bit
            if axis == "x":
                x = x | value
            else:
                y = y | value
        return x, y

    def _skewed(self, x: Coordinate) -> Coordinate:
        return x * 0 if self.skew_bit is None else (x >> self.skew_bit) & 1


def _without(value: Coordinate, mask: int) -> Coordinate:
    """``value`` with the bits of ``mask`` left out, those above moved down."""
    for bit in reversed(range(mask.bit_length())):
        if mask >> bit & 1:
            value = (value >> (bit + 1) << bit) | (value & ((1 << bit) - 1))
    return value


def _with_gaps(value: Coordinate, mask: int) -> Coordinate:
    """The inverse of ``_without``: zeros in the places of ``mask``."""
    for bit in range(mask.bit_length()):
        if mask >> bit & 1:
            value = (value >> bit << (bit + 1)) | (value & ((1 << bit) - 1))
    return value


def _extent(size: int, mask: int) -> int:
    """How many different values ``_without`` gives for 0 … size - 1: they leave none out."""
    last = size - 1
    # Where a bit of the mask is set there is a smaller number without it, all ones below.
    last |= (1 << (last & mask).bit_length()) - 1
    return _without(last, mask) + 1


def interlace_for(width: int, height: int, *, words: int, units: int, square_bits: int = 0,
                  share_bits: int = 0, skew: bool = False, diagonal: bool = False,
                  lines: bool = False) -> Interlace:
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
            square_bits=square_bits,
            share_bits=share_bits,
            skew=skew,
            diagonal=diagonal,
            lines=lines,
        )
        if interlace.words <= words:
            return interlace
        if y_shift == x_shift:
            y_shift += 1
        else:
            x_shift += 1


def check_squares(block: int, shares: Set[int], *, skew: bool, orphans: bool) -> None:
    """Raise ``InputError`` unless squares of ``block`` pixels a side spread over processing
    elements with so many memory units each; ``orphans``: boards may have been pulled out."""
    if block & (block - 1):
        raise InputError(f"block: must be a power of two, such as 1, 4 or {MAXIMUM_BLOCK}, not "
                         f"{block}")
    if block == 1:
        return
    if skew:
        raise InputError(f"skew: in squares of {block}x{block} pixels units alternate along the "
                         "rows already; leave it out, or interlace pixel by pixel (block 1)")
    squares = f"block: squares of {block}x{block} pixels"
    if len(shares) > 1 and not orphans:
        raise InputError(f"{squares} want as many memory units behind each processing element, not "
                         f"{' and '.join(map(str, sorted(shares)))}; change the cards, or "
                         "interlace pixel by pixel (1)")
    share_bits = max({1, *shares}).bit_length() - 1
    if 1 << share_bits > block * block:
        raise InputError(f"{squares} do not spread over {1 << share_bits} memory units; make them "
                         "larger, or interlace pixel by pixel (1)")


def check_lines(elements: int, shares: Set[int], height: int, *, block: int, skew: bool,
                orphans: bool) -> None:
    """Raise ``InputError`` unless so many processing elements, with so many memory units each, can
    have the lines of a picture of ``height`` in turn; ``orphans``: boards may have been pulled
    out."""
    for name, asked in (("block", block > 1), ("skew", skew)):
        if asked:
            raise InputError(f"{name}: processing elements that have lines in turn interlace "
                             "neither in squares nor skewed; leave it out, or leave out lines")
    if orphans:
        return
    if len(shares) > 1:
        raise InputError("lines: processing elements that have lines in turn want as many memory "
                         f"units each, not {' and '.join(map(str, sorted(shares)))}; change the "
                         "cards, or leave out lines")
    if elements & (elements - 1):
        lower = 1 << (elements.bit_length() - 1)
        raise InputError(f"lines: {elements} processing elements cannot have lines in turn; take a "
                         f"power of two, such as {lower} or {2 * lower}" + (
                             "" if height > MAXIMUM_REGIONS else
                             "; or, in place of lines, regions of one line each, which are dealt "
                             f"to any number of them, as with --regions 1x{height}"))


def check_diagonal(block: int, *, skew: bool, lines: bool) -> None:
    """Raise ``InputError`` where units that interlace diagonally are to do so in another way."""
    for name, asked in (("block", block > 1), ("skew", skew), ("lines", lines)):
        if asked:
            raise InputError(f"{name}: behind a direct merge memory units interlace diagonally; "
                             "leave it out")
