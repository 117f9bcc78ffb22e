"""Figures 4 and 5 of Ellsworth (1994), for our models and machines."""

from __future__ import annotations

import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

from ....golden.specification.errors import InputError
from ...engines.choose_engine import AUTO, make_engine
from ...support.processes import run_jobs
from .dealing.dealing_job import DealingJob
from .dealing.model_dealing import ModelDealing, dealing_jobs, model_dealing
from .dealing.models import FigureModel, Size, figure_models
from .dealing.screen_grids import LEAST_SIDE, processors_for
from .in_rtl import Point, PointJob, point_jobs
from .overlap import Overlap, OverlapJob, overlap_jobs

#: The paper's screen.
DEFAULT_SIZE = (640, 512)

#: Degrees from frame to frame, as the paper's head turns.
TURN = 4.5

MOST_FRAMES = 1000

#: Told before each step what is begun.
Step = Callable[[str], None]


@dataclass(frozen=True)
class EllsworthOptions:
    """``frames`` of each model, None for as many as the paper's head has, or a few minutes allow;
    ``models``: scenes in place of the two that there are; ``simulate`` the points that machines
    measure."""

    size: Size = DEFAULT_SIZE
    frames: int | None = None
    models: Sequence[str] = ()
    simulate: bool = True
    engine: str = AUTO
    processes: int | None = None

    def chosen(self) -> list[FigureModel]:
        """Raises ``InputError``."""
        if self.frames is not None and not 1 <= self.frames <= MOST_FRAMES:
            raise InputError(f"--frames: must be 1 to {MOST_FRAMES:,}, not {self.frames}")
        if len(processors_for(self.size)) < 2:
            width, height = self.size
            raise InputError(f"--size: {width}x{height} is too small for regions of "
                             f"{LEAST_SIDE}x{LEAST_SIDE} pixels; take 32x32 at least")
        if not self.models:
            return figure_models(self.frames, TURN)
        if len(set(self.models)) < len(self.models):
            raise InputError("--model: the same scene twice; name each once")
        found = [FigureModel(scene, scene, self.frames or 24, TURN) for scene in self.models]
        for model in found:
            model.load()  # what cannot be read ends it before the work
        return found

    def jobs(self) -> list[Any]:
        """The longest first: no process is left alone with one at the end."""
        models = self.chosen()
        points = point_jobs(models, self.size, self.engine) if self.simulate else []
        dealing = [job for model in models for job in dealing_jobs(model, self.size)]
        return [*points, *dealing[::-1], *overlap_jobs(self.size)]


@dataclass(frozen=True, eq=False)
class Ellsworth:
    """``points``: of the first model; none where nothing was simulated."""

    size: Size
    models: Sequence[ModelDealing]
    overlaps: Sequence[Overlap]
    points: Sequence[Point]
    command_line: str | None
    wall_seconds: float

    @property
    def differences(self) -> list[str]:
        """A line each: what machines did otherwise than the golden models say."""
        return [line for point in self.points for line in point.differences]


def redraw_ellsworth(options: EllsworthOptions, command_line: str | None = None,
                     step: Step = lambda doing: None) -> Ellsworth:
    """Everything on the page; ``step`` is called as the work begins and as each part is done.
    Raises ``InputError`` and ``MachineError``."""
    began = time.perf_counter()
    if options.simulate:
        make_engine(options.engine)  # one that cannot run here ends it before the work
    jobs = options.jobs()
    done = list(zip(jobs, run_jobs(jobs, "parts", options.processes, step), strict=True))
    models = []
    for model in options.chosen():
        own = sorted(((job, found) for job, found in done
                      if isinstance(job, DealingJob) and job.model == model),
                     key=lambda each: each[0].first)
        models.append(model_dealing([job for job, _ in own], [found for _, found in own]))
    return Ellsworth(
        options.size, models,
        [each for job, found in done if isinstance(job, OverlapJob) for each in found],
        [found for job, found in done if isinstance(job, PointJob)][::-1],
        command_line, time.perf_counter() - began)
