"""How fast the engines are: ``python -m cardcage.testbenches.engine_benchmark``.

Prints, for one machine and frame, the simulated cycles a second of a whole frame through the
Verilator engine (files written, read and turned into pictures; building left out), of a bare C++
loop that only toggles the clock of the same compiled model, and of pysim over its first cycles.
"""

from __future__ import annotations

import subprocess
import time
from contextlib import suppress
from statistics import median

import click

from ..golden.planning.machines import PRESETS, preset
from ..golden.reference.triangle_setup import scene_fraction_bits
from ..golden.scene_display_list import make_display_list
from ..golden.specification.configuration import MachineConfiguration
from .engine import Job
from .pysim_engine import PysimEngine
from .simulation import frame_job
from .verilator_engine import VerilatorEngine


def whole_frame(engine: VerilatorEngine, job: Job) -> tuple[int, float]:
    """Cycles of the frame and seconds it took, from commands to pictures."""
    run = engine.run(job)
    return run.cycles, run.seconds


def bare_loop(engine: VerilatorEngine, configuration: MachineConfiguration, cycles: int) -> float:
    """Seconds that ``cycles`` clocks of the idle model take in a loop that does nothing else."""
    program, _ = engine.build(configuration)
    done = subprocess.run([program, "bare", str(cycles)], capture_output=True, text=True,
                          check=True)
    return float(done.stdout)


class _MeasuredError(Exception):
    """Enough cycles are simulated."""


def pysim_start(job: Job, cycles: int) -> float:
    """Cycles a second of pysim over the first cycles of the same frame."""
    began = time.perf_counter()
    reached = 0

    def stop(now: int, responses: int) -> None:
        nonlocal began, reached
        if not reached:  # elaboration is not simulation
            began, reached = time.perf_counter(), now
        elif now - reached >= cycles:
            reached = now - reached
            raise _MeasuredError

    with suppress(_MeasuredError):
        PysimEngine().run(job, stop)
    return reached / (time.perf_counter() - began)


@click.command()
@click.option("--preset", "name", type=click.Choice(list(PRESETS)), default="paper",
              show_default=True)
@click.option("--scene", default="teapot:tessellation=8", show_default=True)
@click.option("--cards", help="Instead of the preset's.")
@click.option("--runs", default=5, show_default=True)
@click.option("--pysim-cycles", default=2048, show_default=True)
def main(name: str, scene: str, cards: str | None, runs: int, pysim_cycles: int) -> None:
    """Compare the engines on one frame.

    \b
    Examples:
      python -m cardcage.testbenches.engine_benchmark
      python -m cardcage.testbenches.engine_benchmark --preset small --scene teapot
    """
    size = {axis: PRESETS[name][axis] for axis in ("width", "height")}
    listed = make_display_list(scene, **size).display_list
    changes = {"cards": cards} if cards else {}
    configuration = preset(name, fraction_bits=scene_fraction_bits(listed), **changes)
    job = frame_job(configuration, listed)
    engine = VerilatorEngine()
    began = time.perf_counter()
    _, fresh = engine.build(configuration)
    click.echo(f"machine   {configuration.cards}, {configuration.width}x{configuration.height}, "
               f"{configuration.fraction_bits} fraction bits; model "
               + (f"built in {time.perf_counter() - began:.0f} s" if fresh else "found"))
    frames, loops, cycles = [], [], 0
    for _ in range(runs):  # in turn, so that both see the same machine's moods
        cycles, seconds = whole_frame(engine, job)
        frames.append(cycles / seconds)
        loops.append(cycles / bare_loop(engine, configuration, cycles))
    slow = pysim_start(job, pysim_cycles)
    frame, loop = median(frames), median(loops)
    click.echo(f"frame     {scene}: {listed.triangles:,} triangles, {cycles:,} cycles")
    click.echo(f"verilator {frame:12,.0f} cycles a second, whole frame, median of {runs}")
    click.echo(f"bare loop {loop:12,.0f} cycles a second; ratio {frame / loop:.2f}")
    click.echo(f"pysim     {slow:12,.0f} cycles a second; verilator is {frame / slow:,.0f} times "
               "as fast")


if __name__ == "__main__":
    main()
