"""Speed against error of one scene's machine, precision by precision."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterable
from dataclasses import asdict, dataclass, replace
from pathlib import Path
from typing import Any, Literal

from ...golden.organisations.organisation_of import organisation_of
from ...golden.planning.machine_plan import plan
from ...golden.planning.scene_needs import fitted
from ...golden.precision.precision_study import (
    Float32Point,
    FormatPoint,
    FractionBitsPoint,
    PrecisionStudy,
    formats,
)
from ...golden.precision.unquantised import unquantised_scene
from ...golden.scene_display_list import SceneDisplayList
from ...golden.specification.configuration import MachineConfiguration
from ...golden.specification.errors import InputError
from ..engines.choose_engine import AUTO
from ..fpga.place_and_route import Part, Placement, missing_tools, place_and_route, recall_placement
from ..frames.compare import compare
from ..frames.simulation import simulate_frame
from ..machine_options import MachineOptions, load_scene, resolution_warnings
from ..support.measurement_cache import measured_once, package_hash

#: In place of an engine: no frame is simulated.
NO_ENGINE = "none"

#: Called with a few words before each step.
Step = Callable[[str], None]


@dataclass(frozen=True)
class PrecisionOptions(MachineOptions):
    """What can be asked of a study of precision; its fraction bits are swept.

    ``engine``           a name of ``engines.ENGINES``, ``auto`` or ``none``
    ``simulate``         ``few`` rows (see ``few``) or ``all``; None: all where a frame is quick,
                         which is not in pysim
    ``place_and_route``  measure what is not known yet: of the few, or of all if ``simulate`` is
                         ``all``
    ``seeds``            of place and route, counted from 1
    """

    engine: str = AUTO
    simulate: Literal["few", "all"] | None = None
    place_and_route: bool = False
    seeds: int = 3


@dataclass(frozen=True)
class Frame:
    """A simulated frame.

    ``cycles``     frame start to the last processing element's done
    ``fragments``  tested, of all processing elements
    ``equal``      every colour on the video pins and every depth read back is the bit-true model's
    ``engine``     that simulated it
    """

    cycles: int
    fragments: int
    equal: bool
    engine: str


@dataclass(frozen=True)
class PrecisionRow:
    """One number of fraction bits: its errors, and what was measured of its machine, or None."""

    point: FractionBitsPoint
    frame: Frame | None
    placement: Placement | None


@dataclass(frozen=True)
class Precision:
    """A study, complete.

    ``machine``        the exact one
    ``extent``         of the largest triangle, right and down together, in pixels
    ``rows``           fewest fraction bits first; the last is exact
    ``formats``        end to end, at exact, one for each format of the display list
    ``missing_tools``  what to install for area and clock; None: nothing
    """

    scene: SceneDisplayList
    machine: MachineConfiguration
    extent: int
    rows: tuple[PrecisionRow, ...]
    float32: Float32Point
    formats: tuple[FormatPoint, ...]
    missing_tools: str | None
    command_line: str | None
    warnings: tuple[str, ...]
    wall_seconds: float

    def problems(self) -> list[str]:
        """What is not as it must be, a line each."""
        lines = []
        for row in self.rows:
            point, bits = row.point, f"{row.point.fraction_bits} fraction bits"
            if not point.within_bound:
                error = point.error
                lines.append(f"{bits}: depth off by {error.depth_anywhere:g} LSB, colour by "
                             f"{error.color_maximum:g}, {error.wrong_pixels} pixels wrong; the "
                             f"bound is {point.bound}")
            if row.frame is not None and not row.frame.equal:
                lines.append(f"{bits}: the simulated frame differs from the bit-true model")
        return lines

    def frame(self, row: PrecisionRow) -> Frame | None:
        """The row's own, or else that of the nearest number of fraction bits that has one."""
        simulated = [other for other in self.rows if other.frame is not None]
        if not simulated:
            return None
        nearest = min(simulated, key=lambda other: abs(other.point.fraction_bits
                                                       - row.point.fraction_bits))
        return nearest.frame

    def fragments_per_clock(self, row: PrecisionRow) -> float | None:
        """Fragments a clock of one processing element, while the frame is drawn."""
        frame = self.frame(row)
        if frame is None or not frame.cycles:
            return None
        return frame.fragments / (frame.cycles * self.machine.processing_elements)

    def megafragments_per_second(self, row: PrecisionRow) -> float | None:
        """Millions of fragments a second of one processing element, at its median clock rate."""
        rate = self.fragments_per_clock(row)
        if rate is None or row.placement is None:
            return None
        return rate * row.placement.median_mhz


def few(study: PrecisionStudy) -> set[int]:
    """The fraction bits that are worth a long measurement: none, those that hold depths to one
    LSB, and the exact ones."""
    within_one = [bits for bits in study.sweep() if study.bound(bits) <= 1]
    return {0, within_one[0], study.exact_fraction_bits}


def expected_steps(options: PrecisionOptions) -> int:
    """About as many steps as a study takes."""
    return 45 + (3 * options.seeds if options.place_and_route else 0)


def measure_precision(scene: str | Path, options: PrecisionOptions | None = None,
                      command_line: str | None = None,
                      step: Step = lambda doing: None) -> Precision:
    """Measure a scene at every precision.

    Frames and placements are kept in the cache one by one: where a run was interrupted, the next
    goes on.  Raises ``InputError`` for whatever cannot be used, ``MachineError`` where a machine
    delivers no frame; a bound that is exceeded is no exception: see ``Precision.problems``.
    """
    began = time.perf_counter()
    options = options or PrecisionOptions()
    step("loading the scene")
    loaded = load_scene(scene, options)
    machine = plan(loaded.display_list,
                   **replace(options, fraction_bits="exact").for_plan()).configuration
    looking = {name: value for name, value in options.looking().items() if name != "background"}
    ideal = unquantised_scene(scene, loaded.display_list,
                              "flat" if options.shading == "flat" else "gouraud", **looking)
    shifts = organisation_of(machine).resolution.shifts
    display_list = fitted(machine, loaded.display_list)
    step("drawing the picture before quantisation")
    study = PrecisionStudy(display_list, ideal, shading=machine.shading,
                           **shifts)
    machines = {bits: plan(loaded.display_list, **replace(options, fraction_bits=bits).for_plan()
                           ).configuration for bits in study.sweep()}
    points = []
    for bits in study.sweep():
        step(f"drawing with {bits} fraction bits")
        points.append(study.at_fraction_bits(bits))
    step("drawing in float32")
    float32 = study.in_float32()
    format_points = []
    own = loaded.display_list
    for sub_bits, depth_bits in formats(own.sub_bits, own.depth_bits):
        step(f"drawing with {sub_bits} sub-pixel and {depth_bits} depth bits")
        format_points.append(study.at_format(sub_bits, depth_bits))
    frames = _frames(study, machines, options, step)
    placements = _placements(study, machines, options, step)
    return Precision(
        scene=loaded,
        machine=machine,
        extent=study.extent,
        rows=tuple(PrecisionRow(point, frames.get(point.fraction_bits),
                                placements.get(point.fraction_bits)) for point in points),
        float32=float32,
        formats=tuple(format_points),
        missing_tools=missing_tools(),
        command_line=command_line,
        warnings=(*loaded.notes, *resolution_warnings(machine)),
        wall_seconds=time.perf_counter() - began,
    )


def common_model(machines: Iterable[MachineConfiguration]) -> MachineConfiguration:
    """One machine that draws as each of these, which differ in precision alone, when it is told
    planes of their fraction bits.

    It has the most fraction bits, and the most integer bits, of them all.  Sums of words with
    zeros at the end have zeros there, and a wider word holds the same number with its sign
    repeated; nothing but the words' width depends on either.
    """
    machines = tuple(machines)

    def widths(depth_plane: int, channel_plane: int, fraction_bits: int) -> dict[str, Any]:
        return {"fraction_bits": fraction_bits, "depth_integer_bits": depth_plane,
                "channel_integer_bits": channel_plane}

    widest = widths(max(machine.depth_plane_bits - machine.fraction_bits for machine in machines),
                    max(machine.channel_plane_bits - machine.fraction_bits
                        for machine in machines),
                    max(machine.fraction_bits for machine in machines))
    [model] = {replace(machine, **widest) for machine in machines}
    return model


def _frames(study: PrecisionStudy, machines: dict[int, MachineConfiguration],
            options: PrecisionOptions, step: Step) -> dict[int, Frame]:
    """Simulated frames by fraction bits, the exact one first."""
    frames: dict[int, Frame] = {}
    if options.engine == NO_ENGINE:
        return frames
    wanted = few(study) if options.simulate == "few" else set(study.sweep())
    model = common_model(machines.values())  # compiled once, for all precisions
    for bits in sorted(wanted, reverse=True):
        # A model of pysim needs no compiling, but as long for a frame as all the rest.
        slow = frames and frames[study.exact_fraction_bits].engine == "pysim"
        if slow and options.simulate is None and bits not in few(study):
            continue
        step(f"simulating {bits} fraction bits")
        frames[bits] = _frame(study, model, machines[bits], options.engine)
    return frames


def _frame(study: PrecisionStudy, model: MachineConfiguration, machine: MachineConfiguration,
           engine: str) -> Frame:
    display_list, bits = study.display_list, machine.fraction_bits

    def simulated() -> dict[str, Any]:
        simulation = simulate_frame(model, display_list, engine=engine, fraction_bits=bits)
        return asdict(Frame(
            cycles=simulation.draw_cycles,
            fragments=sum(work.fragments for work in simulation.work),
            equal=compare(machine, display_list, simulation).equal,
            engine=simulation.engine,
        ))

    return Frame(**measured_once(
        ("frame", package_hash(), repr(model), str(bits), engine,
         display_list.position.tobytes().hex(), display_list.depth.tobytes().hex(),
         display_list.color.tobytes().hex()), simulated))


def _placements(study: PrecisionStudy, machines: dict[int, MachineConfiguration],
                options: PrecisionOptions, step: Step) -> dict[int, Placement]:
    """Placements by fraction bits: measured now where that is asked for, else remembered."""
    wanted = set()
    if options.place_and_route:
        wanted = set(study.sweep()) if options.simulate == "all" else few(study)
    seeds = range(1, options.seeds + 1)
    placements = {}
    for bits, machine in machines.items():
        if bits in wanted:
            step(f"translating the machine of {bits} fraction bits")
            try:
                placements[bits] = place_and_route(Part(machine), seeds, step)
            except InputError as error:
                raise InputError(f"{error}; leave --place-and-route out for the rest") from None
        elif (known := recall_placement(Part(machine), seeds)) is not None:
            placements[bits] = known
    return placements
