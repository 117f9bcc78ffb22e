"""Clocks that processing elements take which make the triangles of objects, and pass objects on.

The controller broadcasts an object a clock, each for one element, whose queue it waits for.  From
there it goes from neighbour to neighbour; every element that draws it has its own reader, set-up
and walker, and works on its own objects one after another, in the order in which the host sends
them (in the machine they come about in that order).
"""

from __future__ import annotations

from collections import deque
from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

from ...objects.forwarding import forwarded_objects
from ...objects.object_words import made_of_objects, source_shares
from ...specification.configuration import MachineConfiguration
from ...specification.display_list import DisplayList
from ...specification.queues import OBJECTS_PASSING, OBJECTS_WAITING
from ..broadcast import NodeQueues, SetupTiming
from ..element_latencies import NEVER, Pipeline
from ..node_work import NodeWork
from .node_objects import places_of
from .object_setup import ObjectSetUp

Int64 = NDArray[np.int64]

#: Clocks from an object's broadcast until its regions are known, and so many objects under way.
REACH_LATENCY = 3
#: Clocks until an object is at the end of a queue that is empty, and from there to each output.
TO_HEAD = 1
TO_OUTPUT = 1
#: From when a triangle is sent that is in none of the element's regions until that is done with it.
PASSED_OVER = 3


class PassedObjects:
    """When objects are at the end of the queue for those that come from one neighbour, and leave
    it."""

    def __init__(self, places: int) -> None:
        self._left = deque([NEVER] * places, places)

    def head(self, offered: float) -> tuple[float, float]:
        """When an object that is offered then enters, and when it is the first one."""
        entered = max(offered, self._left[0])
        return entered, max(entered + TO_HEAD, self._left[-1] + 1)

    def leaves(self, when: float) -> None:
        self._left.append(when)


class ForwardedRun:
    """A display list of objects, followed through all elements.

    ``finished``  of each object, in the order in which the host sends them: as
                  ``CyclePrediction`` has it, from the first one's broadcast on
    ``kept``      int64 (elements,): triangles that each makes, or is sent, and that have pixels
    ``made``      int64 (elements,): those without a pixel as well
    ``commands``  that are broadcast
    """

    def __init__(self, configuration: MachineConfiguration, display_list: DisplayList,
                 work: NodeWork, pipeline: Pipeline, setup: SetupTiming) -> None:
        listed = made_of_objects(display_list)
        elements = configuration.processing_elements
        self._clipped, self._counts = listed.objects.clipped, listed.counts
        self._drawn = forwarded_objects(configuration, listed).drawn
        shares = source_shares(configuration, listed)
        self._source = shares.node
        first = np.cumsum(listed.counts) - listed.counts
        self._places = places_of(work.primitive, listed.object_of, first, len(listed.counts))
        self._begins = np.searchsorted(listed.object_of[work.primitive],
                                       np.arange(len(listed.counts) + 1))
        # Of each triangle, what it costs the elements that keep it.
        self._work = [{element: (walk, cost) for element, walk, cost in each} for each in work]
        self._queues = [NodeQueues([element], configuration.fifo_depth, pipeline)
                        for element in work.elements]
        self._setups = [ObjectSetUp(setup) for _ in range(elements)]
        self._waiting = [PassedObjects(OBJECTS_WAITING + REACH_LATENCY) for _ in range(elements)]
        self._passing = {step: [PassedObjects(OBJECTS_PASSING) for _ in range(elements)]
                         for step in (-1, 1)}
        self._sent = -1.0
        self._passed_over = NEVER  # the last triangle so far, were it in nobody's regions
        self.finished: list[float] = []
        self.commands = 0
        for number in shares.host_order.tolist():
            if self._clipped[number]:
                self._send_triangles(number)
            else:
                self._send(number)
            done = max(queue.finished for queue in self._queues)
            self.finished.append(max(done, self._passed_over, self._sent + 1))
        own = self._drawn | self._clipped[:, np.newaxis]
        kept = np.diff(self._begins)
        self.kept = np.array([int(kept[each].sum()) for each in own.T])
        self.made = np.array([int(listed.counts[each].sum()) for each in own.T])

    def _send(self, number: int) -> None:
        """An object to its element, and from there to all that draw it."""
        source, drawn = int(self._source[number]), self._drawn[number]
        entered, head = self._waiting[source].head(self._sent + 1 + REACH_LATENCY)
        self._sent = max(self._sent + 1, entered - REACH_LATENCY)
        self.commands += 1
        leaves = head
        for step, end in ((-1, int(drawn.argmax())),
                          (1, len(drawn) - 1 - int(drawn[::-1].argmax()))):
            if drawn.any() and (end - source) * step > 0:
                path = iter(range(source + step, end + step, step))
                leaves = max(leaves, self._pass(number, step, path, head))
        if drawn[source]:
            leaves = max(leaves, self._draw(source, number, head + TO_OUTPUT))
        self._waiting[source].leaves(leaves)

    def _pass(self, number: int, step: int, path: Iterator[int], head: float) -> float:
        """On to the next element of ``path``, and from there on; when it has got there."""
        element = next(path, None)
        if element is None:
            return head
        entered, here = self._passing[step][element].head(head + TO_OUTPUT)
        leaves = self._pass(number, step, path, here)
        if self._drawn[number, element]:
            leaves = max(leaves, self._draw(element, number, here + TO_OUTPUT))
        self._passing[step][element].leaves(leaves)
        return entered

    def _draw(self, element: int, number: int, offered: float) -> float:
        """An object is offered to an element's set-up; when that takes it."""
        setup = self._setups[element]
        taken = max(offered, setup.room)
        setup.take(taken)
        for which, place in enumerate(self._places[number]):
            self._make(element, int(self._begins[number]) + which, place)
        setup.end(int(self._counts[number]))
        return taken

    def _send_triangles(self, number: int) -> None:
        """A clipped object's triangles, to all elements."""
        places = {place: which for which, place in enumerate(self._places[number])}
        for place in range(int(self._counts[number])):
            self._sent = max(self._sent + 1, *(setup.room for setup in self._setups))
            self.commands += 1
            for element, setup in enumerate(self._setups):
                setup.take(self._sent, whole=False)
                if place in places:
                    self._make(element, int(self._begins[number]) + places[place], 0)
                setup.end(1)

    def _make(self, element: int, triangle: int, place: int) -> None:
        """A triangle, that an element draws if it is in its regions."""
        setup, queue = self._setups[element], self._queues[element]
        sent = queue.send(setup.arrival(place))
        setup.leaves(sent)
        self._passed_over = max(self._passed_over, sent + PASSED_OVER)
        cost = self._work[triangle].get(element)
        if cost is not None:
            queue.take(0, *cost)
