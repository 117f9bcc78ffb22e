"""How fast the simulation engines are here, on one machine and frame."""

from __future__ import annotations

import subprocess
import time
from contextlib import suppress
from dataclasses import dataclass
from statistics import median

from ...golden.specification.configuration import MachineConfiguration
from ...golden.specification.display_list import DisplayList
from ..engines.engine import Job
from ..engines.pysim_engine import PysimEngine
from ..engines.verilator_engine import VerilatorEngine
from ..frames.frame_job import frame_job


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


@dataclass(frozen=True)
class EngineSpeed:
    """Simulated cycles a second, medians: of whole frames through the Verilator engine (files
    written, read and turned into pictures; building left out), of a bare C++ loop that only
    toggles the clock of the same compiled model, and of pysim over its first cycles.

    ``cycles``         of the frame
    ``build_seconds``  None where the model was compiled before
    """

    cycles: int
    build_seconds: float | None
    verilator: float
    bare_loop: float
    pysim: float


def measure_engines(configuration: MachineConfiguration, display_list: DisplayList, *, runs: int,
                    pysim_cycles: int) -> EngineSpeed:
    """Measure all three; frame and loop take turns, so that both meet the same load.

    Raises ``ToolMissingError`` where Verilator does not work here.
    """
    job = frame_job(configuration, display_list)
    engine = VerilatorEngine()
    began = time.perf_counter()
    _, fresh = engine.build(configuration)
    built = time.perf_counter() - began
    frames, loops, cycles = [], [], 0
    for _ in range(runs):
        cycles, seconds = whole_frame(engine, job)
        frames.append(cycles / seconds)
        loops.append(cycles / bare_loop(engine, configuration, cycles))
    return EngineSpeed(cycles, built if fresh else None, median(frames), median(loops),
                       pysim_start(job, pysim_cycles))
