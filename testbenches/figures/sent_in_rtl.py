"""Points of the figures that simulated machines measure: what their merge cards say they sent."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

from ...golden.merging.cage import merge_cage
from ...golden.planning.machine_plan import plan
from ..frames.compare import compare
from ..frames.simulation import simulate_frame
from ..support.measurement_cache import measured_once, package_hash
from .figure_scenes import FigureScene, Size

#: Small enough to be simulated on every cage, and its name on the page.
POINT_SCENE = FigureScene("teapot, small", "teapot:tessellation=6")
POINT_SIZE = (64, 64)

#: Of the cages.
POINT_NODES = (2, 4, 8)


@dataclass(frozen=True)
class Point:
    """``sent`` pixels of each node, in the machine's count, and ``golden``'s; ``pictures_equal``:
    colour and depth are as golden."""

    cards: str
    nodes: int
    assignment: str
    sent: Sequence[int]
    golden: Sequence[int]
    pictures_equal: bool

    @property
    def equal(self) -> bool:
        return self.pictures_equal and list(self.sent) == list(self.golden)


@dataclass(frozen=True)
class PointJob:
    """``packet`` of the assignment of that name; any cage whose merge cards count what they send
    can be asked."""

    cards: str
    assignment: str
    packet: Any
    scene: FigureScene
    size: Size
    engine: str

    def run(self) -> Point:
        return Point(**measured_once([package_hash(), "sent in RTL", repr(self)], self._measure))

    def _measure(self) -> dict[str, Any]:
        display_list = self.scene.display_list(self.size)
        machine = plan(display_list, cards=self.cards, memory_ports=2, packet=self.packet,
                       clocks_per_pixel=2).configuration
        simulation = simulate_frame(machine, display_list, engine=self.engine)
        return {"cards": self.cards, "nodes": machine.nodes, "assignment": self.assignment,
                "sent": list(map(int, simulation.sent)),
                "golden": list(map(int, merge_cage(machine, display_list)[1].sent)),
                "pictures_equal": bool(compare(machine, display_list, simulation).equal)}
