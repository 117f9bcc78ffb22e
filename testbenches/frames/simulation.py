"""A display list through a simulated machine: commands in, pixels and depths out."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from ...golden.specification.configuration import MachineConfiguration
from ...golden.specification.display_list import DisplayList
from ...golden.specification.errors import InputError
from ..engines.choose_engine import make_engine
from ..engines.engine import Engine, Progress
from ..engines.verilator_tool import ToolMissingError
from .frame_job import frame_job
from .responses import MachineError, Simulation, interpret


def simulate(
    configuration: MachineConfiguration,
    display_list: DisplayList,
    engine: Engine,
    *,
    memory_seed: int | None = None,
    stall_seed: int | None = None,
    waveform: Path | None = None,
    progress: Progress | None = None,
    fraction_bits: int | None = None,
) -> Simulation:
    """Boot the machine, draw one frame, watch it on the video pins, read its depths back.

    ``fraction_bits`` as in ``frame_commands``.
    """
    job = frame_job(configuration, display_list, memory_seed=memory_seed, stall_seed=stall_seed,
                    waveform=waveform, fraction_bits=fraction_bits)
    return interpret(configuration, engine.run(job, progress))


def simulate_frame(engine: str, configuration: MachineConfiguration, display_list: DisplayList,
                   **options: Any) -> Simulation:
    """``simulate`` with the engine of that name, for a command line.

    Raises ``InputError`` where the engine cannot run here, ``MachineError`` where the machine
    fails.
    """
    try:
        return simulate(configuration, display_list, make_engine(engine), **options)
    except ToolMissingError as missing:
        raise InputError(f"--engine {engine}: {missing}; or use --engine pysim") from None
    except (TimeoutError, AssertionError) as error:
        raise MachineError(f"the machine failed: {error}") from error

