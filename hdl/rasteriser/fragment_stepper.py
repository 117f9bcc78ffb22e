"""Steps along a span: one pixel after the other."""

from amaranth.hdl import *
from amaranth.lib import data, stream, wiring
from amaranth.lib.wiring import In, Out

from ...golden.specification.configuration import MachineConfiguration
from ..backplane.words import span_layout

__all__ = ["FragmentStepper", "pixel_layout"]


def pixel_layout(configuration: MachineConfiguration) -> data.StructLayout:
    """One pixel of one triangle.

    ``x``, ``y``              at the machine's resolution
    ``x_steps``, ``y_steps``  columns and rows from the triangle's origin to it
    ``none``                  no pixel at all: the triangle has no more
    ``last``                  nothing of the triangle follows
    ``slot``                  where its region lies; only where regions are dealt out
    """
    return data.StructLayout({
        "x": unsigned(configuration.x_bits),
        "y": unsigned(configuration.y_bits),
        "x_steps": range(configuration.width),
        "y_steps": range(configuration.height),
        "none": 1,
        "last": 1,
        **({} if configuration.regions is None else {"slot": configuration.table_bits}),
    })


class FragmentStepper(wiring.Component):
    """Spans in, their pixels out, left to right.

    Whatever the span, its pixels end: they go right by a stride, which is not 0, and whether the
    next one is past the end is found before the sum is cut to the bits of a column.

    Latency: ``latency`` clocks (span register, pixel register).  Throughput: a pixel
    a clock; the next span follows without a bubble.

    Members
    -------
    spans: In(stream of span_layout)
    pixels: Out(stream of pixel_layout)
    busy: Out(1)
        Holds a span or a pixel.

    Fuchs & Johnson, figure 13: the pixels of a row are a constant distance apart.
    """

    latency = 2

    def __init__(self, *, configuration: MachineConfiguration):
        self.configuration = configuration
        super().__init__({
            "spans": In(stream.Signature(span_layout(configuration))),
            "pixels": Out(stream.Signature(pixel_layout(configuration))),
            "busy": Out(1),
        })

    def elaborate(self, platform):
        m = Module()
        span = Signal(span_layout(self.configuration))
        holding = Signal()
        pixel = self.pixels.payload
        move = ~self.pixels.valid | self.pixels.ready
        dealt = self.configuration.regions is not None
        following = span.x + (1 if dealt else span.stride)
        ends = span.none | (following >= span.end)
        m.d.comb += [
            self.spans.ready.eq(~holding | (move & ends)),
            self.busy.eq(holding | self.pixels.valid),
        ]
        with m.If(move):
            m.d.sync += [
                self.pixels.valid.eq(holding),
                pixel.x.eq(span.x),
                pixel.y.eq(span.y),
                pixel.x_steps.eq(span.x - span.left),
                pixel.y_steps.eq(span.y_steps),
                pixel.none.eq(span.none),
                pixel.last.eq(span.last & ends),
                span.x.eq(following),
            ]
            if dealt:
                m.d.sync += pixel.slot.eq(span.slot)
        with m.If(self.spans.ready):
            m.d.sync += [span.eq(self.spans.payload), holding.eq(self.spans.valid)]
        return m
