"""The pixels that one processing element owns: a regular lattice of squares (figure 13)."""

from amaranth.hdl import *
from amaranth.lib import data

from ..golden.configuration import MachineConfiguration

__all__ = ["first_owned", "lattice_layout", "next_owned"]


def lattice_layout(configuration: MachineConfiguration) -> data.StructLayout:
    """Which columns and rows belong to a block of units, counted in interlaced squares.

    ``x_offset``, ``y_offset``  the first square's column and row
    ``x_mask``, ``y_mask``      the distance between neighbouring squares, a power of two, less 1
    ``x_stride_bits``           log2 of the distance in x
    """
    interlaces = configuration.interlaces()
    x_bits, y_bits = map(max, zip(*(interlace.stride_bits(interlace.share_bits)
                                    for interlace in interlaces), strict=True))
    return data.StructLayout({
        "x_offset": x_bits, "y_offset": y_bits, "x_mask": x_bits, "y_mask": y_bits,
        "x_stride_bits": range(x_bits + 1),
    })


def first_owned(position: Value, offset: Value, mask: Value, square_bits: int) -> Value:
    """The first owned column (or row) from ``position`` on; squares are ``2**square_bits`` wide."""
    square = position >> square_bits
    ahead = (offset - square)[:max(1, len(mask))] & mask
    return Mux(ahead == 0, position, (square + ahead) << square_bits)


def next_owned(position: Value, mask: Value, square_bits: int) -> Value:
    """The owned row after the owned row ``position``: the next one, or past other squares."""
    after = position + 1
    return after + Mux(after[:square_bits] == 0, mask << square_bits, 0)
