"""Where each row of a triangle begins and ends."""

from amaranth.hdl import *
from amaranth.lib import data, stream, wiring
from amaranth.lib.wiring import In, Out

from ..golden.configuration import MachineConfiguration
from .lattice import lattice_layout
from .row_walker import row_layout

__all__ = ["EdgeColumns", "extent_layout", "limbs"]

#: Operand bits of a multiplier block of an FPGA.
LIMB_BITS = 18


def extent_layout(configuration: MachineConfiguration) -> data.StructLayout:
    """Columns ``first`` up to, without, ``beyond`` of row ``y``, held to the screen; maybe none.

    The other fields as in ``row_walker.row_layout``.
    """
    row = row_layout(configuration)
    return data.StructLayout({
        "first": configuration.x_bits,
        "beyond": configuration.x_bits,
        **{name: row.members[name] for name in ("y", "rows", "left", "none", "last")},
        "lattice": lattice_layout(configuration),
    })


def limbs(m: Module, factor: Value, count: Value, *, advance: Value, name: str) -> list[Value]:
    """``factor`` · ``count`` as addends, from multipliers that end in registers.

    Products of every other limb do not overlap, so two addends hold them all.
    """
    products = []
    for offset in range(0, len(factor), LIMB_BITS):
        limb = factor[offset:offset + LIMB_BITS]
        product = Signal(len(limb) + len(count), name=f"{name}_{offset}", reset_less=True)
        with m.If(advance):
            m.d.sync += product.eq(limb * count)
        products.append((product, offset))
    addends = []
    for parity in (0, 1):
        addend = Signal(len(factor), name=f"{name}_addend_{parity}")
        place = 0
        parts = []
        for product, offset in products[parity::2]:
            parts += [Const(0, offset - place), product]
            place = offset + len(product)
        if parts:
            m.d.comb += addend.eq(Cat(*parts))
            addends.append(addend)
    return addends


class EdgeColumns(wiring.Component):
    """start + rows · step of both edges that bound a row, in fixed point, and exact.

    The words have as many fraction bits as make the column exact on each row
    (``golden.setup.carry_edges``), so a row may follow any other, and no edge has
    to be stepped.  Left of the screen becomes its first column, right of it the
    column after its last.

    Latency: ``latency`` clocks.  Throughput: a row a clock.  All stages move together.

    Members
    -------
    width: In(x_bits)
        Columns of the picture, at the machine's resolution.
    rows: In(stream of row_layout)
    extents: Out(stream of extent_layout)
    busy: Out(1)
        Holds a row.

    Fuchs & Johnson, figure 13 and the text around it.
    """

    latency = 4

    def __init__(self, *, configuration: MachineConfiguration):
        self.configuration = configuration
        super().__init__({
            "width": In(configuration.x_bits),
            "rows": In(stream.Signature(row_layout(configuration))),
            "extents": Out(stream.Signature(extent_layout(configuration))),
            "busy": Out(1),
        })

    def elaborate(self, platform):
        m = Module()
        row, extent = self.rows.payload, self.extents.payload
        move = Signal()
        stages = Signal(self.latency)
        m.d.comb += [
            move.eq(~self.extents.valid | self.extents.ready),
            self.rows.ready.eq(move),
            self.extents.valid.eq(stages[-1]),
            self.busy.eq(stages.any()),
        ]
        with m.If(move):
            m.d.sync += stages.eq(Cat(self.rows.valid, stages))

        def delayed(value, clocks, name):
            """The field as it was so many moves ago."""
            for stage in range(clocks):
                later = Signal.like(value, name=f"{name}_{stage + 1}", reset_less=True)
                with m.If(move):
                    m.d.sync += later.eq(value)
                value = later
            return value

        for name in ("y", "rows", "left", "none", "last", "lattice"):
            value = delayed(row[name], self.latency - 1, name)
            with m.If(move):
                m.d.sync += extent[name].eq(value)

        columns = {name: self._column(m, row[name], count, move, name) for name, count in (
            ("long", row.rows), ("short", row.short_rows))}
        long_left = delayed(row.long_edge_left, self.latency - 1, "long_edge_left")
        left = Mux(long_left, columns["long"], columns["short"])
        right = Mux(long_left, columns["short"], columns["long"])
        with m.If(move):
            m.d.sync += [extent.first.eq(self._held(left)), extent.beyond.eq(self._held(right))]
        return m

    def _column(self, m, edge, rows, move, name):
        """The edge's column, three moves later: products, then two sums."""
        addends = limbs(m, edge.step, rows, advance=move, name=f"{name}_product")
        start, first, total = (Signal(self.configuration.edge_word_bits, name=f"{name}_{part}",
                                      reset_less=True) for part in ("start", "first", "total"))
        rest = Signal.like(total, name=f"{name}_rest", reset_less=True)
        with m.If(move):
            m.d.sync += [
                start.eq(edge.start),
                first.eq(start + addends[0]),
                rest.eq(addends[1] if len(addends) > 1 else 0),
                total.eq(first + rest),
            ]
        return total[self.configuration.edge_fraction_bits:].as_signed()

    def _held(self, column):
        return Mux(column < 0, 0, Mux(column >= self.width, self.width, column))
