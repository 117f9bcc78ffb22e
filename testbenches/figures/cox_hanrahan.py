"""Table 1 and figures 5 and 6 of Cox and Hanrahan (1993), for our scenes and machines."""

from __future__ import annotations

import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

from ..engines.choose_engine import AUTO, make_engine
from ..support.processes import run_jobs
from .assignments.frame_times import MAP_SCENES, AssignmentTimes, TimesJob
from .figure_scenes import FigureScene, Size, figure_scenes
from .merge_costs import (
    CAGES,
    MERGE_SCENES,
    MergeCosts,
    MergeJob,
    board_figures,
    merge_costs,
    merge_size,
)
from .scene_traffic import PACKETS, SceneTraffic, TrafficJob
from .sent_in_rtl import POINT_NODES, POINT_SCENE, POINT_SIZE, Point, PointJob

#: The paper's screens have 0.2 to 1.6 million pixels.
DEFAULT_SIZE = (512, 512)

#: The cage whose traffic is measured, on so many nodes.
POINT_CARDS = "{}x(PMMS)FF"

#: Told before each step what is begun.
Step = Callable[[str], None]


@dataclass(frozen=True)
class FiguresOptions:
    """``simulate`` the cages of the last table, and the points that machines measure; ``cells``:
    place and route their boards where that was not done before; ``scenes`` by name, or all."""

    size: Size = DEFAULT_SIZE
    simulate: bool = True
    cells: bool = False
    engine: str = AUTO
    processes: int | None = None
    scenes: Sequence[str] | None = None

    def chosen(self) -> list[FigureScene]:
        return [scene for scene in figure_scenes(self.size)
                if self.scenes is None or scene.name in self.scenes]

    def jobs(self) -> list[Any]:
        """The longest first: no process is left alone with one at the end."""
        scenes = self.chosen()
        found: list[Any] = []
        if self.simulate:
            found += [MergeJob(cage, scene, merge_size(self.size), self.engine) for scene in scenes
                      if scene.name in MERGE_SCENES for cage in CAGES]
            found += [PointJob(POINT_CARDS.format(nodes), name, packet, POINT_SCENE, POINT_SIZE,
                               self.engine)
                      for nodes in POINT_NODES for name, packet in PACKETS.items()]
            found.append(TrafficJob(POINT_SCENE, POINT_SIZE))
        found += [TimesJob(scene, self.size) for scene in scenes if scene.name in MAP_SCENES]
        return found + [TrafficJob(scene, self.size) for scene in scenes]


@dataclass(frozen=True, eq=False)
class CoxHanrahan:
    """``point_traffic`` and ``points``: golden and measured, of ``POINT_SCENE``; ``merges`` is
    empty where nothing was simulated."""

    size: Size
    scenes: Sequence[SceneTraffic]
    maps: Sequence[AssignmentTimes]
    merges: Sequence[MergeCosts]
    points: Sequence[Point]
    point_traffic: SceneTraffic | None
    command_line: str | None
    wall_seconds: float

    @property
    def differences(self) -> list[str]:
        """A line each: what machines did otherwise than the golden models say."""
        return [*(line for merge in self.merges for line in merge.differences),
                *(f"{point.cards}, {point.assignment}: sent {list(point.sent)}, golden "
                  f"{list(point.golden)}, pictures {'equal' if point.pictures_equal else 'differ'}"
                  for point in self.points if not point.equal)]


def redraw_cox_hanrahan(options: FiguresOptions, command_line: str | None = None,
                        step: Step = lambda doing: None) -> CoxHanrahan:
    """Everything on the page; ``step`` is called as the work begins and as each part is done.
    Raises ``InputError`` and ``MachineError``."""
    began = time.perf_counter()
    if options.simulate:
        make_engine(options.engine)  # one that cannot run here ends it before the work
    boards = board_figures(options.cells, step) if options.simulate else {}
    jobs = options.jobs()
    done = list(zip(jobs, run_jobs(jobs, "parts", options.processes, step), strict=True))
    merged = [(job, found) for job, found in done if isinstance(job, MergeJob)]
    traffic = [found for job, found in done if isinstance(job, TrafficJob)]
    points = [found for job, found in done if isinstance(job, PointJob)]
    return CoxHanrahan(
        options.size, [found for found in traffic if found.name != POINT_SCENE.name],
        [each for job, found in done if isinstance(job, TimesJob) for each in found],
        merge_costs([job for job, _ in merged], [found for _, found in merged], boards), points,
        next((found for found in traffic if found.name == POINT_SCENE.name), None), command_line,
        time.perf_counter() - began)
