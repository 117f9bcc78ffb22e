"""Steps along a span: one fragment after the other."""

from amaranth.hdl import *
from amaranth.lib import data, stream, wiring
from amaranth.lib.wiring import In, Out

from ..golden import commands
from ..golden.configuration import CHANNEL_BITS, MachineConfiguration
from .fixed import floor_shift, saturate, to_signed
from .interlace import PixelAddress
from .span_start import started_span_layout

__all__ = ["FragmentStepper", "fragment_layout"]


def fragment_layout(configuration: MachineConfiguration) -> data.StructLayout:
    """One pixel of one primitive, as it meets the memory."""
    return data.StructLayout({
        "unit": unsigned(configuration.id_bits),
        "address": unsigned(configuration.address_bits),
        "depth": unsigned(configuration.depth_bits),
        "color": unsigned(3 * CHANNEL_BITS),
    })


class FragmentStepper(wiring.Component):
    """Spans in, their fragments out, left to right.

    The value at each pixel is floored, read as signed and saturated: depth to
    the greatest a vertex may have, so that every fragment is nearer than the
    background, channels to their eight bits.

    Latency: two clocks (span register, fragment register).  Throughput: a
    fragment a clock; the next span follows without a bubble.

    Members
    -------
    total: In(id_bits)
    started: In(stream of started_span_layout)
    fragments: Out(stream of fragment_layout)
    busy: Out(1)
        Holds a span or a fragment.

    Fuchs & Johnson, figure 13: rapid incremental computation of Z, and eventually of RGB.
    """

    latency = 2

    def __init__(self, *, configuration: MachineConfiguration):
        self.configuration = configuration
        super().__init__({
            "total": In(configuration.id_bits),
            "started": In(stream.Signature(started_span_layout(configuration))),
            "fragments": Out(stream.Signature(fragment_layout(configuration))),
            "busy": Out(1),
        })

    def elaborate(self, platform):
        m = Module()
        configuration = self.configuration
        span = Signal(started_span_layout(configuration))
        holding = Signal()
        fragment = self.fragments.payload
        m.submodules.pixel = pixel = PixelAddress(configuration=configuration)
        m.d.comb += [pixel.total.eq(self.total), pixel.x.eq(span.x), pixel.y.eq(span.y)]

        move = ~self.fragments.valid | self.fragments.ready
        last = span.more == 0
        m.d.comb += [
            self.started.ready.eq(~holding | (move & last)),
            self.busy.eq(holding | self.fragments.valid),
        ]
        with m.If(move):
            m.d.sync += [
                self.fragments.valid.eq(holding),
                fragment.unit.eq(pixel.unit),
                fragment.address.eq(pixel.address),
                fragment.depth.eq(self._narrow(span.values.depth, configuration.depth_bits,
                                               configuration.depth_background - 1)),
                fragment.color.eq(Cat(self._channel(span.values[name])
                                      for name in commands.CHANNELS)),
                span.x.eq(span.x + (1 << span.x_stride_bits)),
                span.more.eq(span.more - 1),
                holding.eq(holding & ~last),
            ]
            for name in span.values.shape().members:
                m.d.sync += span.values[name].eq(span.values[name] + span.steps[name])
        with m.If(self.started.valid & self.started.ready):
            m.d.sync += [span.eq(self.started.payload), holding.eq(1)]
        return m

    def _narrow(self, carried, value_bits, high):
        fraction_bits = self.configuration.fraction_bits
        whole = floor_shift(to_signed(carried, len(carried)), fraction_bits)
        return saturate(whole, 0, high)[:value_bits]

    def _channel(self, carried):
        if self.configuration.shading == "flat":
            return carried
        return self._narrow(carried, CHANNEL_BITS, (1 << CHANNEL_BITS) - 1)
