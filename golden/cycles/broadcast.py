"""When triangles are sent to the processing elements of their nodes.

The controller broadcasts one triangle a clock, prepared by the host or by set-up in hardware; in a
cage of nodes it is for one of them, and the others neither take it nor hold it up.  Where nodes
have lists, each broadcasts its own to its elements, all nodes at once.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, Protocol

import numpy as np
from numpy.typing import NDArray

from ..specification.queues import OUTLINES_WAITING
from .element_latencies import NEVER, Drawn, Pipeline

Int64 = NDArray[np.int64]

#: Clocks from the command to draw the lists until each node sends the first triangle of its own.
LIST_LATENCY = 2


@dataclass(frozen=True)
class SetupTiming:
    """A set-up in hardware, in clocks unless said otherwise.

    ``interval``  between two triangles that may cover a pixel; others take one each
    ``latency``   from a triangle's beginning to its broadcast
    ``waiting``   triangles that can wait to be set up
    ``inside``    triangles that can be in it, prepared ones that wait included
    ``leaving``   between two broadcasts of waiting ones
    """

    interval: int
    latency: int = 0
    waiting: int = OUTLINES_WAITING
    inside: int = 1
    leaving: int = 2


class SetUp:
    """When the set-up has each triangle ready.

    ``sent``  int64 (n,): places, among all that the host sends, of those that may cover a pixel
    """

    def __init__(self, timing: SetupTiming, sent: Int64) -> None:
        self._timing = timing
        #: Clocks to offer each triangle together with those before it that cover no pixel.
        self._offers = iter(np.diff(sent, prepend=-1).tolist())
        self._offered = -1.0
        # The triangles whose places are taken, the latest last.
        self._entered = deque([NEVER] * timing.waiting, timing.waiting)
        self._sent = deque([NEVER] * timing.inside, timing.inside)

    def arrival(self) -> float:
        """When the next triangle is ready."""
        timing, entered, sent = self._timing, self._entered, self._sent
        self._offered = max(self._offered + next(self._offers), entered[0])
        entered.append(max(self._offered, entered[-1] + timing.interval, sent[0]))
        return max(entered[-1] + timing.latency, sent[-1] + timing.leaving)

    def leaves(self, sent: float) -> None:
        """The triangle that was ready is sent then."""
        self._sent.append(sent)


class Element(Protocol):
    """A processing element, told its triangles in drawing order."""

    def take(self, load: float, cost: Any) -> Drawn:
        """A triangle that its walker loads then, and what it costs at the ports."""


class NodeQueues:
    """The queues of a node's processing elements.

    ``finished``  when all of them would be done, were there no more triangles
    """

    def __init__(self, elements: Sequence[Element], fifo_depth: int, pipeline: Pipeline) -> None:
        self._pipeline = pipeline
        self._elements = elements
        self._load = [NEVER] * len(elements)
        # When the places of each element's triangles became free, the next one to be taken first.
        self._free = [deque([NEVER] * (fifo_depth - 1)) for _ in elements]
        self._sent = -1.0
        # From when on all have a place: with, and without the last triangle that was sent.
        self._room = self._earlier_room = NEVER
        self.finished = NEVER

    def send(self, ready: float) -> float:
        """When a triangle for this node that is ready at ``ready`` is sent.

        A queue is ready while it has a place more than it shows; what was sent a clock ago does
        not show yet.
        """
        following = self._sent + 1
        if ready <= following and self._earlier_room <= following:
            self._sent = following
        else:
            self._sent = max(ready, following + 1, self._room)
        self._earlier_room = self._room
        return self._sent

    def take(self, element: int, walk: int, cost: Any) -> None:
        """The triangle that was sent; ``walk``: clocks from its load to the next."""
        pipeline = self._pipeline
        load = max(self._load[element], self._sent + pipeline.queue)
        drawn, walker, done = self._elements[element].take(load, cost)
        self._load[element] = max(load + walk, walker)
        places = self._free[element]
        places.popleft()
        places.append(1 + drawn - pipeline.valued)
        self._room = max(self._room, places[0])
        self.finished = max(self.finished, done + pipeline.finish)


class ControllersBroadcast:
    """A triangle a clock, for one node or another; the first one that is ready is sent at 0."""

    def __init__(self, setup: SetUp | None) -> None:
        self._setup = setup
        self._sent = -1.0

    def send(self, node: NodeQueues) -> None:
        """The next triangle, which is for ``node``."""
        if self._setup is None:
            self._sent = node.send(self._sent + 1)
        else:
            self._sent = node.send(max(self._sent + 1, self._setup.arrival()))
            self._setup.leaves(self._sent)


class ListBroadcasts:
    """A triangle a clock in each node; the command to draw the lists is sent at 0."""

    def send(self, node: NodeQueues) -> None:
        """The next triangle of the node's list."""
        node.send(LIST_LATENCY)
