"""Points of our curves that simulated machines measure."""

from __future__ import annotations

from dataclasses import asdict, dataclass
from typing import Any

from .....golden.planning.machine_plan import plan
from ....frames.compare import compare
from ....frames.simulation import simulate_frame
from ....support.measurement_cache import measured_once, package_hash
from ..scenes.spheres import SPHERES, Size
from .clocks import SEED, ClocksJob
from .decompositions import DECOMPOSITIONS
from .our_scene import our_objects

#: Nodes and spheres of the points: more are too slow to simulate on a screen of this size.
POINT_NODES = 4
POINT_SPHERES = (4, 16)

#: Of the decompositions.
POINTS = ("host initiated, 100", "node initiated", "forwarding, strips", "forwarding, grid",
          "broadcast, lines", "broadcast, strips")


@dataclass(frozen=True)
class Point:
    """A machine that drew a scene: clocks, measured and by the model; ``equal``: the picture and
    all depths are golden's."""

    decomposition: str
    nodes: int
    spheres: int
    drawing: int
    merging: int
    model_drawing: float
    model_merging: float
    equal: bool

    @property
    def clocks(self) -> int:
        return self.drawing + self.merging

    @property
    def differences(self) -> list[str]:
        return [] if self.equal else [f"{self.decomposition} on {self.nodes} nodes, {self.spheres} "
                                      "spheres: the picture differs"]

    @property
    def off(self) -> float:
        """By how much of what was measured the model is off."""
        return (self.model_drawing + self.model_merging) / self.clocks - 1


@dataclass(frozen=True)
class PointsJob:
    """A decomposition, by its name: one machine that draws scene after scene."""

    decomposition: str
    size: Size
    engine: str

    def run(self) -> list[Point]:
        measured = measured_once([package_hash(), "blazek in RTL", repr(self)], self._measure)
        return [Point(**point) for point in measured["points"]]

    def _measure(self) -> dict[str, Any]:
        asked = DECOMPOSITIONS[self.decomposition]
        lists = [our_objects(self.size, SEED, count).display_list() for count in POINT_SPHERES]
        machine = plan(lists, cards=asked.cards(POINT_NODES),
                       **asked.fields(self.size, POINT_NODES)).configuration
        predicted = ClocksJob(self.decomposition, POINT_NODES, self.size).run()
        points = []
        for count, listed in zip(POINT_SPHERES, lists, strict=True):
            simulation = simulate_frame(machine, listed, engine=self.engine)
            drawing = simulation.draw_cycles
            merging = 0 if simulation.merge_cycles is None else simulation.merge_cycles - drawing
            place = SPHERES.index(count)
            points.append(Point(
                self.decomposition, POINT_NODES, count, drawing, merging,
                predicted["drawing"][place], predicted["merging"][place],
                bool(compare(machine, listed, simulation).equal)))
        return {"points": [asdict(point) for point in points]}


def points_jobs(size: Size, engine: str) -> list[PointsJob]:
    return [PointsJob(name, size, engine) for name in POINTS]
