"""What every method takes on his machine, for all numbers of nodes and spheres."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import asdict, dataclass
from functools import partial
from statistics import mean
from typing import Any

from ....support.measurement_cache import measured_once, package_hash
from ..scenes.speed_ups import SpeedUps
from ..scenes.spheres import NODES, SPHERES, Size
from .methods import (
    PACKETS,
    USUAL_PACKET,
    Frame,
    Scene,
    broadcast,
    forwarding,
    host_initiated,
    node_initiated,
)

Method = Callable[[Scene, int], Frame]

#: By their names on the page.
HOST = {packet: f"host initiated, {packet}" for packet in PACKETS}
USUAL_HOST = HOST[USUAL_PACKET]
NODE = "node initiated"
STRIPS, GRID = "forwarding, strips", "forwarding, grid"
LINES, BROADCAST_STRIPS = "broadcast, lines", "broadcast, strips"
LINEAR = "broadcast one by one, lines"

METHODS: dict[str, Method] = {
    **{HOST[packet]: partial(host_initiated, packet=packet) for packet in PACKETS},
    NODE: node_initiated,
    STRIPS: partial(forwarding, parts="strips"),
    GRID: partial(forwarding, parts="grid"),
    LINES: partial(broadcast, parts="lines"),
    BROADCAST_STRIPS: partial(broadcast, parts="strips"),
    LINEAR: partial(broadcast, parts="lines", hierarchical=False),
}

#: Those whose time does not depend on where the spheres are.
PLACELESS = (*HOST.values(), NODE)

#: Scenes of one number of spheres, each at other places.
SEEDS = tuple(range(8))


def seeds_of(method: str) -> Sequence[int]:
    return SEEDS[:1] if method in PLACELESS else SEEDS


@dataclass(frozen=True)
class TimesJob:
    """One method at all numbers of nodes and spheres, at the places of one seed."""

    method: str
    seed: int
    size: Size

    def run(self) -> dict[str, Any]:
        return measured_once([package_hash(), "blazek's times", repr(self)], self._measure)

    def _measure(self) -> dict[str, Any]:
        frames = []
        for spheres in SPHERES:
            scene = Scene.of(self.size, self.seed, spheres)
            frames.append([asdict(METHODS[self.method](scene, nodes)) for nodes in NODES])
        return {"frames": frames}


@dataclass(frozen=True, eq=False)
class Times(SpeedUps):
    """A method, in seconds; ``frames`` by seed, number of spheres and number of nodes.  Times are
    the mean of all seeds."""

    name: str
    frames: Sequence[Sequence[Sequence[Frame]]]

    def of(self, spheres: int, nodes: int) -> list[Frame]:
        """Of each seed."""
        return [each[SPHERES.index(spheres)][NODES.index(nodes)] for each in self.frames]

    def time(self, spheres: int, nodes: int) -> float:
        return mean(frame.seconds for frame in self.of(spheres, nodes))

    def merging(self, spheres: int, nodes: int) -> float:
        return mean(frame.seconds - frame.drawn for frame in self.of(spheres, nodes))

    def mean_of(self, field: str, spheres: int, nodes: int) -> float:
        """Of a field of ``Frame``."""
        return mean(float(getattr(frame, field)) for frame in self.of(spheres, nodes))

    def balance(self, spheres: int, nodes: int) -> float:
        """What the nodes are at work of the time until the last one has drawn."""
        return mean(frame.busy / (nodes * frame.drawn) for frame in self.of(spheres, nodes))

    def curves_of_seeds(self, spheres: int) -> list[list[float]]:
        """Speed-up along ``NODES``, of each seed by itself."""
        rows = [each[SPHERES.index(spheres)] for each in self.frames]
        return [[row[0].seconds / frame.seconds for frame in row] for row in rows]

    def range_of_seeds(self, spheres: int, nodes: int) -> float:
        """From the least to the greatest speed-up of a seed, as a part of their mean."""
        found = [curve[NODES.index(nodes)] for curve in self.curves_of_seeds(spheres)]
        return (max(found) - min(found)) / mean(found)


def times_jobs(size: Size) -> list[TimesJob]:
    return [TimesJob(method, seed, size) for method in METHODS for seed in seeds_of(method)]


def times_of(jobs: Sequence[TimesJob], found: Sequence[dict[str, Any]]) -> dict[str, Times]:
    """By method."""
    frames: dict[str, list[Any]] = {method: [] for method in METHODS}
    for job, measured in zip(jobs, found, strict=True):
        frames[job.method].append([[Frame(**frame) for frame in row]
                                   for row in measured["frames"]])
    return {method: Times(method, each) for method, each in frames.items()}
