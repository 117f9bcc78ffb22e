"""When a place that makes triangles of objects has each of them ready."""

from __future__ import annotations

from collections import deque

from ..broadcast import SetupTiming
from ..element_latencies import NEVER

#: Objects, and triangles that come as vertices, that can wait at a place.
OBJECTS_WAITING = 16
#: Clocks from an object's broadcast until its first triangle is at set-up, those of its queue; as
#: many from one that comes as vertices.
MAKING_LATENCY = 6
QUEUE_LATENCY = 2
#: Clocks from when a triangle is read from the mesh memory until it is at set-up.
READ_LATENCY = 2


class ObjectSetUp:
    """The queue, the reader and the set-up of one place.

    For every object, in turn: ``room``, ``take``, of each of its triangles that may cover a pixel
    ``arrival`` and ``leaves``, and ``end``.
    """

    def __init__(self, timing: SetupTiming) -> None:
        self._timing = timing
        self._offered = -1.0
        # The triangles whose places are taken, the latest last.
        self._entered = deque([NEVER] * timing.waiting, timing.waiting)
        self._sent = deque([NEVER] * timing.inside, timing.inside)
        # When objects have left the queue.
        self._left = deque([NEVER] * OBJECTS_WAITING, OBJECTS_WAITING)
        #: When the reader has read the last triangle of the object before, and of that before it.
        self._read = [NEVER, NEVER]
        self._whole = True
        self._at = 0

    @property
    def room(self) -> float:
        """When the queue has a place."""
        return self._left[0] + 1

    def take(self, sent: float, *, whole: bool = True) -> None:
        """An object is broadcast then, or vertices."""
        latency = MAKING_LATENCY if whole else QUEUE_LATENCY
        if whole:  # one is looked up while the one before it is read
            self._left.append(max(sent + QUEUE_LATENCY, self._read[0] + 1))
        self._offered = max(self._offered, sent + latency - 1)
        self._whole = whole
        self._at = 0

    def arrival(self, place: int) -> float:
        """When the object's triangle number ``place`` is ready to be sent; those before it that
        cover no pixel take a clock each."""
        timing, entered, sent = self._timing, self._entered, self._sent
        self._offered = max(self._offered + place + 1 - self._at, entered[0])
        self._at = place + 1
        entered.append(max(self._offered, entered[-1] + timing.interval, sent[0]))
        return max(entered[-1] + timing.latency, sent[-1] + timing.leaving)

    def leaves(self, sent: float) -> None:
        """The triangle that was ready is sent then."""
        self._sent.append(sent)

    def end(self, triangles: int) -> None:
        """The object has so many triangles in all."""
        if triangles > self._at:
            self._offered = max(self._offered, self._entered[0] - 1) + triangles - self._at
        if self._whole:
            self._read = [self._read[1], self._offered - READ_LATENCY]
        else:
            self._left.append(self._offered)
