"""What a machine answered, understood: one frame, as it left the machine."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ...golden.organisations.organisation_of import organisation_of
from ...golden.specification.commands import ResponseKind
from ...golden.specification.configuration import MachineConfiguration
from ..engines.activity_record import ActivityRecord
from ..engines.engine import EngineRun, Scan


class MachineError(RuntimeError):
    """The machine answered something it should not have, or nothing.

    >>> import cardcage
    >>> raise cardcage.MachineError("the machine hangs")
    Traceback (most recent call last):
    cardcage.testbenches.frames.responses.MachineError: the machine hangs
    """


@dataclass(frozen=True)
class Work:
    """What one processing element owns and did for the last frame, in its own count."""

    first_unit: int
    units: int
    fragments: int
    busy_cycles: int



@dataclass(frozen=True)
class Simulation:
    """One frame, as it left the machine.

    ``video``            uint8 (height, width, 3), highest resolution, from the video pins
    ``depth``            int64 (h, w) at the machine's resolution, read back through the controller;
                         -1 where the pixel's unit belongs to no processing element
    ``resolution``       width and height that the machine reported
    ``work``             one entry per processing element, left to right
    ``owned``, ``total`` memory units in some domain, memory units in the cage
    ``boot_cycles``      reset to ready
    ``draw_cycles``      frame start to the last processing element's done
    ``repeated_scans``   scans that began with the old picture since the frame start
    ``scans``            every whole scan, in order
    ``activity``         what the processing elements did meanwhile; None where nothing tells
    """

    video: NDArray[np.uint8]
    depth: NDArray[np.int64]
    resolution: tuple[int, int]
    work: Sequence[Work]
    owned: int
    total: int
    boot_cycles: int
    draw_cycles: int
    repeated_scans: int
    scans: Sequence[Scan]
    engine: str
    cycles: int
    seconds: float
    build_seconds: float = 0.0
    notes: tuple[str, ...] = ()
    activity: ActivityRecord | None = None



def interpret(configuration: MachineConfiguration, run: EngineRun) -> Simulation:
    values: dict[ResponseKind, list[int]] = {kind: [] for kind in ResponseKind}
    for kind, value, _ in run.responses:
        values[kind].append(value)
    if values[ResponseKind.ERROR]:
        raise MachineError(f"the machine reports fault {values[ResponseKind.ERROR][0]}")
    organisation = organisation_of(configuration)
    expected, picture = organisation.resolution[:2], values[ResponseKind.PICTURE][0]
    resolution = picture & 0xFFFF, picture >> 16
    if resolution != expected:
        raise MachineError("the machine draws {}x{}, expected {}x{}".format(*resolution, *expected))
    domains = [(value >> 16, value & 0xFFFF) for value in values[ResponseKind.DOMAIN]]
    units = values[ResponseKind.UNITS][0]
    return Simulation(
        video=run.scans[-1].picture,
        depth=organisation.depth_image(values[ResponseKind.DEPTH]),
        resolution=resolution,
        work=[Work(first, count, fragments, busy) for (first, count), fragments, busy in
              zip(domains, values[ResponseKind.FRAGMENTS], values[ResponseKind.BUSY],
                  strict=True)],
        owned=units >> 16,
        total=units & 0xFFFF,
        boot_cycles=values[ResponseKind.BOOTED][0],
        draw_cycles=values[ResponseKind.FRAME_DRAWN][0],
        repeated_scans=values[ResponseKind.FRAME_SHOWN][0],
        scans=run.scans,
        engine=run.engine,
        cycles=run.cycles,
        seconds=run.seconds,
        build_seconds=run.build_seconds,
        notes=run.notes,
        activity=run.activity[0] if run.activity else None,
    )
