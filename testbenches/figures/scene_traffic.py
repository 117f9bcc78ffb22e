"""What a scene is by the measures of table 1, and what nodes send for it, as in figures 5 and 6."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import asdict, dataclass
from functools import cached_property
from statistics import mean
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ...golden.merging.depth_order import DepthOrder
from ...golden.organisations.shares import Shares
from ...golden.reference.triangle_setup import outline
from ...golden.specification.configuration import Packet
from ...golden.specification.sampling_grid import Grid
from ..support.measurement_cache import measured_once, package_hash
from .expected_traffic import by_pixel, by_pixel_among, evenly
from .figure_scenes import FigureScene, Size

#: Processors on the horizontal axis.
NODES = (1, 2, 4, 8, 16, 32, 64)

ROUND_ROBIN, CONTIGUOUS, SHUFFLED = "round robin", "contiguous", "shuffled"

#: Of the shares that are dealt out as the list is.
PACKETS: dict[str, Packet] = {ROUND_ROBIN: 1, CONTIGUOUS: "contiguous"}

#: Round robin of the list shuffled: so often, each time in another way.
SHUFFLES = 8


@dataclass(frozen=True)
class Curve:
    """For each of ``NODES``: the pixels sent, and the part of all fragments that the busiest node
    draws; of several shuffles the mean.  ``least`` and ``most`` that one of them sends."""

    assignment: str
    sent: Sequence[float]
    busiest: Sequence[float]
    least: Sequence[int]
    most: Sequence[int]


@dataclass(frozen=True)
class SceneTraffic:
    """A scene at ``area`` pixels.

    ``given``        its triangles, before clipping
    ``triangles``    after it: with area, and a box that holds the centre of a pixel of the screen,
                     which is what triangle set-up passes on
    ``fragments``    of all of them
    ``depth_counts`` how many pixels of the screen have 0, 1, 2, … fragments
    """

    name: str
    scene: str
    row: str
    background: str | None
    area: int
    given: int
    triangles: int
    fragments: int
    depth_counts: Sequence[int]
    curves: Sequence[Curve]

    @property
    def pixels(self) -> int:
        """On which something is drawn: the least traffic that there can be."""
        return self.area - self.depth_counts[0]

    @property
    def mean_size(self) -> float:
        return self.fragments / max(self.triangles, 1)

    @property
    def depth(self) -> float:
        """Over the screen."""
        return self.fragments / self.area

    @property
    def drawn_depth(self) -> float:
        """Over the pixels on which something is drawn."""
        return self.maximum

    @cached_property
    def _depths(self) -> NDArray[np.int64]:
        return np.repeat(np.arange(len(self.depth_counts)), self.depth_counts)

    def ratio(self, pixels: float) -> float:
        """Over the least traffic."""
        return pixels / max(self.pixels, 1)

    @property
    def maximum(self) -> float:
        """Every fragment is sent: the straightforward merge."""
        return self.ratio(self.fragments)

    @property
    def expected(self) -> float:
        """Equation 4, of the pixels on which something is drawn."""
        return self.ratio(evenly(self.pixels, self.fragments))

    @property
    def expected_of_screen(self) -> float:
        """Equation 4, of the whole screen."""
        return self.ratio(evenly(self.area, self.fragments))

    @property
    def expected_by_pixel(self) -> float:
        """Equation 3."""
        return self.ratio(by_pixel(self._depths))

    @cached_property
    def expected_among(self) -> list[float]:
        """Equation 3 with local Z-buffering, for each of ``NODES``."""
        return [self.ratio(by_pixel_among(self._depths, nodes)) for nodes in NODES]

    def curve(self, assignment: str) -> Curve:
        return next(curve for curve in self.curves if curve.assignment == assignment)

    def observed(self, nodes: int, assignment: str = ROUND_ROBIN) -> float:
        return self.ratio(self.curve(assignment).sent[NODES.index(nodes)])

    def busiest(self, nodes: int, assignment: str = ROUND_ROBIN) -> float:
        """The busiest node's part of all fragments."""
        return self.curve(assignment).busiest[NODES.index(nodes)]

    def among(self, nodes: int) -> float:
        """What is expected, of ``expected_among``."""
        return self.expected_among[NODES.index(nodes)]

    def reduction(self, nodes: int) -> float:
        """By how much snooping reduces the traffic of the straightforward merge, dealt out round
        robin."""
        return self.maximum / self.observed(nodes) if self.pixels else 1.0


@dataclass(frozen=True)
class TrafficJob:
    scene: FigureScene
    size: Size

    def run(self) -> SceneTraffic:
        found = measured_once([package_hash(), "scene traffic", repr(self)], self._measure)
        return SceneTraffic(**found | {"curves": [Curve(**curve) for curve in found["curves"]]})

    def _measure(self) -> dict[str, Any]:
        display_list = self.scene.display_list(self.size)
        order = DepthOrder.of(display_list)
        area = display_list.width * display_list.height
        counts = np.bincount(order.depths, minlength=1)
        counts[0] = area - order.pixels
        return {
            "name": self.scene.name, "scene": self.scene.scene, "row": self.scene.row,
            "background": self.scene.background, "area": area, "given": self.scene.given,
            "triangles": len(outline(display_list, Grid.of(display_list)).boxes.primitive),
            "fragments": order.fragments, "depth_counts": counts.tolist(),
            "curves": [asdict(curve) for curve in _curves(order)],
        }


def _curves(order: DepthOrder) -> Iterator[Curve]:
    for name, packet in PACKETS.items():
        yield _curve(name, order, packet, [np.arange(order.triangles)])
    # Which triangle takes whose place; of equal depths the one that is earlier in the list still
    # keeps the pixel.
    yield _curve(SHUFFLED, order, 1, [np.random.default_rng(seed).permutation(order.triangles)
                                      for seed in range(SHUFFLES)])


def _curve(name: str, order: DepthOrder, packet: Packet, places: Sequence[NDArray[np.int64]]
           ) -> Curve:
    sent, busiest = [], []
    for nodes in NODES:
        shares = [Shares(nodes, order.triangles, packet).node[place] for place in places]
        sent.append([int(order.sent_by(node, nodes).sum()) for node in shares])
        busiest.append(mean(int(order.drawn_by(node, nodes).max()) for node in shares)
                       / max(order.fragments, 1))
    return Curve(name, [mean(each) for each in sent], busiest, [min(each) for each in sent],
                 [max(each) for each in sent])
