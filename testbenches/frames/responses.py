"""What a machine answered, understood: one frame, as it left the machine."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ...golden.specification.commands import ResponseKind
from ...golden.specification.configuration import MachineConfiguration
from ...golden.specification.interlace import Interlace
from ..engines.activity_record import ActivityRecord
from ..engines.engine import EngineRun, Scan


class MachineError(RuntimeError):
    """The machine answered something it should not have."""



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
    ``interlace``        resolution and interlace the machine settled on
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
    interlace: Interlace
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
    interlace = configuration.interlace
    picture = values[ResponseKind.PICTURE][0]
    if (picture & 0xFFFF, picture >> 16) != (interlace.width, interlace.height):
        raise MachineError(f"the machine draws {picture & 0xFFFF}x{picture >> 16}, expected "
                           f"{interlace.width}x{interlace.height}")
    domains = [(value >> 16, value & 0xFFFF) for value in values[ResponseKind.DOMAIN]]
    units = values[ResponseKind.UNITS][0]
    return Simulation(
        video=run.scans[-1].picture,
        depth=depth_image(interlace, domains, values[ResponseKind.DEPTH]),
        interlace=interlace,
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



def depth_image(interlace: Interlace, domains: Sequence[tuple[int, int]],
                 words: Sequence[int]) -> NDArray[np.int64]:
    """Depth words, in the order of the read-back, put where their pixels are."""
    units = np.concatenate([np.arange(first, first + count) for first, count in domains])
    unit, address = np.meshgrid(units, np.arange(interlace.words), indexing="ij")
    x, y = interlace.pixel(unit, address)
    inside = (x < interlace.width) & (y < interlace.height)  # padding words hold no pixel
    depth = np.full((interlace.height, interlace.width), -1, np.int64)
    depth[y[inside], x[inside]] = np.array(words, np.int64).reshape(unit.shape)[inside]
    return depth

