"""What every decomposition takes on our machines, for all numbers of nodes and spheres."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

from ....support.measurement_cache import measured_once, package_hash
from ..scenes.speed_ups import SpeedUps
from ..scenes.spheres import NODES, SPHERES, Size
from .decompositions import DECOMPOSITIONS, drawing_clocks, node_of_triangles, words_on_link
from .merging import merging_clocks

#: Of the places of the spheres.
SEED = 0


@dataclass(frozen=True)
class ClocksJob:
    """A decomposition, by its name, on so many nodes."""

    decomposition: str
    nodes: int
    size: Size

    def run(self) -> dict[str, Any]:
        return measured_once([package_hash(), "blazek's clocks", repr(self)], self._measure)

    def _measure(self) -> dict[str, Any]:
        asked = DECOMPOSITIONS[self.decomposition]
        drawing = drawing_clocks(asked, self.size, SEED, self.nodes, SPHERES)
        merging = [0] * len(SPHERES)
        if asked.merges and self.nodes > 1:
            merging = merging_clocks(
                asked.configuration(self.size, self.nodes), self.size, SEED, SPHERES,
                node_of_triangles(asked, self.nodes, SPHERES[-1]))
        words = words_on_link(asked, self.size, SEED, self.nodes, SPHERES)
        return {"drawing": drawing, "merging": merging, "words": words}


@dataclass(frozen=True, eq=False)
class Clocks(SpeedUps):
    """A decomposition, in clocks; what drawing and merging take, and the words on the host link,
    by number of nodes, along ``SPHERES``."""

    name: str
    drawing_clocks: dict[int, Sequence[float]]
    merging_clocks: dict[int, Sequence[int]]
    link_words: dict[int, Sequence[int]]

    def drawing(self, spheres: int, nodes: int) -> float:
        return self.drawing_clocks[nodes][SPHERES.index(spheres)]

    def merging(self, spheres: int, nodes: int) -> float:
        return self.merging_clocks[nodes][SPHERES.index(spheres)]

    def words(self, spheres: int, nodes: int) -> int:
        """Of 32 bits, on the host link, for a frame whose mesh is loaded anew."""
        return self.link_words[nodes][SPHERES.index(spheres)]

    def time(self, spheres: int, nodes: int) -> float:
        return self.drawing(spheres, nodes) + self.merging(spheres, nodes)


def clocks_jobs(size: Size) -> list[ClocksJob]:
    """The longest first."""
    return [ClocksJob(name, nodes, size) for nodes in reversed(NODES) for name in DECOMPOSITIONS]


def clocks_of(jobs: Sequence[ClocksJob], found: Sequence[dict[str, Any]]) -> dict[str, Clocks]:
    """By decomposition."""
    made = {name: Clocks(name, {}, {}, {}) for name in DECOMPOSITIONS}
    for job, measured in zip(jobs, found, strict=True):
        made[job.decomposition].drawing_clocks[job.nodes] = measured["drawing"]
        made[job.decomposition].merging_clocks[job.nodes] = measured["merging"]
        made[job.decomposition].link_words[job.nodes] = measured["words"]
    return made
