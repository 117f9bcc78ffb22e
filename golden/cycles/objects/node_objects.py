"""Clocks that nodes take which make the triangles of their objects themselves, or a cage of one
node whose controller does so.

The controller broadcasts an object a clock, each for one node, whose queue it waits for.  Behind
it every node is by itself: its reader and its set-up make triangles as fast as set-up does, and its
processing elements draw them as those of any node (``cycle_model``).  Where the controller makes
them its own queue is the only one, and takes each object in the clock of its command.
"""

from __future__ import annotations

from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from ...objects.object_words import made_of_objects
from ...organisations.object_shares import ObjectShares
from ...organisations.organisation_of import organisation_of
from ...specification.configuration import MachineConfiguration
from ...specification.display_list import DisplayList
from ..broadcast import NodeQueues, SetupTiming
from ..element_latencies import NEVER, Pipeline
from ..node_work import ElementWork, NodeWork
from .object_setup import ObjectSetUp

Int64 = NDArray[np.int64]


class ObjectRun:
    """A display list of objects, followed through all nodes.

    ``finished``     of each triangle that may cover a pixel, in the order in which they are made:
                     as ``CyclePrediction`` has it, from the first object's broadcast on
    ``kept``         int64 (nodes,): how many of these each node has
    ``commands``     that are broadcast
    """

    def __init__(self, configuration: MachineConfiguration, display_list: DisplayList,
                 works: list[NodeWork], pipeline: Pipeline, setup: SetupTiming) -> None:
        listed = made_of_objects(display_list)
        clipped = listed.objects.clipped
        nodes, order = np.zeros(len(clipped), np.int64), np.arange(len(clipped))
        shares = organisation_of(configuration).shares(listed)
        if isinstance(shares, ObjectShares):
            nodes, order = shares.objects.node, shares.objects.host_order
        first = np.cumsum(listed.counts) - listed.counts
        self._places = [places_of(work.primitive, listed.object_of, first, len(clipped))
                        for work in works]
        self._works = [iter(work) for work in works]
        self._queues = [NodeQueues(work.elements, configuration.fifo_depth, pipeline)
                        for work in works]
        self._setups = [ObjectSetUp(setup) for _ in works]
        self._sent = -1.0
        self.finished: list[float] = []
        self.commands = 0
        for number in order.tolist():
            self._draw(int(nodes[number]), number, int(listed.counts[number]),
                       bool(clipped[number]))
        self.kept = np.array([len(work.primitive) for work in works])

    def _draw(self, node: int, number: int, triangles: int, clipped: bool) -> None:
        """An object, by one command, or by one for each of its triangles."""
        setup, places = self._setups[node], self._places[node][number]
        if not clipped:
            self._broadcast(setup, whole=True)
            for place in places:
                self._make(node, place)
            setup.end(triangles)
            return
        seen = set(places)
        for place in range(triangles):
            self._broadcast(setup, whole=False)
            if place in seen:
                self._make(node, 0)
            setup.end(1)

    def _broadcast(self, setup: ObjectSetUp, *, whole: bool) -> None:
        self._sent = max(self._sent + 1, setup.room)
        self.commands += 1
        setup.take(self._sent, whole=whole)

    def _make(self, node: int, place: int) -> None:
        """A triangle, that is drawn by the node's elements."""
        setup, queue = self._setups[node], self._queues[node]
        setup.leaves(queue.send(setup.arrival(place)))
        work: list[ElementWork] = next(self._works[node])
        for element, walk, cost in work:
            queue.take(element, walk, cost)
        before = self.finished[-1] if self.finished else NEVER
        self.finished.append(max(before, queue.finished))


def places_of(primitive: Int64, object_of: Int64, first: Int64, count: int) -> list[list[int]]:
    """Of each object, which of its triangles may cover a pixel, counted in it."""
    number = object_of[primitive]
    places = (primitive - first[number]).tolist()
    ends = np.searchsorted(number, np.arange(count + 1)).tolist()
    return [places[begin:end] for begin, end in pairwise(ends)]
