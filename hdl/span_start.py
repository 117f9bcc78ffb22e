"""Interpolants at the first pixel of a span."""

from amaranth.hdl import *
from amaranth.lib import data, stream, wiring
from amaranth.lib.wiring import In, Out

from ..golden import commands
from ..golden.configuration import CHANNEL_BITS, MachineConfiguration
from .edge_columns import limbs
from .layouts import planes_layout, span_layout

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

    Latency: ``latency`` clocks (products, then sums two by two).  Throughput: a
    span a clock.  All stages move together.

    Members
    -------
    spans: In(stream of span_layout)
        Those with ``none`` go no further.
    planes: In(stream of planes_layout)
        The interpolants of the triangle whose spans come; taken with its last span.  They must
        be there before its spans.
    started: Out(stream of started_span_layout)
    busy: Out(1)
        Holds a span.

    Fuchs & Johnson, after figure 13: the controller computes the increments, the
    processing elements only apply them.
    """

    latency = 4

    def __init__(self, *, configuration: MachineConfiguration):
        self.configuration = configuration
        super().__init__({
            "spans": In(stream.Signature(span_layout(configuration))),
            "planes": In(stream.Signature(planes_layout(configuration))),
            "started": Out(stream.Signature(started_span_layout(configuration))),
            "busy": Out(1),
        })

    def elaborate(self, platform):
        m = Module()
        span, planes, started = self.spans.payload, self.planes.payload, self.started.payload
        stages = Signal(self.latency)
        move = Signal()
        m.d.comb += [
            move.eq(~self.started.valid | self.started.ready),
            self.spans.ready.eq(move),
            self.planes.ready.eq(move & self.spans.valid & span.last),
            self.started.valid.eq(stages[-1]),
            self.busy.eq(stages.any()),
        ]
        with m.If(move):
            m.d.sync += stages.eq(Cat(self.spans.valid & ~span.none, stages))

        def delayed(value, clocks, name):
            for stage in range(clocks):
                later = Signal.like(value, name=f"{name}_{stage + 1}", reset_less=True)
                with m.If(move):
                    m.d.sync += later.eq(value)
                value = later
            return value

        for name in ("x", "y", "more", "x_stride_bits"):
            m.d.comb += started[name].eq(delayed(span[name], self.latency, name))
        for name in values_layout(self.configuration).members:
            plane = planes[name]
            value, step = started.values[name], started.steps[name]
            if isinstance(plane, data.View):
                m.d.comb += value.eq(self._value(m, plane, span, move, name))
                step_x = delayed(plane.step_x, self.latency - 1, f"{name}_step")
                stride = delayed(span.x_stride_bits, self.latency - 1, f"{name}_stride")
                with m.If(move):
                    m.d.sync += step.eq(step_x << stride)
            else:  # a flat channel
                m.d.comb += value.eq(delayed(plane, self.latency, name))
        return m

    def _value(self, m, plane, span, move, name):
        """The interpolant at the span's first pixel, four moves later."""
        addends = []
        for axis in "xy":
            addends += limbs(m, plane[f"step_{axis}"], span[f"{axis}_steps"], advance=move,
                             name=f"{name}_{axis}")
        start = Signal.like(plane.start, name=f"{name}_start", reset_less=True)
        with m.If(move):
            m.d.sync += start.eq(plane.start)
        addends.append(start)
        for level in range(self.latency - 1):
            sums = []
            # The last level takes whatever there is.
            pairs = 2 if level < self.latency - 2 else len(addends)
            for place in range(0, len(addends), pairs):
                register = Signal.like(plane.start, name=f"{name}_sum_{level}_{place}",
                                       reset_less=True)
                with m.If(move):
                    m.d.sync += register.eq(sum(addends[place + 1:place + pairs], addends[place]))
                sums.append(register)
            addends = sums
        return addends[0]
