"""Long division in a pipeline, from one stage for all steps to one for each."""

from amaranth.hdl import *
from amaranth.lib import wiring
from amaranth.lib.wiring import In, Out

__all__ = ["Divider"]


class Divider(wiring.Component):
    """floor(dividend · 2**fraction_bits / divisor), modulo ``2**quotient_bits``.

    Long division, most significant bit first, without restoring: each step appends a bit of
    the dividend to the partial remainder and takes the divisor away, or adds it back where
    the step before went below zero; a remainder not below zero is a 1 of the quotient.  The
    dividend is signed: its sign extended without end is the first partial remainder, 0 or -1,
    so the quotient is floored with no step more, and quotient bits above the word are dropped.

    A stage makes ``interval`` steps, one a clock, and hands on to the next; no stage waits, so
    there is nothing to stall.

    Latency: ``latency`` clocks.  Throughput: a division every ``interval`` clocks; ``start``
    must not come sooner.

    Parameters
    ----------
    dividend_bits, divisor_bits, quotient_bits: int, positive
        Widths of a signed dividend, an unsigned divisor, an unsigned quotient.
    fraction_bits: int, from 0
    interval: int, positive
        The most clocks a division may take of a stage.

    Members
    -------
    start: In(1)
        Divide what is at the inputs.
    dividend: In(signed(dividend_bits))
        What is divided, without its fraction bits, which are zeros.
    divisor: In(divisor_bits)
        Not 0; for 0 the quotient means nothing.
    done: Out(1)
        High for one clock with each quotient.
    quotient: Out(quotient_bits)
        Rounded down.
    """

    def __init__(self, *, dividend_bits: int, divisor_bits: int, quotient_bits: int,
                 fraction_bits: int = 0, interval: int = 1):
        for name, value, least in (("dividend_bits", dividend_bits, 1),
                                   ("divisor_bits", divisor_bits, 1),
                                   ("quotient_bits", quotient_bits, 1),
                                   ("fraction_bits", fraction_bits, 0), ("interval", interval, 1)):
            if value < least:
                raise ValueError(f"{name} must be at least {least}, not {value}")
        self.dividend_bits = dividend_bits
        self.divisor_bits = divisor_bits
        self.quotient_bits = quotient_bits
        self.fraction_bits = fraction_bits
        steps = max(dividend_bits + fraction_bits, quotient_bits)
        self._stages = -(-steps // interval)
        # Stages are of equal length.  So there may be steps too many, fewer than stages; they
        # repeat the sign of the dividend.
        self._interval = -(-steps // self._stages)
        super().__init__({
            "start": In(1),
            "dividend": In(signed(dividend_bits)),
            "divisor": In(divisor_bits),
            "done": Out(1),
            "quotient": Out(quotient_bits),
        })

    @property
    def stages(self) -> int:
        return self._stages

    @property
    def interval(self) -> int:
        """Clocks between two divisions: at most what was asked for."""
        return self._interval

    @property
    def latency(self) -> int:
        """Clocks from ``start`` to ``done``."""
        return self._stages * self._interval

    def elaborate(self, platform):
        m = Module()
        steps = self.latency
        pad = steps - self.fraction_bits - self.dividend_bits

        def digits_left(step):
            """Digits of the dividend, fraction excluded, that are not used up after ``step``."""
            return max(0, steps - self.fraction_bits - step)

        def quotient_so_far(step):
            """Bits of the word that are known after ``step``."""
            return max(0, self.quotient_bits - (steps - step))

        sign = self.dividend[-1]
        loaded = self.start
        remainder = sign.replicate(self.divisor_bits + 1)
        dividend = Cat(self.dividend, sign.replicate(pad))
        divisor, quotient = self.divisor, Const(0, 0)
        for stage in range(self._stages):
            first, beyond = stage * self._interval, (stage + 1) * self._interval

            def register(width, what, stage=stage):
                return Signal(width, name=f"{what}_{stage}", reset_less=True)

            next_remainder = register(self.divisor_bits + 1, "remainder")
            next_dividend = register(digits_left(first + 1), "dividend")
            next_quotient = register(quotient_so_far(beyond - 1), "quotient")
            next_divisor = register(self.divisor_bits, "divisor")
            # Without a new one, on with what the stage has; which nobody reads where each clock is
            # a stage, and >= would only be more hardware.
            if self._interval > 1:
                remainder = Mux(loaded, remainder, next_remainder)
                dividend = Mux(loaded, dividend, next_dividend << 1)[:digits_left(first)]
                quotient = Mux(loaded, quotient, next_quotient)
                divisor = Mux(loaded, divisor, next_divisor)
            digit = dividend[-1] if digits_left(first) else C(0, 1)
            subtract = ~remainder[-1]
            appended = Cat(digit, remainder[:-1])
            # One carry chain: a bit below both carries the 1 that completes the complement.
            total = (Cat(1, appended)
                     + Cat(subtract, Cat(divisor, 0) ^ subtract.replicate(len(appended))))
            m.d.sync += [
                next_remainder.eq(total[1:]),
                next_dividend.eq(dividend[:digits_left(first + 1)]),
                # The quotient bit of the step before is the sign that it left.
                next_quotient.eq(Cat(subtract, quotient)),
                next_divisor.eq(divisor),
            ]
            for clock in range(self._interval):
                later = Signal(name=f"started_{first + clock + 1}")
                m.d.sync += later.eq(loaded)
                loaded = later
            remainder, quotient, divisor = next_remainder, next_quotient, next_divisor
            dividend = next_dividend[self._interval - 1:]
        m.d.comb += [self.done.eq(loaded), self.quotient.eq(Cat(~remainder[-1], quotient))]
        return m
