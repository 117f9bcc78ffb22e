"""Draw a sequence of pictures on one simulated machine, compare every scan, report."""

from __future__ import annotations

import time
from dataclasses import dataclass
from pathlib import Path
from typing import Any, get_args

from ..golden.cycles.frame_clocks import predict_frame
from ..golden.specification.configuration import MachineConfiguration
from ..golden.specification.errors import InputError
from .engines.engine import Progress
from .frames.node_counts import golden_traffic
from .frames.rendering import Rendering
from .frames.setup_timing import setup_timing
from .frames.wrong_counts import wrong_counts
from .machine_options import resolution_warnings
from .render import DEFAULT_SCENE, RenderOptions
from .sequence.sequence_run import Reading, SequenceFrame, simulate_sequence
from .support.atomic_output import atomic_folder, output_errors
from .views import asked_views
from .views.asked_views import machine_for_frames
from .views.scene_frames import SceneFrames


@dataclass(frozen=True)
class FramesOptions(RenderOptions):
    """What can be asked of a sequence besides a rendering.

    ``frames``  pictures, which ``path`` may say instead
    ``turn``    degrees by which a mesh turns from one to the next; None: those of Ellsworth 1994
    ``path``    a CSV file with the view of each
    ``depth``   whose depths are read back and compared, the last one's or all
    """

    frames: int | None = None
    turn: float | None = None
    path: Path | None = None
    depth: Reading = "last"


@dataclass(frozen=True, eq=False)
class FramesRendering:
    """The pictures of a sequence, judged.

    ``shown``   the one that the report shows: the first that differs, or else the last
    ``report``  where ``report.html`` is, if it was written
    """

    frames: tuple[SequenceFrame, ...]
    shown: Rendering
    report: Path | None = None

    @property
    def equal(self) -> bool:
        """Every picture and every count are as the golden model has them."""
        return not self.shown.wrong_counts and all(frame.equal for frame in self.frames)


@dataclass(frozen=True)
class FramesJob:
    """A scene's pictures and a machine, checked and ready to be simulated; see
    ``prepare_frames``."""

    lists: SceneFrames
    configuration: MachineConfiguration
    options: FramesOptions
    command_line: str | None
    warnings: tuple[str, ...]
    began: float

    def expected_cycles(self) -> int:
        """About what the simulation takes, as if all pictures were like the first one."""
        first = predict_frame(self.configuration, self.lists[0], setup_timing(self.configuration))
        scans = -(-(first.draw + first.merge) // first.scan)
        read = first.read_back * (len(self.lists) - 1 if self.options.depth == "all" else 0)
        return first.total + scans * first.scan * (len(self.lists) - 1) + read

    def run(self, out: Path | None = None, progress: Progress | None = None) -> FramesRendering:
        """Simulate, compare, and write the report to the folder ``out``.

        Whether it can be written is found out first.  Raises ``InputError`` where not, and
        ``MachineError`` where the machine does not deliver a picture; then none is written.
        """
        if out is None:
            return self._drawn(progress)
        from .reports.sequence_report import (  # charts take a second to load
            SEQUENCE_FILES,
            write_sequence_report,
        )

        with atomic_folder(out, SEQUENCE_FILES) as folder:
            drawn = self._drawn(progress, out / "report.html")
            with output_errors(out, "--out"):
                write_sequence_report(drawn.shown, drawn.frames, self.lists.views_as_seen, folder)
        return drawn

    def _drawn(self, progress: Progress | None, report: Path | None = None) -> FramesRendering:
        frames = tuple(simulate_sequence(
            self.configuration, self.lists, self.options.engine,
            triangles=self.lists.most_triangles, depths=self.options.depth,
            # A bus merges one picture while the next one is drawn, unless asked in between.
            counters="last" if self.configuration.snoops else "all",
            policy=self.options.policy(self.configuration), progress=progress,
            memory_seed=self.options.random_memory))
        shown = next((frame for frame in frames if not frame.equal), frames[-1])
        scene = self.lists.scene(shown.number)
        wrong = tuple(f"picture {frame.number}: {line}" for frame in frames
                      for line in wrong_counts(frame.regions, frame.objects))
        return FramesRendering(frames, Rendering(
            scene=scene, configuration=self.configuration, simulation=shown.simulation,
            comparison=shown.comparison, command_line=self.command_line,
            warnings=(*self.warnings, *shown.simulation.notes, *wrong),
            wall_seconds=time.perf_counter() - self.began, report=report,
            traffic=golden_traffic(self.configuration, scene.display_list, shown.simulation),
            regions=shown.regions, objects=shown.objects, wrong_counts=wrong), report)


def prepare_frames(scene: str | Path = DEFAULT_SCENE, options: FramesOptions | None = None,
                   command_line: str | None = None) -> FramesJob:
    """Look at the scene from every side, and choose one machine that draws all pictures exactly.

    Raises ``InputError`` for whatever cannot be used.
    """
    began = time.perf_counter()
    options = options or FramesOptions(frames=1)
    if options.depth not in get_args(Reading):
        raise InputError(f"depth: {options.depth!r} is none of {', '.join(get_args(Reading))}")
    lists = SceneFrames(scene, options, frames=options.frames, turn=options.turn,
                        path=options.path)
    configuration = machine_for_frames(lists, options)
    return FramesJob(lists, configuration, options, command_line,
                     (*lists.first.notes, *resolution_warnings(configuration)), began)


def render_frames(scene: str | Path = DEFAULT_SCENE, *, out: str | Path | None = None,
                  progress: Progress | None = None, **options: Any) -> FramesRendering:
    """Draw a sequence of pictures on one simulated machine, booted once, and compare every one on
    every scan that shows it with the golden model.

    ``out``, ``progress`` and ``options`` are those of ``render``, with the fields of
    ``FramesOptions``: ``frames``, ``turn``, ``path``, ``depth``.

    >>> import cardcage
    >>> rendering = cardcage.render_frames("tetra:depth=0", frames=2, turn=90, cards="PM",
    ...                                    size=(16, 16), engine="pysim")
    >>> rendering.equal, [frame.scans for frame in rendering.frames]
    (True, [1, 1])
    """
    if options.get("path") is not None:
        options["path"] = Path(options["path"])
    job = prepare_frames(scene, FramesOptions(**options))
    return job.run(None if out is None else Path(out), progress)


def check_alone(options: FramesOptions) -> None:
    """``InputError`` for what only a sequence can be asked, where one picture is to be drawn."""
    asked_views.check_alone(turn=options.turn is not None, depth=options.depth == "all")
