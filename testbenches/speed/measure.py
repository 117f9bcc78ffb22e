"""Measures cases on a simulated machine, and compares each picture with the golden one.

All cases of a machine go through one simulation, a frame each::

    FRAME_START  READ_COUNTERS  n triangles  READ_COUNTERS  2n triangles  READ_COUNTERS  FRAME_END

The machine takes ``READ_COUNTERS`` only when every processing element has
finished, its last write included; so T(n) is the time from the clock in which it
takes the first of n triangles to the clock in which it takes the counters'
command, a few clocks after the last write.  These few are in T(n) and T(2n) alike.

Where regions of the screen are dealt out, the frame is drawn by a table that was packed by what
the very same frame costs: as the next one of a picture that stands still.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ...golden.cycles.frame_clocks import most_frame_clocks
from ...golden.organisations.organisation_of import organisation_of
from ...golden.reference.exact import depth_complexity
from ...golden.specification import commands
from ...golden.specification.commands import Opcode
from ...golden.specification.configuration import MachineConfiguration
from ..engines.activity_record import ActivityRecord
from ..engines.engine import Engine, EngineRun, Job, Progress
from ..frames.compare import compare
from ..frames.conversation import responses_owed
from ..frames.frame_job import frame_commands
from ..frames.region_figures import RegionFigures, RegionTables
from ..frames.region_host import region_readings, table_commands
from ..frames.responses import Answers
from ..frames.simulation import engine_errors
from ..support.machine_error import MachineError
from .cases import CaseLists, Order

_READ_COUNTERS = commands.command(Opcode.READ_COUNTERS)
_READ_DEPTH = commands.command(Opcode.READ_DEPTH)

#: How often a frame's counters are read.
_READINGS = 3


@dataclass(frozen=True)
class Measurement:
    """A case on a machine; the picture was equal to the golden one.

    ``triangles``          n, of which T(n) and T(2n) were measured
    ``fragments``          of n triangles
    ``cycles_once``        T(n): first of n triangles taken … all elements finished
    ``cycles_twice``       T(2n)
    ``element_fragments``  of 2n triangles, per processing element
    ``seconds``            its share of the simulation, compiling not counted
    ``activity``           what the processing elements did in T(2n); None where nothing tells
    ``regions``            what regions cost that are dealt out, of both; None where there are none
    """

    case: str
    order: Order
    triangles: int
    fragments: int
    cycles_once: int
    cycles_twice: int
    element_fragments: tuple[int, ...]
    seconds: float
    activity: ActivityRecord | None = None
    regions: RegionFigures | None = None

    @property
    def sustained_cycles(self) -> int:
        """T(2n) - T(n): n triangles while the machine is busy with others before and after."""
        return self.cycles_twice - self.cycles_once

    @property
    def cycles_per_triangle(self) -> float:
        return self.sustained_cycles / self.triangles

    @property
    def cycles_per_fragment(self) -> float:
        return self.sustained_cycles / self.fragments

    @property
    def fragments_per_clock(self) -> float:
        return self.fragments / self.sustained_cycles

    @property
    def utilisation(self) -> float:
        """Fragments per clock and processing element."""
        return self.fragments_per_clock / len(self.element_fragments)

    @property
    def latency(self) -> int:
        """What T(n) has besides n triangles at the sustained rate: to fill and to drain."""
        return self.cycles_once - self.sustained_cycles


class DifferentError(MachineError):
    """A picture is not the golden one: there is no speed to speak of."""


@dataclass(frozen=True)
class _Frame:
    """Where the commands of a case's frame lie in its job."""

    case: CaseLists
    start: int
    triangles_once: int
    triangles_twice: int
    tables: RegionTables | None

    @property
    def first(self) -> tuple[int, int]:
        """The first command of n and of 2n triangles."""
        return self.start + 2, self.start + 3 + self.triangles_once

    @property
    def barriers(self) -> tuple[int, int]:
        """The command that waits for them."""
        once, twice = self.first
        return once + self.triangles_once, twice + self.triangles_twice


def measure(configuration: MachineConfiguration, cases: Sequence[CaseLists], engine: Engine,
            progress: Progress | None = None) -> list[Measurement]:
    """Draw every case, compare every pixel and every depth; what it took, in the same order.

    Raises ``DifferentError`` where a picture or a number of fragments is not the golden one,
    ``MachineError`` where the machine does not deliver, ``InputError`` where the engine cannot run.
    """
    job, frames = _job(configuration, cases)
    with engine_errors(engine.name, instead="model"):
        run = engine.run(job, progress)
    answers = Answers(configuration, run)
    return [_measurement(configuration, frame, number, run, answers)
            for number, frame in enumerate(frames)]


def packed_tables(configuration: MachineConfiguration, case: CaseLists) -> RegionTables | None:
    """The second one is that by which a case is drawn; None where no regions are dealt out."""
    return (None if configuration.regions is None else
            RegionTables(configuration, [case.frame] * 2))


def _job(configuration: MachineConfiguration,
         cases: Sequence[CaseLists]) -> tuple[Job, list[_Frame]]:
    words: list[int] = []
    frames = []
    for case in cases:
        start, *once, end = frame_commands(configuration, case.once)
        _, *twice, _ = frame_commands(configuration, case.twice)
        tables = packed_tables(configuration, case)
        if tables is not None:
            words += table_commands(configuration, tables.table(1))
        frames.append(_Frame(case, len(words), len(once), len(twice), tables))
        words += [start, _READ_COUNTERS, *once, _READ_COUNTERS, *twice, _READ_COUNTERS, end,
                  _READ_DEPTH, *region_readings(configuration)]
    return Job(
        configuration=configuration,
        commands=words,
        responses=responses_owed(organisation_of(configuration), words),
        memory_seed=1,
        maximum_cycles=len(cases) * most_frame_clocks(configuration, len(words)),
    ), frames


def _measurement(configuration: MachineConfiguration, frame: _Frame, number: int, run: EngineRun,
                 answers: Answers) -> Measurement:
    case = frame.case
    # Each record of activity, too, ends as the counters are read.
    readings = range(_READINGS * number, _READINGS * (number + 1))
    tables = frame.tables
    simulation = answers.frame(number, reading=readings[-1], counted=number,
                               table=None if tables is None else tables.table(1))
    shifts = organisation_of(configuration).resolution.shifts
    fragments = [int(depth_complexity(part, **shifts).sum()) for part in (case.once, case.twice)]
    where = f"{case.name}, {case.order} order, on {configuration.cards}"
    comparison = compare(configuration, case.frame, simulation)
    if (first := comparison.first_difference) is not None:
        raise DifferentError(
            f"{where}: {comparison.pixels_different:,} colours and {comparison.depths_different:,} "
            f"depths differ from the golden picture, first at {first.pixel}")
    counts = answers.fragments[readings.start:readings.stop]
    drawn = np.diff(counts.sum(axis=1))
    if drawn.tolist() != fragments:
        raise DifferentError(f"{where}: {drawn.tolist()} fragments drawn, not {fragments}")
    regions = None if tables is None else tables.figures(1, simulation)
    if regions is not None and regions.differences:
        raise DifferentError(f"{where}: {regions.differences[0]}")
    assert run.accepted is not None
    once, twice = (int(run.accepted[barrier] - run.accepted[first])
                   for first, barrier in zip(frame.first, frame.barriers, strict=True))
    return Measurement(case.name, case.order, case.once.triangles, fragments[0], once, twice,
                       tuple((counts[-1] - counts[-2]).tolist()), run.seconds / answers.frames,
                       simulation.activity, regions)
