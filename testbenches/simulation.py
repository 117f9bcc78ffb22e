"""A display list through a simulated machine: commands in, pixels and depths out."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from ..golden.planning.scene_needs import fitted
from ..golden.reference import triangle_words
from ..golden.reference.triangle_setup import in_finer_words, prepare
from ..golden.specification import commands
from ..golden.specification.card_order import domains
from ..golden.specification.commands import Opcode, ResponseKind
from ..golden.specification.configuration import MachineConfiguration
from ..golden.specification.display_list import DisplayList
from ..golden.specification.interlace import Interlace
from .activity import ActivityRecord
from .engine import Engine, EngineRun, Job, Progress, Scan


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


def frame_commands(configuration: MachineConfiguration, display_list: DisplayList,
                   fraction_bits: int | None = None) -> list[int]:
    """Frame start, triangles, frame end.

    Where the machine has no set-up of its own the host does it here, at the resolution that the
    machine reports.  With ``fraction_bits``, fewer than the machine's, the host does it with planes
    rounded to these: the machine then draws the picture of one that has no more, value for value
    and clock for clock, if its words have the integer bits for the greater error.  Raises
    ``InputError`` for a list that is too wide for the machine.
    """
    fitting = fitted(configuration, display_list)
    start, end = commands.frame_start(display_list.background), commands.command(Opcode.FRAME_END)
    if configuration.setup == "hardware" and fraction_bits is None:
        return [start, *triangle_words.triangles(configuration, fitting), end]
    interlace = configuration.interlace
    own = configuration.fraction_bits
    prepared = prepare(fitting,
                       fraction_bits=own if fraction_bits is None else fraction_bits,
                       shading=configuration.shading,
                       x_shift=interlace.x_shift, y_shift=interlace.y_shift)
    prepared = in_finer_words(prepared, own)
    return [start, *triangle_words.prepared_triangles(configuration, prepared), end]


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
    return _interpret(configuration, engine.run(job, progress))


def frame_job(
    configuration: MachineConfiguration,
    display_list: DisplayList,
    *,
    memory_seed: int | None = None,
    stall_seed: int | None = None,
    waveform: Path | None = None,
    fraction_bits: int | None = None,
) -> Job:
    """Everything an engine needs to run one frame with depths and counters read back."""
    words = [*frame_commands(configuration, display_list, fraction_bits),
             commands.command(Opcode.READ_DEPTH), commands.command(Opcode.READ_COUNTERS)]
    interlace, elements = configuration.interlace, configuration.processing_elements
    boot = elements + 3  # domains, units, picture, booted
    depths = sum(units for _, units in domains(configuration.cards)) * interlace.words
    return Job(
        configuration=configuration,
        commands=words,
        responses=boot + 2 + depths + 2 * elements,
        memory_seed=memory_seed,
        stall_seed=stall_seed,
        waveform=waveform,
        maximum_cycles=cycle_bound(configuration, words),
    )


def cycle_bound(configuration: MachineConfiguration, words: Sequence[int]) -> int:
    """More cycles than any frame can take: beyond, the machine hangs.

    Every triangle waits for three divisions and covers the screen, every pixel costs a scan slot,
    a read and a write; then the stalls of the most patient host, and some scans.
    """
    pixels = configuration.width * configuration.height
    divisions = 3 * configuration.setup_interval
    return (1000 + (len(words) + 4) * (6 * pixels + 16 * configuration.height + 64 + divisions)
            + 30 * configuration.interlace.units * configuration.interlace.words
            + 4 * configuration.cycles_per_scan)


def _interpret(configuration: MachineConfiguration, run: EngineRun) -> Simulation:
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


def expected_video(configuration: MachineConfiguration,
                   color: NDArray[np.uint8]) -> NDArray[np.uint8]:
    """A picture at the machine's resolution as the scan shows it: each pixel as often as the
    highest resolution has it."""
    interlace = configuration.interlace
    video = color.repeat(1 << interlace.y_shift, axis=0).repeat(1 << interlace.x_shift, axis=1)
    return video[: configuration.height, : configuration.width]
