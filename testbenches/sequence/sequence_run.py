"""The pictures of a sequence on one machine that is booted once, and which scan shows which.

A scan begins every so many clocks, from reset on, and a finished picture takes the place of the
last one as a scan begins.  So picture i is on the video pins from the scan that follows its end,
which is r scans after the first that begins after its ``FRAME_START``, r as ``FRAME_SHOWN`` says,
up to the last one before the first of picture i + 1.  Where the next picture is started before
another scan begins that is 1 + r scans, r the next one's.  Scans that begin with picture i before
that start, while something is read back or a table is made, come on top: ``FRAME_SHOWN`` does not
count them.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

from ...golden.balancing.table_policy import Policy
from ...golden.cycles.frame_clocks import most_frame_clocks
from ...golden.organisations.organisation_of import organisation_of
from ...golden.specification import commands
from ...golden.specification.commands import Opcode, ResponseKind, opcode_of
from ...golden.specification.configuration import MachineConfiguration
from ...golden.specification.display_list import DisplayList
from ..engines.choose_engine import make_engine
from ..engines.engine import EngineRun, Job, Progress
from ..frames.compare import Comparison, compare
from ..frames.conversation import responses_owed
from ..frames.frame_job import frame_commands
from ..frames.object_figures import ObjectFigures, object_figures
from ..frames.region_figures import RegionFigures, RegionTables
from ..frames.region_host import region_readings
from ..frames.responses import NOT_READ, Answers, Simulation
from ..frames.simulation import engine_errors
from ..support.machine_error import MachineError

#: Of which pictures something is read back.
Reading = Literal["last", "all"]

_READ_DEPTH = commands.command(Opcode.READ_DEPTH)
_READ_COUNTERS = commands.command(Opcode.READ_COUNTERS)

#: Commands of a picture besides its triangles, at most.
_OTHERS = 8


class SequenceCommands(Sequence[int]):
    """The host's commands for all pictures, each picture's made when they are asked for.

    Depths and counters are read after the last picture, or after each.  ``starts`` are the places
    of the ``FRAME_START`` of those that have been asked for one after another.  ``tables`` are
    those by which regions are dealt out for each, if they are, by ``policy``.
    """

    def __init__(self, configuration: MachineConfiguration, lists: Sequence[DisplayList],
                 depths: Reading, counters: Reading = "all", *,
                 policy: Policy | None = None) -> None:
        self.starts: list[int] = []
        self._configuration = configuration
        self._lists = lists
        self._readings = _readings(configuration, depths, counters)
        self.tables = (None if configuration.regions is None
                       else RegionTables(configuration, lists, policy=policy))

    def of(self, number: int) -> list[int]:
        words = frame_commands(self._configuration, self._lists[number],
                               table=None if self.tables is None else self.tables.sent(number))
        return [*words, *(word for word, whose in self._readings.items()
                          if whose == "all" or number == len(self._lists) - 1)]

    def __iter__(self) -> Iterator[int]:
        self.starts, place = [], 0
        for number in range(len(self._lists)):
            words = self.of(number)
            of_start = next(place for place, word in enumerate(words)
                            if opcode_of(word) == Opcode.FRAME_START)
            self.starts.append(place + of_start)
            place += len(words)
            yield from words

    def __len__(self) -> int:
        return sum(len(self.of(number)) for number in range(len(self._lists)))

    def __getitem__(self, place: Any) -> Any:
        return list(self)[place]


def _readings(configuration: MachineConfiguration, depths: Reading, counters: Reading
              ) -> dict[int, Reading]:
    """After which pictures each of these commands is sent."""
    return {_READ_DEPTH: depths, _READ_COUNTERS: counters,
            **dict.fromkeys(region_readings(configuration), counters)}


@dataclass(frozen=True, eq=False)
class SequenceFrame:
    """One picture of a sequence, as it left the machine, judged.

    ``simulation``  its first scan; its depths, and its work, where they were read back
    ``comparison``  with the golden picture
    ``first_scan``  the number of the scan that shows it first, counted from reset
    ``scans``       on how many it was seen; of the last picture, how many were waited for
    ``scans_before_next_start``  how many of them, its first one left out, began before the start of
                    the next picture was taken; None of the last picture
    ``wrong_scans`` those of them that do not show the golden picture
    ``shown``       the clock in which the machine said that it is shown
    ``regions``     what its regions cost; None where none are dealt out
    ``objects``     what was made of its objects; None where the machine takes none
    """

    number: int
    triangles: int
    simulation: Simulation
    comparison: Comparison
    first_scan: int
    scans: int
    scans_before_next_start: int | None
    wrong_scans: int
    shown: int
    regions: RegionFigures | None = None
    objects: ObjectFigures | None = None

    @property
    def equal(self) -> bool:
        return self.comparison.equal and not self.wrong_scans


def simulate_sequence(configuration: MachineConfiguration, lists: Sequence[DisplayList],
                      engine: str, *, triangles: int, depths: Reading = "last",
                      counters: Reading = "all", policy: Policy | None = None,
                      progress: Progress | None = None, memory_seed: int | None = None,
                      stall_seed: int | None = None) -> Iterator[SequenceFrame]:
    """Each picture of ``lists``, drawn one after another and compared on every scan.

    ``triangles`` is how many the longest list has; ``depths`` and ``counters`` say of which
    pictures these are read: a machine that merges one while it draws the next does not do so where
    it is asked in between.  ``policy`` is as ``RegionHost`` has it.  Lists are asked for, and
    prepared, while earlier ones are simulated.
    Raises ``InputError`` for a list that is too wide for the machine and an engine that cannot run
    here, ``MachineError`` where the machine fails, or a scan shows what was never to be seen.
    """
    frames = len(lists)
    often = [commands.command(Opcode.FRAME_END)] * frames
    reads = [word for word, whose in _readings(configuration, depths, counters).items()
             for _ in range(frames if whose == "all" else 1)]
    words = SequenceCommands(configuration, lists, depths, counters, policy=policy)
    others = _OTHERS + (0 if configuration.regions is None else configuration.dealt_regions.count)
    job = Job(
        configuration, words,
        responses_owed(organisation_of(configuration), [*often, *reads]),
        memory_seed=memory_seed, stall_seed=stall_seed,
        maximum_cycles=frames * most_frame_clocks(configuration, triangles + others))
    with engine_errors(engine):
        run = make_engine(engine).run(job, progress)
    assert run.accepted is not None
    return _judged(configuration, lists, run, run.accepted[words.starts], words.tables, depths,
                   counters)


def _judged(configuration: MachineConfiguration, lists: Sequence[DisplayList], run: EngineRun,
            starts: NDArray[np.int64], tables: RegionTables | None, depths: Reading,
            counters: Reading) -> Iterator[SequenceFrame]:
    """``starts``: the clock in which the machine took each picture's start, the first being 1."""
    answers = Answers(configuration, run)
    scan_clocks = configuration.cycles_per_scan
    scans = {(scan.cycle - 1) // scan_clocks: scan.picture for scan in run.scans}
    shown = [(scan, cycle) for kind, scan, cycle in run.responses
             if kind == ResponseKind.FRAME_SHOWN]
    # A scan that begins in the clock of the start counts.
    after_start = [-(-(int(start) - 1) // scan_clocks) for start in starts]
    first = [scan + repeated for scan, (repeated, _) in zip(after_start, shown, strict=True)]
    ends = [*first[1:], max(scans) + 1]
    if any(scans[number].any() for number in scans if number < first[0]):
        raise MachineError("something was seen before the first picture was shown")
    for number, display_list in enumerate(lists):
        last = number == len(lists) - 1
        table = None if tables is None else tables.table(number)
        simulation = answers.frame(number, table=table, **{
            name: number if whose == "all" else 0 if last else NOT_READ
            for name, whose in (("reading", counters), ("read_back", depths))})
        seen = range(first[number], ends[number])
        if not seen:
            raise MachineError(f"picture {number} was never shown: the next one took its scan")
        simulation = replace(simulation, video=scans[seen[0]])
        comparison = compare(configuration, display_list, simulation)
        different = [(scans[scan] != comparison.expected).any(axis=2) & ~comparison.color_orphans
                     for scan in seen]
        # Where a bus draws ahead, the next one is started before this one is shown.
        waited = None if last else max(0, after_start[number + 1] - seen[0] - 1)
        yield SequenceFrame(number, display_list.triangles, simulation, comparison, seen[0],
                            len(seen), waited, sum(map(bool, map(np.any, different))),
                            shown[number][1],
                            None if tables is None else tables.figures(number, simulation),
                            object_figures(configuration, display_list, simulation))
