"""Figures 12 to 19 of Blazek (1991), for his machine and for ours."""

from __future__ import annotations

import time
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from ....golden.specification.errors import InputError
from ...engines.choose_engine import AUTO, make_engine
from ...support.processes import run_jobs
from .his_machine.sensitivity import Sensitivity, SensitivityJob, sensitivity_jobs
from .his_machine.times import Times, TimesJob, times_jobs, times_of
from .our_machine.clocks import Clocks, ClocksJob, clocks_jobs, clocks_of
from .our_machine.in_rtl import Point, PointsJob, points_jobs
from .scenes.spheres import NODES, Size

#: That of most of his examples.
DEFAULT_SIZE = (512, 512)

#: Told before each step what is begun.
Step = Callable[[str], None]


@dataclass(frozen=True)
class BlazekOptions:
    """``size``: powers of two, as regions of the screen are; ``simulate`` the points that machines
    measure."""

    size: Size = DEFAULT_SIZE
    simulate: bool = True
    engine: str = AUTO
    processes: int | None = None

    def jobs(self) -> list[Any]:
        """The longest first: no process is left alone with one at the end.  Raises
        ``InputError``."""
        width, height = self.size
        if min(width, height) < 2 * NODES[-1] or width & (width - 1) or height & (height - 1):
            raise InputError(f"--size: {width}x{height} is not cut into {NODES[-1]} equal strips "
                             f"and rectangles; take powers of two from {2 * NODES[-1]} on, such as "
                             "512x512")
        points = points_jobs(self.size, self.engine) if self.simulate else []
        return [*points, *clocks_jobs(self.size), *times_jobs(self.size),
                *sensitivity_jobs(self.size)]


@dataclass(frozen=True, eq=False)
class Blazek:
    """``times`` of his machine and ``clocks`` of ours by method; ``points`` of ours: none where
    nothing was simulated."""

    size: Size
    times: Mapping[str, Times]
    sensitivity: Sequence[Sensitivity]
    clocks: Mapping[str, Clocks]
    points: Sequence[Point]
    command_line: str | None
    wall_seconds: float

    @property
    def differences(self) -> list[str]:
        """A line each: what machines did otherwise than the golden models say."""
        return [line for point in self.points for line in point.differences]


def redraw_blazek(options: BlazekOptions, command_line: str | None = None,
                  step: Step = lambda doing: None) -> Blazek:
    """Everything on the page; ``step`` is called as the work begins and as each part is done.
    Raises ``InputError`` and ``MachineError``."""
    began = time.perf_counter()
    if options.simulate:
        make_engine(options.engine)  # one that cannot run here ends it before the work
    jobs = options.jobs()
    done = list(zip(jobs, run_jobs(jobs, "parts", options.processes, step), strict=True))

    def of(kind: type[Any]) -> tuple[list[Any], list[Any]]:
        own = [(job, found) for job, found in done if isinstance(job, kind)]
        return [job for job, _ in own], [found for _, found in own]

    return Blazek(
        options.size, times_of(*of(TimesJob)), of(SensitivityJob)[1],
        clocks_of(*of(ClocksJob)), [point for points in of(PointsJob)[1] for point in points],
        command_line, time.perf_counter() - began)
