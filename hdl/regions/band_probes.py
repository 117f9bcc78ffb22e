"""The rows that tell how far a large triangle reaches in each row of regions."""

from amaranth.hdl import *
from amaranth.lib import stream, wiring
from amaranth.lib.wiring import In, Out

from ...golden.specification.configuration import MachineConfiguration
from ..backplane.region_lines import RegionLines
from ..backplane.words import outline_layout
from ..rasteriser.triangle_rows import row_layout
from .own_columns import OwnColumns
from .region_box import band_rows, cut, region_box

__all__ = ["BandProbes"]


class BandProbes(wiring.Component):
    """A triangle in, of each row of regions of its box, a *band*, two rows of pixels or four.

    Columns of an edge only grow or only fall from row to row.  So the triangle reaches furthest
    either way in the band's first row, in its last one, or, where the middle vertex lies between,
    in the last row above that or in the first one below.

    Bands that certainly have no region of the processing element's own in the columns of the box
    are passed over: those where all of its regions lie left of the box, or all right of it.

    Latency: ``latency`` clocks from ``begin`` to the first row.  Throughput: a row a clock, band
    after band; a band that is passed over costs one, too.

    Members
    -------
    regions: In(RegionLines), element: In(element_bits)
        The tables, and the number that the processing element has in these.
    outline: In(outline_layout)
        Holds from ``begin`` until ``busy`` is low; ``top`` above ``bottom``.
    begin: In(1)
        Begin; only while not ``busy``.
    rows: Out(stream of row_layout)
        ``last`` with the last one of each band; ``y`` is its row, ``left`` and ``region`` are not
        driven.
    busy: Out(1)
        From the clock after ``begin`` until no row is left.
    """

    latency = 2

    def __init__(self, *, configuration: MachineConfiguration):
        self.configuration = configuration
        super().__init__({
            "regions": In(RegionLines(configuration)),
            "element": In(configuration.element_bits),
            "outline": In(outline_layout(configuration)),
            "begin": In(1),
            "rows": Out(stream.Signature(row_layout(configuration))),
            "busy": Out(1),
        })

    def elaborate(self, platform):
        m = Module()
        configuration, outline, row = self.configuration, self.outline, self.rows.payload
        m.submodules.own_columns = own = OwnColumns(configuration=configuration)
        wiring.connect(m, wiring.flipped(self.regions), own.regions)
        box = region_box(outline, configuration)
        bits, inside = len(self.regions.row), configuration.dealt_regions.y_bits

        going = Signal()
        band = Signal(bits)
        following = Signal(bits)
        step = Signal(2)  # 0 first row, 1 above the middle, 2 below it, 3 last row
        in_box, sends, passes = Signal(), Signal(), Signal()
        # From here to what is sent is a long way, so this is ready before it begins.
        bottom = Signal(configuration.y_bits, reset_less=True)
        first, last = band_rows(band, outline.top, bottom, configuration)
        m.d.comb += [
            own.element.eq(self.element),
            # Of a box that reaches beyond the last column all bits count.
            in_box.eq(own.some & (own.first <= box.right) & (own.last >= box.left)),
            sends.eq(going & in_box & (~self.rows.valid | self.rows.ready)),
            passes.eq(going & (~in_box | (sends & (step == 3)))),
            following.eq(Mux(going, band + 1, cut(box.top, bits))),
            own.ask.eq(self.begin | passes),
            own.row.eq(following),
            self.busy.eq(going | self.rows.valid),
        ]
        with m.If(self.begin | passes):
            m.d.sync += band.eq(following)
        with m.If(self.begin):
            m.d.sync += [going.eq(1), bottom.eq(outline.bottom - 1)]
        with m.Elif(passes & (band == cut(bottom[inside:], bits))):
            m.d.sync += going.eq(0)
        with m.If(sends):
            m.d.sync += step.eq(step + 1)
            with m.If((step == 0) & ((outline.middle <= first) | (outline.middle > last))):
                m.d.sync += step.eq(3)

        y = Signal(configuration.y_bits)
        above = Signal()
        with m.Switch(step):
            with m.Case(0):
                m.d.comb += y.eq(first)
            with m.Case(1):
                m.d.comb += y.eq(outline.middle - 1)
            with m.Case(2):
                m.d.comb += y.eq(outline.middle)
            with m.Case(3):
                m.d.comb += y.eq(last)
        in_upper = y < outline.middle
        with m.If(~self.rows.valid | self.rows.ready):
            m.d.sync += [
                self.rows.valid.eq(sends),
                above.eq(in_upper),
                row.y.eq(y),
                row.rows.eq(y - outline.top),
                row.short_rows.eq(Mux(in_upper, y - outline.top, y - outline.middle)),
                row.last.eq(step == 3),
            ]
        m.d.comb += [
            row.long_edge_left.eq(outline.long_edge_left),
            row.long.eq(outline.long),
            row.short.eq(Mux(above, outline.upper, outline.lower)),
        ]
        return m
