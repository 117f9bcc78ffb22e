"""The pixels that one processing element owns: a regular lattice of squares (figure 13)."""

from amaranth.hdl import *
from amaranth.lib import data

from ..golden.specification.configuration import MachineConfiguration

__all__ = ["first_owned", "lattice_layout", "next_owned", "row_offset", "rows_mask"]


def lattice_layout(configuration: MachineConfiguration) -> data.StructLayout:
    """Which columns and rows belong to a block of units, counted in interlaced squares.

    ``x_offset``, ``y_offset``  the first square's column and row
    ``x_mask``, ``y_mask``      the distance between neighbouring squares, a power of two, less 1
    ``shifted``                 every other row is shifted by half of it; only in skewed machines
    """
    interlaces = configuration.interlaces()
    strides = [interlace.stride_bits(bits) for interlace in interlaces
               for bits in range(interlace.share_bits, interlace.unit_bits + 1)]
    x_bits, y_bits = map(max, zip(*strides, strict=True))
    return data.StructLayout({
        "x_offset": x_bits, "y_offset": y_bits, "x_mask": x_bits, "y_mask": y_bits,
        **({"shifted": 1} if configuration.skew else {}),
    })


def row_offset(lattice: data.View, y: Value, configuration: MachineConfiguration) -> Value:
    """Of an owned row, the first owned square's column."""
    if not configuration.skew:
        return lattice.x_offset
    # Both distances are powers of two.
    further = lattice.shifted & (y & (lattice.y_mask + 1)).any()
    return lattice.x_offset ^ Mux(further, lattice.x_mask ^ rows_mask(lattice, configuration), 0)


def rows_mask(lattice: data.View, configuration: MachineConfiguration) -> Value:
    """As ``x_mask``, of the owned squares of all rows together."""
    if not configuration.skew:
        return lattice.x_mask
    return Mux(lattice.shifted, lattice.x_mask >> 1, lattice.x_mask)


def first_owned(position: Value, offset: Value, mask: Value, square_bits: int) -> Value:
    """The first owned column (or row) from ``position`` on; squares are ``2**square_bits`` wide."""
    square = position >> square_bits
    ahead = (offset - square)[:max(1, len(mask))] & mask
    return Mux(ahead == 0, position, (square + ahead) << square_bits)


def next_owned(position: Value, mask: Value, square_bits: int) -> Value:
    """The owned row after the owned row ``position``: the next one, or past other squares."""
    after = position + 1
    return after + Mux(after[:square_bits] == 0, mask << square_bits, 0)
