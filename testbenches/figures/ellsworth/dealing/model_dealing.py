"""What was found of a model, the mean of its frames."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from statistics import mean
from typing import Any

from .dealing_job import LAST, THIS, DealingJob, merge_lists
from .models import FigureModel, Size

#: Frames of a job: a few are looked at twice, by the job of the frames after them.
PORTION = 12


def _mean(numbers: Sequence[float]) -> float:
    return mean(numbers)


@dataclass(frozen=True, eq=False)
class ModelDealing:
    """``found``: as ``DealingJob`` has it, of all frames."""

    model: FigureModel
    size: Size
    found: dict[str, Any]

    @property
    def processors(self) -> list[int]:
        return [int(each) for each in self.found["utilisation"]]

    @property
    def given(self) -> float:
        """Triangles of a frame that face the eye."""
        return _mean(self.found["given"])

    @property
    def drawn(self) -> float:
        """Triangles of a frame that may cover a pixel."""
        return _mean(self.found["drawn"])

    @property
    def fragments(self) -> float:
        return _mean(self.found["fragments"])

    @property
    def mean_size(self) -> float:
        """Fragments of a triangle."""
        return self.fragments / max(self.drawn, 1)

    @property
    def box(self) -> tuple[float, float]:
        """Width and height of a triangle's, in pixels."""
        return _mean(self.found["width"]), _mean(self.found["height"])

    def visits(self, regions: int) -> float:
        return _mean(self.found["visits"][str(regions)])

    def clocks(self, regions: int) -> float:
        """Of all regions together."""
        return _mean(self.found["clocks"][str(regions)])

    def overlap(self, regions: int) -> float:
        return self.visits(regions) / max(self.drawn, 1)

    def utilisation(self, processors: int, ratio: int, how: str) -> float:
        return _mean(self.found["utilisation"][str(processors)][str(ratio)][how])

    def curve(self, ratio: int, how: str) -> list[float]:
        return [self.utilisation(each, ratio, how) for each in self.processors]

    def drop(self, processors: int, ratio: int, count: str) -> float:
        """What the last frame's counts lose against this frame's."""
        return (self.utilisation(processors, ratio, f"{count}, {THIS}")
                - self.utilisation(processors, ratio, f"{count}, {LAST}"))

    @property
    def cure_processors(self) -> list[int]:
        return [int(each) for each in self.found["cures"]]

    def cured(self, name: str, processors: int) -> float:
        return _mean(self.found["cures"][str(processors)][name])


def dealing_jobs(model: FigureModel, size: Size) -> list[DealingJob]:
    return [DealingJob(model, size, first, min(PORTION, model.frames - first))
            for first in range(0, model.frames, PORTION)]


def model_dealing(jobs: Sequence[DealingJob], results: Sequence[dict[str, Any]]) -> ModelDealing:
    """Of all jobs of a model."""
    return ModelDealing(jobs[0].model, jobs[0].size, merge_lists(results))


