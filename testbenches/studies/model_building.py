"""What it costs to compile machines: ``python -m testbenches.studies.model_building``.

Compiles each machine with an empty cache of its own, in which only Verilator's runtime and what
else all models have in common is kept; the first one twice, so that it is seen what that costs once
on a computer.  A cage with the domains of another one is compiled where those are kept.
"""

from __future__ import annotations

import os
import resource
import shutil
import subprocess
import tempfile
import time
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, NamedTuple

import click

from cardcage.golden.specification.configuration import MachineConfiguration
from cardcage.testbenches.engines.model_runtime import headers, main_program, runtime
from cardcage.testbenches.engines.verilator_engine import VerilatorEngine
from cardcage.testbenches.engines.verilator_tool import VerilatorTool, find_verilator
from cardcage.testbenches.support.cache import ENVIRONMENT_VARIABLE

#: The first is the measure of the others.
MACHINES: dict[str, dict[str, Any]] = {
    "PM": {"cards": "PM"},
    "4x(PMM)": {"cards": "4x(PMM)"},
    "16x(PMM)": {"cards": "16x(PMM)"},
    "14x(PMM)PMPMMM": {"cards": "14x(PMM)PMPMMM"},
    "PMPMMM14x(PMM), after it": {"cards": "PMPMMM14x(PMM)"},
    "8x(PMMMM)": {"cards": "8x(PMMMM)"},
    "4x(PMM), fast set-up": {"cards": "4x(PMM)", "setup": "hardware"},
}

#: Compiled where what the ones before made is kept.
AFTER = {name for name in MACHINES if "after" in name}


class Cost(NamedTuple):
    """Seconds: of processors, and by the clock on the wall."""

    processor: float
    wall: float


@dataclass(frozen=True)
class MeasuredTool(VerilatorTool):
    """``costs``: of all that it has run so far."""

    costs: list[Cost] = field(default_factory=list, compare=False)

    def run(self, commands: Any, folder: Path) -> None:
        before, began = _children(), time.perf_counter()
        super().run(commands, folder)
        self.costs.append(Cost(_children() - before, time.perf_counter() - began))

    @property
    def cost(self) -> Cost:
        return Cost(*map(sum, zip(*self.costs, strict=True)))


def measured_tool() -> MeasuredTool:
    found = find_verilator()
    return MeasuredTool(found.root, found.compiler)


def build(configuration: MachineConfiguration, tool: MeasuredTool) -> str:
    """The program."""
    program, fresh = VerilatorEngine(tool).build(configuration)
    assert fresh
    return str(program)


def keep_what_is_common(tool: VerilatorTool, cache: Path) -> None:
    """Empty the cache of all else."""
    kept = {Path(path).parent.name for path in (
        *runtime(tool), *headers(tool), main_program(tool)) if str(cache) in path}
    for folder in cache.iterdir():
        if folder.is_dir() and folder.name not in kept:
            shutil.rmtree(folder)


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

    Processor seconds of Verilator and the compiler, without those that make the Verilog.
    """
    first = None
    with tempfile.TemporaryDirectory(prefix="cardcage-") as cache:
        os.environ[ENVIRONMENT_VARIABLE] = cache
        click.echo(f"{'':26} processor   wall  of the first  us a clock")
        for name in ("", *(names or MACHINES)):
            machine = MACHINES[name or next(iter(names or MACHINES))]
            if name and name not in AFTER:
                keep_what_is_common(measured_tool(), Path(cache))
            tool = measured_tool()
            program = build(MachineConfiguration(**{"width": size, "height": size} | machine), tool)
            title = name or "what all share, once, and"
            line = f"{title:26} {tool.cost.processor:7.1f} s {tool.cost.wall:4.1f} s"
            if name:
                first = first or tool.cost.processor
                clock = bare_loop(program, cycles) / cycles
                line += f" {tool.cost.processor / first:8.1f}      {clock * 1e6:8.2f}"
            click.echo(line)


if __name__ == "__main__":
    main()
