"""His four methods: how long a frame takes, from the first line read to the picture in node 0."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from .....golden.merging.tree import tree_pairs
from ..scenes.screen_parts import Parts, work_in_parts
from ..scenes.sphere_work import SphereTemplate, Work, sphere_template
from ..scenes.spheres import SCALE, Size, sphere_places, sphere_radius
from .costs import COSTS, Costs
from .queues import forwarded, served

Float64 = NDArray[np.float64]
Int64 = NDArray[np.int64]

#: Polygons in a packet.
PACKETS = (10, 100, 1000)
USUAL_PACKET = 100


@dataclass(frozen=True)
class Frame:
    """``seconds`` of a frame; ``drawn``, until the last node has drawn; ``busy``, what the nodes
    were at work until then, all together; ``host``, until the host has sent all; ``passed`` from
    node to node: objects."""

    seconds: float
    drawn: float
    busy: float
    host: float
    passed: int = 0


@dataclass(frozen=True, eq=False)
class Scene:
    """Spheres like ``template`` at ``places`` on a screen of ``size``, drawn at ``costs``."""

    size: Size
    places: Int64
    template: SphereTemplate
    costs: Costs = COSTS

    @classmethod
    def of(cls, size: Size, seed: int, spheres: int, costs: Costs = COSTS,
           scale: float = SCALE) -> Scene:
        return cls(size, sphere_places(size, seed, spheres, scale),
                   sphere_template(sphere_radius(size, scale)), costs)

    @property
    def spheres(self) -> int:
        return len(self.places)

    def work(self, nodes: int, parts: Parts) -> Work:
        """(spheres, nodes): the part of each sphere that a node has."""
        return work_in_parts(self.template, self.places, self.size, nodes, parts)

    def drawing(self, nodes: int, parts: Parts) -> Float64:
        """(spheres, nodes): seconds for that; 0 where there is none."""
        return np.asarray(self.costs.drawing(self.work(nodes, parts)))

    @property
    def tessellating(self) -> float:
        """A sphere."""
        return self.costs.tessellate * self.template.polygons

    @property
    def polygon_drawing(self) -> Float64:
        """(polygons,): each polygon of a sphere, whole."""
        return np.asarray(self.costs.drawing(self.template.whole))


def host_initiated(scene: Scene, nodes: int, packet: int = USUAL_PACKET) -> Frame:
    """The host tessellates, and sends packets of polygons round robin."""
    costs, each = scene.costs, scene.polygon_drawing
    polygons = len(each) * scene.spheres
    ends = np.minimum(np.arange(packet, polygons + packet, packet), polygons)
    begins = ends - np.minimum(packet, ends - np.arange(0, polygons, packet))
    counts = ends - begins
    until = np.concatenate([[0.0], np.cumsum(each)])

    def drawing_before(count: Int64) -> Float64:
        whole, rest = np.divmod(count, len(each))
        return np.asarray(whole * until[-1] + until[rest])

    objects_begun = -(-ends // len(each)) - -(-begins // len(each))
    arrival = np.cumsum(costs.parse * objects_begun + costs.tessellate * counts
                        + costs.message_time(costs.polygon_bytes * counts))
    work = drawing_before(ends) - drawing_before(begins)
    done = [_last(served(arrival[node::nodes], work[node::nodes])) for node in range(nodes)]
    return _frame(scene, done, float(work.sum()), arrival, _merged)


def node_initiated(scene: Scene, nodes: int) -> Frame:
    """The host sends objects round robin, and the nodes tessellate."""
    arrival = _objects_arrive(scene)
    work = scene.tessellating + float(scene.polygon_drawing.sum())
    done = [_last(served(arrival[node::nodes], np.full(len(arrival[node::nodes]), work)))
            for node in range(nodes)]
    return _frame(scene, done, work * scene.spheres, arrival, _merged)


def forwarding(scene: Scene, nodes: int, parts: Parts = "strips") -> Frame:
    """The same, but each node has a part of the screen, and passes on what lies elsewhere."""
    work, drawing = scene.work(nodes, parts), scene.drawing(nodes, parts)
    visits = [np.flatnonzero(row).tolist() for row in work.polygons]
    arrival = _objects_arrive(scene)
    home = (np.arange(scene.spheres) % nodes).tolist()
    done, busy = forwarded(
        arrival, home, visits, scene.tessellating,
        [row[there].tolist() for row, there in zip(drawing, visits, strict=True)],
        scene.costs.object_message, nodes)
    passed = sum(len(there) - (node in there) for there, node in zip(visits, home, strict=True))
    return _frame(scene, done, sum(busy), arrival, _pasted, passed)


def broadcast(scene: Scene, nodes: int, parts: Parts = "lines",
              hierarchical: bool = True) -> Frame:
    """Every node is sent every object, tessellates it, and draws what lies in its part.

    ``hierarchical``: the host sends to node 0, and nodes to one another in log2 steps; otherwise
    the host sends to each node in turn.
    """
    costs, drawing = scene.costs, scene.drawing(nodes, parts)
    own = scene.tessellating + costs.discard * scene.template.polygons * (nodes > 1) + drawing
    message = costs.object_message
    if not hierarchical:
        sent = np.arange(scene.spheres * nodes).reshape(-1, nodes) + 1
        each = costs.parse * (1 + np.arange(scene.spheres))[:, None] + message * sent
        done = [_last(served(each[:, node], own[:, node])) for node in range(nodes)]
        return _frame(scene, done, float(own.sum()), each[:, -1], _pasted)
    arrivals = {0: _objects_arrive(scene)}
    done, busy = [], 0.0
    for node in range(nodes):
        children = [node + (1 << bit) for bit in range(nodes.bit_length())
                    if node < 1 << bit and node + (1 << bit) < nodes]
        work = message * len(children) + own[:, node]
        ends = served(arrivals[node], work)
        for place, child in enumerate(children):
            arrivals[child] = ends - work + message * (place + 1)
        done.append(_last(ends))
        busy += float(work.sum())
    passed = scene.spheres * (nodes - 1)
    return _frame(scene, done, busy, arrivals[0], _pasted, passed)


def _last(ends: Float64) -> float:
    return float(ends[-1]) if len(ends) else 0.0


def _objects_arrive(scene: Scene) -> Float64:
    """Read and sent by the host one after another."""
    each = scene.costs.parse + scene.costs.object_message
    return np.asarray(each * (1 + np.arange(scene.spheres)))


def _frame(scene: Scene, done: list[float], busy: float, arrival: Float64,
           together: Callable[[Scene, list[float]], float], passed: int = 0) -> Frame:
    return Frame(together(scene, done), max(done), busy, float(arrival[-1]), passed)


def _merged(scene: Scene, done: list[float]) -> float:
    """Whole frame buffers, in log2 steps; each pair begins as both are there."""
    pixels = scene.size[0] * scene.size[1]
    sending = float(scene.costs.message_time(scene.costs.pixel_bytes * pixels))
    ready = list(done)
    for _, sender, receiver in tree_pairs(len(done)):
        ready[receiver] = (max(ready[receiver], ready[sender] + sending)
                           + scene.costs.merge_pixel * pixels)
    return ready[0]


def _pasted(scene: Scene, done: list[float]) -> float:
    """Parts of the picture, likewise; they are put side by side as they come."""
    pixels = scene.size[0] * scene.size[1]
    ready, held = list(done), [pixels / len(done)] * len(done)
    for _, sender, receiver in tree_pairs(len(done)):
        sending = scene.costs.message_time(scene.costs.pasted_pixel_bytes * held[sender])
        ready[receiver] = max(ready[receiver], ready[sender] + float(sending))
        held[receiver] += held[sender]
    return ready[0]
