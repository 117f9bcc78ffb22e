"""A picture drawn several times one after the other, and what it costs when that goes on.

The machine boots, loads lists where nodes have some, and draws::

    FRAME_START  triangles or DRAW_LISTS  FRAME_END      as often as FRAMES
    READ_DEPTH  READ_COUNTERS

The first frame begins as the machine has booted, the next ones as the frame before is shown; the
last one is what every figure is of.  Where regions are dealt out, they are packed once, before the
second frame, by what the first one cost: the others cost the same.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from ...golden.balancing.table_policy import Policy
from ...golden.cycles.frame_clocks import most_frame_clocks
from ...golden.objects.object_words import commands_before
from ...golden.organisations.organisation_of import organisation_of
from ...golden.planning.scene_needs import fitted
from ...golden.reference.triangle_setup import outline
from ...golden.specification import commands
from ...golden.specification.commands import Opcode, ResponseKind, opcode_of
from ...golden.specification.configuration import MachineConfiguration
from ...golden.specification.display_list import DisplayList
from ...golden.specification.picture import Picture
from ...golden.specification.sampling_grid import Grid
from ..engines.choose_engine import make_engine
from ..engines.engine import EngineRun, Job, Scan
from ..frames.conversation import responses_owed
from ..frames.frame_job import frame_commands
from ..frames.object_figures import ObjectFigures, object_figures
from ..frames.region_figures import RegionFigures, RegionTables
from ..frames.region_host import region_readings, table_commands
from ..frames.responses import Answers, Simulation
from ..frames.simulation import engine_errors

#: From the merged picture of the last but one to that of the last is what a frame takes.
FRAMES = 3


@dataclass(frozen=True)
class Clocks:
    """What a frame takes, in clocks.

    ``boot``   from reset until the first command can be taken
    ``load``   from when the first ``LOAD`` is taken until ``DRAW_LISTS`` is; None where every
               frame sends its triangles
    ``draw``   from the frame's start until all processing elements are done
    ``merge``  from there until scans can show the nodes' pictures as one, of the frame that waits
               least for the one before to be shown
    ``frame``  from one merged picture to the next, of frames that follow one another; a picture
               waits for the beginning of a scan
    """

    boot: int
    load: int | None
    draw: int
    merge: int
    frame: int


@dataclass(frozen=True)
class Latency:
    """Of the last triangle in the list of which a pixel is seen, in clocks from when its command is
    taken, or the one that has it drawn from its list, ``DRAW_LISTS``; in the last frame, or, where
    frames are drawn while others wait to be shown, in the first one, which waits for none.

    ``triangle``  its number
    ``pixel``     x, y on the video output: its first one that is seen, in the order of the scan
    ``merged``    until the picture with it is complete
    ``pins``      until that pixel is on the pins in the first scan that shows the picture
    """

    triangle: int
    pixel: tuple[int, int]
    merged: int
    pins: int


class FrameSequence:
    """The frames of ``display_list`` on a machine, simulated by the engine of that name.

    Raises ``InputError`` for a list that is too wide for the machine and an engine that cannot
    run here, ``MachineError`` where the machine fails.
    """

    def __init__(self, configuration: MachineConfiguration, display_list: DisplayList,
                 engine: str, memory_seed: int | None = None,
                 policy: Policy | None = None) -> None:
        self._configuration = configuration
        self._display_list = display_list
        tables = (None if configuration.regions is None
                  else RegionTables(configuration, [display_list] * FRAMES, policy=policy))
        whole = frame_commands(configuration, display_list,
                               table=None if tables is None else tables.sent(0))
        self._opcodes = [opcode_of(word) for word in whole]
        self._start = self._opcodes.index(Opcode.FRAME_START)
        sent = None if tables is None else tables.sent(1)
        dealing = [] if sent is None else table_commands(configuration, sent)
        self._dealing = len(dealing)
        words = [*whole, *dealing, *whole[self._start:] * (FRAMES - 1),
                 commands.command(Opcode.READ_DEPTH), commands.command(Opcode.READ_COUNTERS),
                 *region_readings(configuration)]
        with engine_errors(engine):
            self._run: EngineRun = make_engine(engine).run(Job(
                configuration, commands=words,
                responses=responses_owed(organisation_of(configuration), words),
                memory_seed=memory_seed,
                maximum_cycles=FRAMES * most_frame_clocks(
                    configuration, max(len(words), display_list.triangles))))
        answers = Answers(configuration, self._run)
        self.simulation: Simulation = answers.frame(
            FRAMES - 1, reading=0, read_back=0,
            table=None if tables is None else tables.table(FRAMES - 1))
        self.regions: RegionFigures | None = (
            None if tables is None else tables.figures(FRAMES - 1, self.simulation))

        self.objects: ObjectFigures | None = object_figures(configuration, display_list,
                                                            self.simulation)

    @property
    def link_words(self) -> int:
        """Of 32 bits, of the first frame and what is loaded for it."""
        return len(self._opcodes) * commands.command_words(self._configuration)

    def _cycles_of(self, kind: ResponseKind) -> list[int]:
        return [cycle for found, _, cycle in self._run.responses if found == kind]

    @cached_property
    def _merged(self) -> list[int]:
        """When each picture was complete."""
        merges = organisation_of(self._configuration).merges
        return self._cycles_of(ResponseKind.MERGED if merges else ResponseKind.FRAME_DRAWN)

    def _taken(self, command: int, frame: int) -> int:
        """When the machine took a command of a frame, by its place in the first one."""
        assert self._run.accepted is not None
        commands_of_frame = len(self._opcodes) - self._start
        dealing = self._dealing if frame else 0
        return int(self._run.accepted[command + dealing + frame * commands_of_frame])

    @property
    def shown_scans(self) -> list[Scan]:
        """All since the first picture was shown."""
        first = self._cycles_of(ResponseKind.FRAME_SHOWN)[0]
        return [scan for scan in self._run.scans if scan.cycle > first]

    @property
    def clocks(self) -> Clocks:
        *_, before, last = self._merged
        return Clocks(boot=self.simulation.boot_cycles, load=self._load(),
                      draw=self.simulation.draw_cycles,
                      merge=self._merge(), frame=last - before)

    def _merge(self) -> int:
        drawn, merged = ([value for found, value, _ in self._run.responses if found == kind]
                         for kind in (ResponseKind.FRAME_DRAWN, ResponseKind.MERGED))
        return min(np.subtract(merged, drawn).tolist()) if merged else 0

    def _load(self) -> int | None:
        makes = self._configuration.objects is not None
        if not self._configuration.list_words and not makes:
            return None
        accepted = self._run.accepted
        assert accepted is not None
        if makes:  # meshes
            return int(accepted[self._start] - accepted[0])
        drawn = self._opcodes.index(Opcode.DRAW_LISTS)
        loads = [place for place, opcode in enumerate(self._opcodes) if opcode == Opcode.LOAD]
        return int(accepted[drawn] - accepted[loads[0]]) if loads else 0

    def latency(self, golden: Picture) -> Latency | None:
        """``golden`` is the picture at the machine's resolution; None where nothing is seen."""
        triangle = int(golden.winner.max(initial=-1))
        if triangle < 0:
            return None
        row, column = np.argwhere(golden.winner == triangle)[0].tolist()
        _, _, x_shift, y_shift = organisation_of(self._configuration).resolution
        x, y = column << x_shift, row << y_shift
        frame = 0 if self._configuration.snoops else FRAMES - 1
        taken = self._taken(self._command_of(triangle), frame)
        shown = self._cycles_of(ResponseKind.FRAME_SHOWN)[frame]
        scan = next(scan.cycle for scan in self._run.scans if scan.cycle > shown)
        pixels = y * self._configuration.timing.horizontal_total + x
        return Latency(triangle, (x, y), merged=self._merged[frame] - taken,
                       pins=scan + pixels * self._configuration.clocks_per_pixel - taken)

    def _command_of(self, triangle: int) -> int:
        """The place of the command that has a triangle drawn, in the first frame."""
        configuration = self._configuration
        if configuration.list_words:
            return self._opcodes.index(Opcode.DRAW_LISTS)
        if configuration.objects is not None:
            return self._start + 1 + commands_before(configuration, self._display_list, triangle)
        organisation = organisation_of(configuration)
        sent = place = organisation.shares(self._display_list).host_place
        if configuration.setup == "host":  # what the host's set-up leaves out is not sent
            fitting = fitted(configuration, self._display_list)
            boxes = outline(fitting, Grid.of(fitting, **organisation.resolution.shifts)).boxes
            sent = place[boxes.primitive]
        assert len(sent) == len(self._opcodes) - self._start - 2
        return self._start + 1 + int(np.count_nonzero(sent < place[triangle]))
