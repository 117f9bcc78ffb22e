"""Interpolants at the first pixel of a span."""

from amaranth.hdl import *
from amaranth.lib import data, stream, wiring
from amaranth.lib.wiring import In, Out

from ..golden import commands
from ..golden.configuration import CHANNEL_BITS, MachineConfiguration
from .layouts import span_layout

__all__ = ["SpanStart", "started_span_layout", "values_layout"]


def values_layout(configuration: MachineConfiguration) -> data.StructLayout:
    """One carried value of each interpolant; flat channels as they are."""
    channel = (CHANNEL_BITS if configuration.shading == "flat"
               else configuration.channel_plane_bits)
    return data.StructLayout({"depth": configuration.depth_plane_bits,
                              **dict.fromkeys(commands.CHANNELS, channel)})


def started_span_layout(configuration: MachineConfiguration) -> data.StructLayout:
    """A span with its interpolants: ``values`` at the first pixel, ``steps`` to the next."""
    span = span_layout(configuration)
    return data.StructLayout({
        **{name: span.members[name] for name in ("x", "y", "more", "x_stride_bits")},
        "values": values_layout(configuration),
        "steps": values_layout(configuration),
    })


class SpanStart(wiring.Component):
    """start + x_steps · step_x + y_steps · step_y, modulo the carried width.

    The products are those of the picture's definition, not sums of rounded
    strides, so the result does not depend on which lattice is walked.

    Latency: two clocks (products, then sums).  Throughput: a span a clock.

    Members
    -------
    spans: In(stream of span_layout)
    started: Out(stream of started_span_layout)
    busy: Out(1)
        Holds a span.

    Fuchs & Johnson, after figure 13: the controller computes the increments, the
    processing elements only apply them.
    """

    latency = 2

    def __init__(self, *, configuration: MachineConfiguration):
        self.configuration = configuration
        super().__init__({
            "spans": In(stream.Signature(span_layout(configuration))),
            "started": Out(stream.Signature(started_span_layout(configuration))),
            "busy": Out(1),
        })

    def elaborate(self, platform):
        m = Module()
        span, started = self.spans.payload, self.started.payload
        multiplied = Signal()
        move = ~self.started.valid | self.started.ready
        m.d.comb += [
            # The two stages move together: a bubble between them is not worth its logic.
            self.spans.ready.eq(move),
            self.busy.eq(multiplied | self.started.valid),
        ]
        with m.If(move):
            m.d.sync += [multiplied.eq(self.spans.valid), self.started.valid.eq(multiplied)]

        carried = Signal(data.StructLayout({
            name: span_layout(self.configuration).members[name]
            for name in ("x", "y", "more", "x_stride_bits")}))
        for name in carried.shape().members:
            with m.If(move):
                m.d.sync += [carried[name].eq(span[name]), started[name].eq(carried[name])]

        for name in values_layout(self.configuration).members:
            plane = span.planes[name]
            value, step = started.values[name], started.steps[name]
            if not isinstance(plane, data.View):  # a flat channel
                color = Signal.like(value)
                with m.If(move):
                    m.d.sync += [color.eq(plane), value.eq(color), step.eq(0)]
                continue
            origin, along_x, along_y, step_x = (Signal.like(value, name=f"{name}_{part}")
                                                for part in ("origin", "along_x", "along_y",
                                                             "step_x"))
            with m.If(move):
                m.d.sync += [
                    origin.eq(plane.start),
                    along_x.eq(plane.step_x * span.x_steps),
                    along_y.eq(plane.step_y * span.y_steps),
                    step_x.eq(plane.step_x),
                    value.eq(origin + along_x + along_y),
                    step.eq(step_x << carried.x_stride_bits),
                ]
        return m
