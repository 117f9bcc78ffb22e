"""Long division against Python's integers, exhaustively at small widths."""

import random

import pytest
from hdl_bench.bench import Agent, rejects, simulate

from cardcage.hdl.arithmetic.divider import Divider


class Divisions(Agent):
    """Starts a division every ``gap()`` clocks; every quotient must come, right and in time."""

    def __init__(self, dut, divisions, fraction_bits, gap):
        self._dut = dut
        self._gap = gap
        self._waiting = list(reversed(divisions))
        self._fraction_bits = fraction_bits
        self._clock = 0
        self._next = 0
        self._expected = {}
        self.started, self.ended = [], []

    @property
    def finished(self):
        return not self._waiting and not self._expected

    def drive(self, ctx):
        go = bool(self._waiting) and self._clock >= self._next
        ctx.set(self._dut.start, go)
        if not go:  # what is not started must not matter
            ctx.set(self._dut.dividend, self._clock & 1)
            ctx.set(self._dut.divisor, 1)
            return
        dividend, divisor = self._waiting.pop()
        ctx.set(self._dut.dividend, dividend)
        ctx.set(self._dut.divisor, divisor)
        quotient = (dividend << self._fraction_bits) // divisor
        self._expected[self._clock + self._dut.latency] = dividend, divisor, quotient
        self.started.append(self._clock)
        self._next = self._clock + self._gap()

    def sample(self, ctx):
        expected = self._expected.pop(self._clock, None)
        assert ctx.get(self._dut.done) == (expected is not None)
        if expected is not None:
            dividend, divisor, quotient = expected
            found = ctx.get(self._dut.quotient)
            assert found == quotient % (1 << len(self._dut.quotient)), (dividend, divisor)
            self.ended.append(self._clock)
        self._clock += 1


def divide(divisions, *, fraction_bits=0, wait=lambda: 0, **parameters):
    dut = Divider(fraction_bits=fraction_bits, **parameters)
    agent = Divisions(dut, divisions, fraction_bits, lambda: dut.interval + wait())
    simulate(dut, agent, after=3, limit=100_000)
    assert len(agent.ended) == len(divisions)
    return dut, agent


@pytest.mark.parametrize(("fraction_bits", "quotient_bits"), [(0, 5), (0, 9), (2, 3), (3, 8)])
@pytest.mark.parametrize("interval", [1, 2, 3, 100])
def test_every_division_of_small_numbers(fraction_bits, quotient_bits, interval):
    every = [(dividend, divisor) for dividend in range(-16, 16) for divisor in range(1, 8)]
    divide(every, dividend_bits=5, divisor_bits=3, fraction_bits=fraction_bits,
           quotient_bits=quotient_bits, interval=interval)


@pytest.mark.parametrize("widths", [(66, 38, 72, 45), (20, 20, 12, 0), (1, 1, 1, 0), (9, 30, 4, 7),
                                    (30, 2, 40, 3)])
@pytest.mark.parametrize("interval", [1, 7, 256])
def test_random_numbers_at_random_times(widths, interval):
    """Ends of the ranges among them, starts as soon as possible or later."""
    dividend_bits, divisor_bits, quotient_bits, fraction_bits = widths
    pick = random.Random(f"{widths} {interval}")
    low, high = -(1 << dividend_bits - 1), (1 << dividend_bits - 1) - 1
    most = (1 << divisor_bits) - 1
    divisions = [(pick.choice((low, high, -1, 0, pick.randint(low, high),
                               pick.randint(low, high) >> pick.randrange(dividend_bits))),
                  pick.choice((1, most, pick.randint(1, most),
                               max(1, most >> pick.randrange(divisor_bits)))))
                 for _ in range(40)]
    waits = random.Random(f"waits {widths} {interval}")
    divide(divisions, dividend_bits=dividend_bits, divisor_bits=divisor_bits,
           quotient_bits=quotient_bits, fraction_bits=fraction_bits, interval=interval,
           wait=lambda: waits.choice((0, 0, 1, waits.randrange(2 * interval + 3))))


@pytest.mark.parametrize(("interval", "stages", "actual"), [
    (1, 111, 111), (2, 56, 112), (37, 3, 111), (50, 3, 111), (110, 2, 112), (111, 1, 111),
    (256, 1, 111)])
def test_latency_and_throughput(interval, stages, actual):
    """The widest division of a 512 by 512 machine, from a stage for each step to one for all."""
    pick = random.Random(f"speed {interval}")
    divisions = [(pick.randrange(-(1 << 65), 1 << 65), pick.randrange(1, 1 << 38))
                 for _ in range(5)]
    dut, agent = divide(divisions, dividend_bits=66, divisor_bits=38, quotient_bits=72,
                        fraction_bits=45, interval=interval)
    assert (dut.stages, dut.latency) == (stages, actual)
    assert dut.interval * dut.stages == dut.latency and dut.interval <= interval
    assert agent.started == [place * dut.interval for place in range(len(divisions))]
    assert agent.ended == [clock + dut.latency for clock in agent.started]


@pytest.mark.parametrize("name", ["dividend_bits", "divisor_bits", "quotient_bits", "interval"])
def test_widths_are_positive(name):
    good = {"dividend_bits": 4, "divisor_bits": 4, "quotient_bits": 4, "interval": 1}
    rejects(Divider, name, **good | {name: 0})
    rejects(Divider, "fraction_bits", **good, fraction_bits=-1)
