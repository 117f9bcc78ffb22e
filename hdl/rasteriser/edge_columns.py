"""Where each row of a triangle begins and ends."""

from amaranth.hdl import *
from amaranth.lib import data, stream, wiring
from amaranth.lib.wiring import In, Out

from ...golden.specification.configuration import MachineConfiguration
from ..arithmetic.delay import delayed
from ..arithmetic.limb_products import limb_products, side_by_side
from .triangle_rows import row_layout

__all__ = ["EdgeColumns", "extent_layout"]

def extent_layout(configuration: MachineConfiguration) -> data.StructLayout:
    """Columns ``first`` up to, without, ``beyond`` of row ``y``, held to the screen; maybe none.

    The other fields are as in ``row_layout``.
    """
    row = row_layout(configuration)
    return data.StructLayout({
        "first": configuration.x_bits,
        "beyond": configuration.x_bits,
        **{name: row.members[name] for name in _passed_on(configuration)},
    })


def _passed_on(configuration: MachineConfiguration) -> tuple[str, ...]:
    """Fields of a row that say nothing of its ends."""
    owned = "lattice" if configuration.regions is None else "region"
    return "y", "rows", "left", "none", "last", owned


class EdgeColumns(wiring.Component):
    """start + rows · step of both edges that bound a row, in fixed point, and exact.

    The words have as many fraction bits as make the column exact on each row
    (``golden.reference.triangle_setup.carry_edges``), so a row may follow any other, and no edge
    has to be stepped.  Left of the screen becomes its first column, right of it the
    column after its last, where the words have the bits for that.  So whatever the words are,
    no extent leaves the screen.

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

        for name in _passed_on(self.configuration):
            value = delayed(m, row[name], self.latency - 1, name, enable=move)
            with m.If(move):
                m.d.sync += extent[name].eq(value)

        columns = {name: self._column(m, row[name], count, move, name) for name, count in (
            ("long", row.rows), ("short", row.short_rows))}
        long_left = delayed(m, row.long_edge_left, self.latency - 1, "long_edge_left",
                            enable=move)
        left = Mux(long_left, columns["long"], columns["short"])
        right = Mux(long_left, columns["short"], columns["long"])
        with m.If(move):
            m.d.sync += [extent.first.eq(self._held(left)), extent.beyond.eq(self._held(right))]
        return m

    def _column(self, m, edge, rows, move, name):
        """The edge's column, three moves later: products, then two sums."""
        words = side_by_side(limb_products(m, edge.step, rows, advance=move,
                                           name=f"{name}_product"))
        start = delayed(m, edge.start, 1, f"{name}_start", enable=move)
        word_bits = self.configuration.edge_word_bits
        first = Signal(word_bits, name=f"{name}_first", reset_less=True)
        total = Signal(word_bits, name=f"{name}_total", reset_less=True)
        others = [delayed(m, word, 1, f"{name}_odd", enable=move) for word in words[1:]]
        with m.If(move):
            m.d.sync += [first.eq(start + words[0]), total.eq(sum(others, first))]
        column = total[self.configuration.edge_fraction_bits:]
        return column if self.configuration.edges_on_screen else column.as_signed()

    def _held(self, column):
        widths = {picture.width for picture in self.configuration.pictures()}
        if self.configuration.edges_on_screen and 1 << len(column) <= min(widths):
            return column
        width = Const(widths.pop()) if len(widths) == 1 else self.width
        # Both ends are what is held to them: < or <= 0, >= or > width are the same.
        if self.configuration.edges_on_screen:
            return Mux(column >= width, width, column)
        magnitude = column.as_unsigned()[:-1]
        return Mux(column < 0, 0, Mux(magnitude >= width, width, magnitude))
