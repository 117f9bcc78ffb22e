"""What every simulation engine takes and gives back."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import NamedTuple, Protocol

import numpy as np
from numpy.typing import NDArray

from ...golden.specification.commands import ResponseKind
from ...golden.specification.configuration import MachineConfiguration
from .activity_record import ActivityRecord

#: Called now and then with the cycles simulated and the responses received so far; with 0 cycles
#: when a model begins to be compiled.
Progress = Callable[[int, int], None]


class Reset(NamedTuple):
    """The machine's reset is high in clock ``cycle``, the first one being 1.  The host drops what
    it offers then, and goes on with the word ``command`` of the job's."""

    cycle: int
    command: int


@dataclass(frozen=True)
class Job:
    """Commands for one machine, from reset on.

    ``commands``         command words, in order; any words, valid or not.  The compiled engine
                         takes them while it runs, so that they may be made one after another
    ``responses``        how many responses the machine owes in all, or since the last reset; the
                         run ends when they are in and a whole scan has been seen since the last
                         ``FRAME_SHOWN``
    ``memory_seed``      None leaves memories zero, a number fills them with random words first
    ``stall_seed``       None is never idle; a number makes the host pause at random on both streams
    ``waveform``         where to write a VCD, if anywhere
    ``maximum_cycles``   raise ``TimeoutError`` beyond: the machine hangs
    ``resets``           clocks in which the machine is reset in mid-run, in ascending order
    """

    configuration: MachineConfiguration
    commands: Sequence[int]
    responses: int
    memory_seed: int | None = None
    stall_seed: int | None = None
    waveform: Path | None = None
    maximum_cycles: int | None = None
    resets: Sequence[Reset] = ()


@dataclass(frozen=True)
class Scan:
    """One whole scan as it left the video pins: uint8 (height, width, 3), highest resolution.

    ``cycle`` is when its first picture pixel was on the pins.
    """

    cycle: int
    picture: NDArray[np.uint8]


@dataclass(frozen=True)
class EngineRun:
    """``responses`` in order with the cycle each came in, every whole scan, and the cost.

    ``seconds`` is the simulation, files included; ``build_seconds`` what it took to compile a
    model before, 0 where none had to be.  ``engine`` is who ran it, ``notes`` what the user should
    know of it.  ``accepted``: int64, the cycle in which the machine took each command, those that a
    reset lost included; None where the engine does not tell.  ``activity``: what the processing
    elements did while they drew, for a machine that is built to ``observe``, where the engine
    records it.
    """

    responses: Sequence[tuple[ResponseKind, int, int]]
    scans: Sequence[Scan]
    cycles: int
    seconds: float
    build_seconds: float = 0.0
    engine: str = ""
    notes: tuple[str, ...] = ()
    accepted: NDArray[np.int64] | None = None
    activity: Sequence[ActivityRecord] = ()


class Engine(Protocol):
    """A simulator of the machine."""

    name: str

    def run(self, job: Job, progress: Progress | None = None) -> EngineRun: ...
