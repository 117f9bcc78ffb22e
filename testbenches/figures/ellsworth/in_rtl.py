"""Points of figure 4 that simulated machines measure, by what they counted of each region."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from statistics import mean
from typing import Any

from ....golden.planning.machine_plan import plan
from ....golden.specification.regions import MAXIMUM_REGIONS
from ...sequence.sequence_run import SequenceFrame, simulate_sequence
from ...support.measurement_cache import measured_once, package_hash
from .dealing.dealing_job import CLOCKS, CURE_RATIO, LAST, STATIC
from .dealing.models import FigureModel, Size

#: Of the machines: each has one processing element of one memory unit for each of these.
POINT_PROCESSORS = (2, 4, 8, 16)
POINT_CARDS = "{}x(PM)"

#: The first is drawn by the static table, each other one by what was counted in the one before.
POINT_FRAMES = 4

#: Of the curves, those that are measured.
MEASURED = (STATIC, f"{CLOCKS}, {LAST}")


@dataclass(frozen=True)
class Point:
    """What a machine did with the first frames of a model.

    ``utilisation``  of each frame, by the machine's own counts, and ``golden``
    ``differences``  a line for each count that is not golden's, and each picture that differs
    """

    model: str
    processors: int
    columns: int
    rows: int
    utilisation: Sequence[float]
    golden: Sequence[float]
    differences: Sequence[str]

    @property
    def ratio(self) -> float:
        return self.columns * self.rows / self.processors

    def by(self, how: str) -> float:
        """``how`` is one of ``MEASURED``."""
        return dict(zip(MEASURED, (self.utilisation[0], mean(self.utilisation[1:])),
                        strict=True))[how]


def nearest_regions(size: Size, processors: int) -> tuple[int, int]:
    """Columns and rows of regions of power-of-two sizes, at most twice as long as wide: as many as
    are nearest to the paper's ratio."""

    def regions(sides: tuple[int, int]) -> tuple[int, int]:
        columns, rows = (-(-pixels >> bits) for pixels, bits in zip(size, sides, strict=True))
        return columns, rows

    def distance(sides: tuple[int, int]) -> float:
        return abs(math.log(math.prod(regions(sides)) / (processors * CURE_RATIO)))

    most = (max(size) - 1).bit_length()
    return regions(min(((x, y) for x in range(most + 1) for y in range(most + 1)
                        if abs(x - y) <= 1 and math.prod(regions((x, y))) <= MAXIMUM_REGIONS),
                       key=distance))


@dataclass(frozen=True)
class PointJob:
    model: FigureModel
    size: Size
    processors: int
    engine: str

    def run(self) -> Point:
        return Point(**measured_once([package_hash(), "regions in RTL", repr(self),
                                      self.model.identity(self.size)], self._measure))

    def _measure(self) -> dict[str, Any]:
        lists = list(self.model.lists(self.size, 0, POINT_FRAMES, lit=True))
        columns, rows = nearest_regions(self.size, self.processors)
        machine = plan(lists, cards=POINT_CARDS.format(self.processors), memory_ports=2,
                       clocks_per_pixel=2, regions=(columns, rows), balance=CLOCKS).configuration
        frames = list(simulate_sequence(machine, lists, self.engine, policy="clocks",
                                        triangles=max(each.triangles for each in lists)))
        return {"model": self.model.name, "processors": self.processors, "columns": columns,
                "rows": rows, "utilisation": [_measured(frame) for frame in frames],
                "golden": [_golden(frame) for frame in frames],
                "differences": [line for frame in frames for line in self._differences(frame)]}

    def _differences(self, frame: SequenceFrame) -> list[str]:
        assert frame.regions is not None
        lines = [] if frame.equal else ["the picture differs"]
        return [f"{self.model.name} on {self.processors} processors, frame {frame.number}: {line}"
                for line in (*lines, *frame.regions.differences)]


def _measured(frame: SequenceFrame) -> float:
    """The utilisation by the counts that the machine answered."""
    assert frame.regions is not None and frame.regions.slot_counts is not None
    loads = frame.regions.slot_counts.sum(axis=1)
    return int(loads.sum()) / (len(loads) * int(loads.max())) if loads.any() else 1.0


def _golden(frame: SequenceFrame) -> float:
    assert frame.regions is not None
    return frame.regions.utilisation


def point_jobs(models: Sequence[FigureModel], size: Size, engine: str) -> list[PointJob]:
    """Of the first model, as the others may be far too large; the largest machine first."""
    model = replace(models[0], frames=POINT_FRAMES)
    return [PointJob(model, size, each, engine) for each in reversed(POINT_PROCESSORS)]
