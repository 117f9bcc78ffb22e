"""The narrowings of the hardware equal those of the same names in
``golden.specification.fixed_point``."""

import pytest
from amaranth.hdl import Module, Signal, Value, signed, unsigned
from hdl_bench.bench import evaluate

from cardcage.golden.specification import fixed_point as golden
from cardcage.hdl.arithmetic import narrowing as hdl

WIDTH = 6
SHAPES = {"unsigned": unsigned(WIDTH), "signed": signed(WIDTH)}
VALUES = {"unsigned": range(1 << WIDTH), "signed": range(-(1 << WIDTH - 1), 1 << WIDTH - 1)}
RANGES = [(0, 0), (0, 1), (0, 5), (3, 3), (2, 7), (7, 20), (0, 31), (0, 40)]


def cases():
    for bits in range(1, WIDTH + 4):
        yield "wrap", (bits,)
        yield "to_signed", (bits,)
    for fraction_bits in range(WIDTH + 3):
        yield "floor_shift", (fraction_bits,)
    for low_high in RANGES:
        yield "saturate", low_high


@pytest.mark.parametrize("kind", SHAPES)
def test_every_value_narrows_as_golden_does(kind):
    module = Module()
    value = Signal(SHAPES[kind])
    results = []
    for name, arguments in cases():
        expression = Value.cast(getattr(hdl, name)(value, *arguments))
        result = Signal(expression.shape(), name=f"{name}_{arguments[0]}")
        module.d.comb += result.eq(expression)
        results.append((name, arguments, result))

    def steps(ctx):
        for number in VALUES[kind]:
            ctx.set(value, number)
            for name, arguments, result in results:
                expected = getattr(golden, name)(number, *arguments)
                assert ctx.get(result) == expected, (name, number, arguments)

    evaluate(module, steps)


@pytest.mark.parametrize("kind", SHAPES)
def test_results_are_as_wide_as_their_names_say(kind):
    value = Signal(SHAPES[kind])
    for bits in range(1, WIDTH + 4):
        assert hdl.wrap(value, bits).shape() == unsigned(bits)
        assert hdl.to_signed(value, bits).shape() == signed(bits)
    for low, high in RANGES[1:]:
        assert len(hdl.saturate(value, low, high)) == high.bit_length()
