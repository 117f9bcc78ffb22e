"""Interpolants carried as quotient and remainder: the alternative to fraction bits, measured.

value + remainder / D is the rational number itself, exact for every triangle; a sum
carries by a comparison with D and a subtraction.  A product of steps and an increment
is summed from the increment's doublings, each of which carries the same way, since a
product of remainders would have to be divided.  One of the doublings of the increment
along x is the stride's.
"""

from typing import Any

from amaranth.hdl import Module, Mux, Signal, Value, unsigned
from amaranth.lib import data, stream, wiring
from amaranth.lib.wiring import In, Out

__all__ = ["PipelinedRemainderInterpolator", "RemainderInterpolator"]


class RemainderInterpolator(wiring.Component):
    """Spans in, the value of every pixel out, with one adder for the value and one to double.

    Latency: one clock to load, one for each binary digit of ``x_steps`` (at least
    ``x_stride_bits`` + 1), one for each of ``y_steps`` (at least 1).  Throughput: a
    value a clock; the next span is taken after the last value.

    Members
    -------
    spans: In(stream of a struct)
        ``start`` ``step_x`` ``step_y``  quotient modulo 2**value_bits, remainder below D
        ``denominator``    D, below 2**area_bits
        ``x_steps`` ``y_steps``  pixels from the origin to the first pixel
        ``more``           pixels after the first
        ``x_stride_bits``  log2 of the distance between neighbouring pixels of the run
    values: Out(stream of unsigned(value_bits))
    """

    def __init__(self, *, value_bits: int, area_bits: int, steps_bits: int,
                 stride_bits_bits: int):
        for name, bits in (("value_bits", value_bits), ("area_bits", area_bits),
                           ("steps_bits", steps_bits), ("stride_bits_bits", stride_bits_bits)):
            if not isinstance(bits, int) or bits < 1:
                raise ValueError(f"{name} must be a positive integer, not {bits!r}")
        self._number = data.StructLayout({"quotient": value_bits, "remainder": area_bits})
        self._steps_bits = steps_bits
        self._span = data.StructLayout({
            **dict.fromkeys(("start", "step_x", "step_y"), self._number),
            "denominator": area_bits,
            **dict.fromkeys(("x_steps", "y_steps", "more"), steps_bits),
            "x_stride_bits": stride_bits_bits,
        })
        super().__init__({
            "spans": In(stream.Signature(self._span)),
            "values": Out(stream.Signature(unsigned(value_bits))),
        })

    def _sum(self, m: Module, name: str, one: data.View, other: data.View,
             denominator: Value) -> Signal:
        """Remainders are below D, so one subtraction is enough."""
        total = Signal(self._number, name=name)
        remainder = Signal(len(one.remainder) + 1, name=f"{name}_remainder")
        carry = Signal(name=f"{name}_carry")
        m.d.comb += [
            remainder.eq(one.remainder + other.remainder),
            carry.eq(remainder >= denominator),
            total.quotient.eq(one.quotient + other.quotient + carry),
            total.remainder.eq(Mux(carry, remainder - denominator, remainder)),
        ]
        return total

    def elaborate(self, platform: Any) -> Module:
        m = Module()
        span = Signal(self._span)
        value, step, multiple, addend = (Signal(self._number, name=name)
                                         for name in ("value", "step", "multiple", "addend"))
        digit = Signal(range(self._steps_bits + (1 << len(span.x_stride_bits))))
        moved = self._sum(m, "moved", value, addend, span.denominator)
        twice = self._sum(m, "twice", multiple, multiple, span.denominator)
        m.d.comb += self.values.payload.eq(value.quotient)
        with m.FSM() as machine:
            m.d.comb += addend.eq(Mux(machine.ongoing("WALK"), step, multiple))
            with m.State("LOAD"):
                m.d.comb += self.spans.ready.eq(1)
                m.d.sync += [
                    span.eq(self.spans.payload),
                    value.eq(self.spans.payload.start),
                    multiple.eq(self.spans.payload.step_x),
                    digit.eq(0),
                ]
                with m.If(self.spans.valid):
                    m.next = "ALONG_X"
            with m.State("ALONG_X"):
                with m.If(span.x_steps[0]):
                    m.d.sync += value.eq(moved)
                with m.If(digit == span.x_stride_bits):
                    m.d.sync += step.eq(multiple)
                m.d.sync += [span.x_steps.eq(span.x_steps >> 1), multiple.eq(twice),
                             digit.eq(digit + 1)]
                with m.If((span.x_steps[1:] == 0) & (digit >= span.x_stride_bits)):
                    m.d.sync += multiple.eq(span.step_y)
                    m.next = "ALONG_Y"
            with m.State("ALONG_Y"):
                with m.If(span.y_steps[0]):
                    m.d.sync += value.eq(moved)
                m.d.sync += [span.y_steps.eq(span.y_steps >> 1), multiple.eq(twice)]
                with m.If(span.y_steps[1:] == 0):
                    m.next = "WALK"
            with m.State("WALK"):
                m.d.comb += self.values.valid.eq(1)
                with m.If(self.values.ready):
                    m.d.sync += [value.eq(moved), span.more.eq(span.more - 1)]
                    with m.If(span.more == 0):
                        m.next = "LOAD"
        return m


class PipelinedRemainderInterpolator(RemainderInterpolator):
    """The same with a stage for each binary digit, as fast as the machine's own parts.

    Latency: ``latency`` clocks.  Throughput: a value a clock, the next span without a bubble.

    Members are those of ``RemainderInterpolator``.
    """

    @property
    def latency(self) -> int:
        return 2 * self._steps_bits + 1

    def elaborate(self, platform: Any) -> Module:
        m = Module()
        stage = data.StructLayout(self._span.members | dict.fromkeys(
            ("value", "multiple", "step"), self._number))
        move, holding = Signal(), Signal()
        walked, valid = Signal(stage), self.spans.valid
        # The stages move together: bubbles between them are not worth their logic.
        m.d.comb += [
            move.eq(~holding | (self.values.ready & (walked.more == 0))),
            self.spans.ready.eq(move),
            self.values.valid.eq(holding),
            self.values.payload.eq(walked.value.quotient),
        ]
        current = Signal(stage, name="first")
        m.d.comb += [current[name].eq(self.spans.payload[name]) for name in self._span.members]
        m.d.comb += [current.value.eq(current.start), current.multiple.eq(current.step_x)]
        for axis in "xy":
            for digit in range(self._steps_bits):
                name = f"{axis}_{digit}"
                after, after_valid = Signal(stage, name=name), Signal(name=f"{name}_valid")
                moved, twice = (
                    self._sum(m, f"{name}_{what}", part, current.multiple, current.denominator)
                    for what, part in (("moved", current.value), ("twice", current.multiple)))
                with m.If(move):
                    m.d.sync += [after.eq(current), after.multiple.eq(twice),
                                 after_valid.eq(valid)]
                    with m.If(current[f"{axis}_steps"][digit]):
                        m.d.sync += after.value.eq(moved)
                    if axis == "x":
                        with m.If(current.x_stride_bits == digit):
                            m.d.sync += after.step.eq(current.multiple)
                        if digit == self._steps_bits - 1:
                            m.d.sync += after.multiple.eq(current.step_y)
                current, valid = after, after_valid

        moved = self._sum(m, "moved", walked.value, walked.step, walked.denominator)
        with m.If(self.values.ready):
            m.d.sync += [walked.value.eq(moved), walked.more.eq(walked.more - 1)]
        with m.If(move):
            m.d.sync += [walked.eq(current), holding.eq(valid)]
        return m
