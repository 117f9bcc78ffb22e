"""The pixels that one processing element owns: a regular lattice of squares (figure 13)."""

from amaranth.hdl import *
from amaranth.lib import data, wiring
from amaranth.lib.wiring import In, Out

from ...golden.specification.configuration import MachineConfiguration

__all__ = [
    "LatticeBlock",
    "first_owned",
    "lattice_layout",
    "next_owned",
    "row_offset",
    "rows_mask",
]


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
    """The column of the first owned square in an owned row."""
    if not configuration.skew:
        return lattice.x_offset
    # Both distances are powers of two.
    further = lattice.shifted & (y & (lattice.y_mask + 1)).any()
    return lattice.x_offset ^ Mux(further, lattice.x_mask ^ rows_mask(lattice, configuration), 0)


def rows_mask(lattice: data.View, configuration: MachineConfiguration) -> Value:
    """What ``x_mask`` would be if a column that some row owns were owned in every row."""
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


class LatticeBlock(wiring.Component):
    """The largest aligned block of units at the start of a range of them.  Combinational.

    The pixels of an aligned power-of-two block of units form a regular lattice;
    a processing element walks its domain block by block (one, where the shares
    are equal powers of two).  In squares or lines a share is the only block; diagonally
    all units are, and all pixels theirs.  Skewed, every other row of a block of one unit is
    shifted.

    Members
    -------
    total: In(id_bits)
        Number of memory units.
    first, end: In(id_bits)
        The range of units, ``end`` excluded; not empty.
    after: Out(id_bits)
        First unit after the block.
    lattice: Out(lattice_layout)
        The pixels of the block.
    """

    def __init__(self, *, configuration: MachineConfiguration):
        self.configuration = configuration
        super().__init__({
            "total": In(configuration.id_bits),
            "first": In(configuration.id_bits),
            "end": In(configuration.id_bits),
            "after": Out(configuration.id_bits),
            "lattice": Out(lattice_layout(configuration)),
        })

    def elaborate(self, platform):
        m = Module()
        if self.configuration.merges_directly:
            m.d.comb += self.after.eq(self.end)
            return m
        shares = range(self.configuration.id_bits)
        if self.configuration.equal_shares:
            shares = (self.configuration.share_bits,)
        for unit_block_bits in shares:
            size = 1 << unit_block_bits
            aligned = self.first[:unit_block_bits] == 0
            with m.If(aligned & (self.first + size <= self.end)):
                m.d.comb += self.after.eq(self.first + size)
                with m.Switch(self.total):
                    for interlace in self.configuration.interlaces():
                        if unit_block_bits <= interlace.unit_bits:
                            x_stride, y_stride = interlace.stride_bits(unit_block_bits)
                            with m.Case(interlace.units):
                                m.d.comb += [self.lattice.x_mask.eq((1 << x_stride) - 1),
                                             self.lattice.y_mask.eq((1 << y_stride) - 1)]
                                if self.configuration.skew:
                                    m.d.comb += self.lattice.shifted.eq(
                                        interlace.shifted(unit_block_bits))
        with m.Switch(self.total):
            for interlace in self.configuration.interlaces():
                with m.Case(interlace.units):
                    sources = list(reversed(interlace.bit_order))
                    if interlace.skew_bit is not None:
                        # A block of one unit, whose rows are shifted: this is the offset of its
                        # rows with a 0 in the bit of y.  Larger blocks mask it out.
                        sources[0] = "x", interlace.skew_bit
                    for place, (axis, bit) in enumerate(sources):
                        offset = self.lattice.x_offset if axis == "x" else self.lattice.y_offset
                        if place >= interlace.share_bits:
                            m.d.comb += offset[bit - interlace.square_bits].eq(self.first[place])
        return m

