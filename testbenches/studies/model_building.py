"""What it costs to compile machines: ``python -m testbenches.studies.model_building``.

Compiles each machine with an empty cache of its own, the first one twice, so that it is seen what
Verilator's runtime and the main program cost once on a computer.
"""

from __future__ import annotations

import os
import resource
import subprocess
import tempfile
import time
from typing import Any, NamedTuple

import click

from cardcage.golden.specification.configuration import MachineConfiguration
from cardcage.testbenches.engines.verilator_engine import VerilatorEngine
from cardcage.testbenches.export.verilog import machine_verilog
from cardcage.testbenches.support.cache import ENVIRONMENT_VARIABLE

#: The first is the measure of the others.
MACHINES: dict[str, dict[str, Any]] = {
    "PM": {"cards": "PM"},
    "4x(PMM)": {"cards": "4x(PMM)"},
    "16x(PMM)": {"cards": "16x(PMM)"},
    "8x(PMMMM)": {"cards": "8x(PMMMM)"},
    "4x(PMM), fast set-up": {"cards": "4x(PMM)", "setup": "hardware"},
}


class Cost(NamedTuple):
    """Seconds: of processors, and by the clock on the wall."""

    processor: float
    wall: float


def build(configuration: MachineConfiguration, verilog: str) -> tuple[str, Cost]:
    """The program, and what Verilator and the compiler cost."""
    before, began = _children(), time.perf_counter()
    program, fresh = VerilatorEngine(verilog=verilog).build(configuration)
    assert fresh
    return str(program), Cost(_children() - before, time.perf_counter() - began)


def _children() -> float:
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime


def bare_loop(program: str, cycles: int) -> float:
    """Processor seconds of so many clocks of the idle machine."""
    before = _children()
    subprocess.run([program, "bare", str(cycles)], check=True, stdout=subprocess.DEVNULL)
    return _children() - before


@click.command(epilog="Example: python -m testbenches.studies.model_building --size 128")
@click.option("--size", default=128, show_default=True, help="Width and height of the screen.")
@click.option("--machine", "names", multiple=True, type=click.Choice(list(MACHINES)),
              help="Only this one; again for more.")
@click.option("--cycles", default=100_000, show_default=True, help="Of the bare loop.")
def main(size: int, names: tuple[str, ...], cycles: int) -> None:
    """Compile machines, and say what each cost and how fast it is.

    Processor seconds of Verilator and the compiler; the Verilog is made before.
    """
    first = None
    with tempfile.TemporaryDirectory(prefix="cardcage-") as cache:
        os.environ[ENVIRONMENT_VARIABLE] = cache
        click.echo(f"{'':22} processor   wall  of the first  us a clock")
        for name in ("", *(names or MACHINES)):
            machine = MACHINES[name or next(iter(names or MACHINES))]
            configuration = MachineConfiguration(width=size, height=size, **machine)
            verilog = machine_verilog(configuration)
            if not name:  # a comment makes it another text
                verilog = f"// with the runtime\n{verilog}"
            program, cost = build(configuration, verilog)
            title = name or "the runtime, once, and"
            line = f"{title:22} {cost.processor:7.1f} s {cost.wall:4.1f} s"
            if name:
                first = first or cost.processor
                clock = bare_loop(program, cycles) / cycles
                line += f" {cost.processor / first:8.1f}      {clock * 1e6:8.2f}"
            click.echo(line)


if __name__ == "__main__":
    main()
