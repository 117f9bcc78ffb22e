"""Sums of products against Python's integers."""

import random
from itertools import product

import pytest
from hdl_bench.bench import Agent, rejects, simulate

from cardcage.hdl.arithmetic.pipelined_multiplier import PipelinedMultiplier


class Sums(Agent):
    """New factors in every clock; each sum is looked at when it is due."""

    def __init__(self, dut, factors):
        self._dut = dut
        self._factors = factors
        self._clock = 0
        self.seen = 0

    @property
    def finished(self):
        return self.seen == len(self._factors)

    def drive(self, ctx):
        if self._clock < len(self._factors):
            for name, values in zip("ab", self._factors[self._clock], strict=True):
                for place, value in enumerate(values):
                    ctx.set(getattr(self._dut, name)[place], value)

    def sample(self, ctx):
        due = self._clock - self._dut.latency
        if 0 <= due < len(self._factors):
            a, b = self._factors[due]
            assert ctx.get(self._dut.sum) == sum(x * y for x, y in zip(a, b, strict=True)), (a, b)
            self.seen += 1
        self._clock += 1


@pytest.mark.parametrize(("a_bits", "b_bits", "pairs", "multipliers", "latency"), [
    (18, 18, 1, 1, 2),
    (19, 18, 1, 2, 3),
    (20, 20, 2, 8, 5),  # the area of a triangle at 512 by 512
    (25, 20, 2, 8, 5),  # a slope of its depth
    (44, 25, 1, 6, 5),  # part of a plane's numerator
    (35, 52, 1, 6, 5),
    (36, 1, 3, 9, 6),
    (1, 1, 5, 5, 5),
])
def test_sums_and_latency(a_bits, b_bits, pairs, multipliers, latency):
    pick = random.Random(f"{a_bits} {b_bits} {pairs}")

    def values(bits):
        ends = (-(1 << bits - 1), (1 << bits - 1) - 1, 0, -1)
        return [pick.choice((*ends, pick.randint(*ends[:2]))) for _ in range(pairs)]

    lowest, highest = ([[(-(1 << bits - 1), (1 << bits - 1) - 1)[end]] * pairs
                        for bits in (a_bits, b_bits)] for end in (0, 1))
    factors = [lowest, highest, [lowest[0], highest[1]], [highest[0], lowest[1]]]
    factors += [[values(a_bits), values(b_bits)] for _ in range(300)]
    dut = PipelinedMultiplier(a_bits=a_bits, b_bits=b_bits, pairs=pairs)
    assert (dut.multipliers, dut.latency) == (multipliers, latency)
    simulate(dut, Sums(dut, factors))


@pytest.mark.parametrize("pairs", [1, 2])
def test_every_product_of_small_numbers(pairs):
    every = [([*a], [*b]) for *a, in product(range(-4, 4), repeat=pairs)
             for *b, in product(range(-2, 2), repeat=pairs)]
    simulate(dut := PipelinedMultiplier(a_bits=3, b_bits=2, pairs=pairs), Sums(dut, every))


@pytest.mark.parametrize("name", ["a_bits", "b_bits", "pairs"])
def test_widths_are_positive(name):
    rejects(PipelinedMultiplier, name, **{"a_bits": 4, "b_bits": 4, "pairs": 1} | {name: 0})
