"""A display list through a simulated machine: commands in, pixels and depths out."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ...golden.specification.configuration import MachineConfiguration
from ...golden.specification.display_list import DisplayList
from ...golden.specification.errors import InputError
from ..engines.choose_engine import AUTO, make_engine
from ..engines.engine import Engine, Progress
from ..engines.verilator_tool import ToolMissingError
from ..support.machine_error import MachineError
from .frame_job import frame_job
from .responses import Answers, Simulation


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
    table: NDArray[np.int64] | None = None,
) -> Simulation:
    """Boot the machine, draw one frame, watch it on the video pins, read its depths back.

    ``fraction_bits`` and ``table`` as in ``frame_commands``.
    """
    job = frame_job(configuration, display_list, memory_seed=memory_seed, stall_seed=stall_seed,
                    waveform=waveform, fraction_bits=fraction_bits, table=table)
    return Answers(configuration, engine.run(job, progress)).frame(0, reading=0, table=table)


def simulate_frame(configuration: MachineConfiguration, display_list: DisplayList, *,
                   engine: str = AUTO, **options: Any) -> Simulation:
    """One frame of ``display_list`` on a machine, simulated by the engine of that name.

    ``engine``   ``verilator``, ``pysim``, or ``auto`` for the fastest that works here
    ``options``  those of ``simulate``, in this module

    The result has the picture as it left the video pins, the depths as they were read back, and
    what they cost; ``compare`` judges it.  Raises ``InputError`` for a list that is too wide for
    the machine and an engine that cannot run here, ``MachineError`` where the machine fails.

    >>> import cardcage
    >>> machine = cardcage.MachineConfiguration(cards="PM", width=16, height=16, fraction_bits=28)
    >>> scene = cardcage.make_display_list("tetra:depth=0", width=16, height=16)
    >>> simulation = cardcage.simulate_frame(machine, scene.display_list, engine="pysim")
    >>> simulation.video.shape, simulation.total
    ((16, 16, 3), 1)
    """
    with engine_errors(engine):
        return simulate(configuration, display_list, make_engine(engine), **options)


@contextmanager
def engine_errors(engine: str, instead: str = "pysim") -> Iterator[None]:
    """``InputError`` where the engine of that name cannot run here, which says what to take
    ``instead``; ``MachineError`` where the machine fails."""
    try:
        yield
    except ToolMissingError as missing:
        raise InputError(f"--engine {engine}: {missing}; or use --engine {instead}") from None
    except (TimeoutError, AssertionError) as error:
        raise MachineError(f"the machine failed: {error}") from error
