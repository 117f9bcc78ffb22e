"""How long a frame takes by each assignment of the triangles to the nodes of a snooped bus.

Nodes are ``PMM`` with two ports, and draw their triangles from lists.  Drawing is what the cycle
model says of the busiest node, merging what it says of a bus.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import asdict, dataclass
from statistics import geometric_mean
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from ....golden.cycles.broadcast import LIST_LATENCY
from ....golden.cycles.cycle_model import predict_cycles
from ....golden.cycles.snoop_clocks import snoop_clocks
from ....golden.merging.depth_order import DepthOrder
from ....golden.merging.traffic import Send, Traffic
from ....golden.planning.machine_plan import plan
from ....golden.specification.configuration import MachineConfiguration
from ....golden.specification.display_list import DisplayList
from ...support.measurement_cache import measured_once, package_hash
from ..figure_scenes import MESHES, FigureScene, Size
from .assignment import ASSIGNMENTS

NODE: dict[str, Any] = {"cards": "PMM", "memory_ports": 2}

#: The cages of the map.
MAP_NODES = (4, 16, 64)

#: The scenes of the map, besides the meshes.
MAP_SCENES = (*MESHES, "background first", "random as Wash.ht")


@dataclass(frozen=True)
class FrameTime:
    """Clocks to draw a frame and to merge it, and the busiest node's part of all fragments.

    ``sent``  over the least that can be sent
    """

    assignment: str
    keeps_order: bool
    draw: int
    merge: int
    busiest: float
    sent: float

    @property
    def in_turn(self) -> int:
        """A frame that is drawn, then merged."""
        return self.draw + self.merge

    @property
    def overlapped(self) -> int:
        """A frame of many, each merged while the next one is drawn."""
        return max(self.draw, self.merge)


class MeanTimes(NamedTuple):
    """Against another assignment: ``draw`` is a frame of a chain, which merges as it is scanned."""

    draw: float
    in_turn: float
    overlapped: float


@dataclass(frozen=True)
class AssignmentTimes:
    """Of a scene on so many nodes; ``times`` in the order of ``ASSIGNMENTS``."""

    scene: str
    nodes: int
    times: Sequence[FrameTime]

    def of(self, assignment: str) -> FrameTime:
        return next(time for time in self.times if time.assignment == assignment)


@dataclass(frozen=True)
class TimesJob:
    scene: FigureScene
    size: Size

    def run(self) -> list[AssignmentTimes]:
        """One for each of ``MAP_NODES``."""
        found = measured_once([package_hash(), "assignment times", repr(self)], self._measure)
        return [AssignmentTimes(self.scene.name, each["nodes"],
                                [FrameTime(**time) for time in each["times"]])
                for each in found["maps"]]

    def _measure(self) -> dict[str, Any]:
        display_list = self.scene.display_list(self.size)
        order = DepthOrder.of(display_list)
        machine = plan(display_list, **NODE).configuration
        return {"maps": [{"nodes": nodes, "times": [
            asdict(_time(display_list, order, machine, assignment, nodes))
            for assignment in ASSIGNMENTS]} for nodes in MAP_NODES]}


def _time(display_list: DisplayList, order: DepthOrder, machine: MachineConfiguration,
          assignment: Any, nodes: int) -> FrameTime:
    node = assignment.node_of(display_list, nodes)
    traffic = Traffic(nodes, [Send(each, each, None, sent) for each, sent in
                              enumerate(order.sent_by(node, nodes).tolist())])
    return FrameTime(
        assignment.name, assignment.keeps_order, draw_clocks(machine, display_list, node, nodes),
        sum(snoop_clocks(traffic)),
        int(order.drawn_by(node, nodes).max()) / max(order.fragments, 1),
        traffic.pixels / max(order.pixels, 1))


def draw_clocks(machine: MachineConfiguration, display_list: DisplayList,
                node: NDArray[np.int64], nodes: int) -> int:
    """Clocks until the last node has drawn its list; each is a ``machine`` by itself.

    As ``predict_cycles`` says of a cage of such nodes, whose shares can only be packets.
    """
    return LIST_LATENCY + round(max(
        predict_cycles(machine, display_list.chosen(np.flatnonzero(node == each))).cycles
        for each in range(nodes)))


def mean_times(maps: Sequence[AssignmentTimes], against: str) -> dict[str, MeanTimes]:
    """Of each assignment, against those of ``against``; geometric means over all maps."""
    def compared(name: str, way: str) -> float:
        return geometric_mean([getattr(each.of(name), way) / getattr(each.of(against), way)
                               for each in maps])

    return {assignment.name: MeanTimes(*(compared(assignment.name, way)
                                         for way in MeanTimes._fields))
            for assignment in ASSIGNMENTS}
