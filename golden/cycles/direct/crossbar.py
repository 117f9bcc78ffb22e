"""The queues between processing elements and memory units, and who is served of those that wait.

In a clock elements are ``chosen``, one for each unit, then all elements ``put`` what there is room
for, and then the chosen fragments are taken: what was put can be taken from the next clock on, and
what was taken makes room from then on.
"""

from __future__ import annotations

from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from ...specification.configuration import MachineConfiguration
from ...specification.queues import FRAGMENTS_OF_ELEMENT
from .element_streams import NO_FRAGMENT, ElementStreams

Bool = NDArray[np.bool_]
Int64 = NDArray[np.int64]


class Queues(Protocol):
    """What waits, fragments being counted as in ``ElementStreams``."""

    def room(self, unit: Int64) -> Bool:
        """bool (elements,): each has room for a fragment for that unit."""

    def put(self, element: Int64, unit: Int64) -> None:
        """A fragment from each of these elements for its unit."""

    @property
    def waiting(self) -> Bool:
        """bool (elements, units): something waits to be taken."""

    def take(self, element: Int64, unit: Int64) -> Int64:
        """Which fragments each of these units takes, one from each of these elements."""


class QueueForEachUnit:
    """``depth`` fragments can wait from each element to each unit."""

    def __init__(self, streams: ElementStreams, first: Int64, units: int, depth: int) -> None:
        elements = len(first) - 1
        element = np.repeat(np.arange(elements), np.diff(first))
        queue = element * units + streams.unit[streams.unit != NO_FRAGMENT]
        self._order = np.argsort(queue, kind="stable")
        counts = np.bincount(queue, minlength=elements * units)
        self._next = (np.cumsum(counts) - counts).reshape(elements, units)
        self._elements, self._depth = np.arange(elements), depth
        self._level = np.zeros((elements, units), np.int64)

    def room(self, unit: Int64) -> Bool:
        return self._level[self._elements, unit] < self._depth

    def put(self, element: Int64, unit: Int64) -> None:
        self._level[element, unit] += 1

    @property
    def waiting(self) -> Bool:
        return self._level > 0

    def take(self, element: Int64, unit: Int64) -> Int64:
        self._level[element, unit] -= 1
        place = self._next[element, unit]
        self._next[element, unit] = place + 1
        return np.asarray(self._order[place])


class QueueForEachElement:
    """Fragments of each element wait in one queue, of which the first may be taken."""

    def __init__(self, streams: ElementStreams, first: Int64, units: int) -> None:
        self._unit = np.append(streams.unit[streams.unit != NO_FRAGMENT], 0)
        self._head = first[:-1].copy()
        self._units = np.arange(units)
        self._level = np.zeros(len(self._head), np.int64)

    def room(self, unit: Int64) -> Bool:
        return self._level < FRAGMENTS_OF_ELEMENT

    def put(self, element: Int64, unit: Int64) -> None:
        self._level[element] += 1

    @property
    def waiting(self) -> Bool:
        first = np.where(self._level > 0, self._unit[self._head], NO_FRAGMENT)
        return np.asarray(first[:, np.newaxis] == self._units)

    def take(self, element: Int64, unit: Int64) -> Int64:
        self._level[element] -= 1
        found = self._head[element]
        self._head[element] = found + 1
        return found


class Crossbar:
    """The queues, and an arbiter for each unit that serves elements in turn.

    ``first``  int64 (elements + 1,): the first fragment of each element
    """

    def __init__(self, configuration: MachineConfiguration, streams: ElementStreams,
                 first: Int64) -> None:
        units, elements = configuration.units, len(first) - 1
        self.queues: Queues = (
            QueueForEachElement(streams, first, units) if configuration.queue == "element" else
            QueueForEachUnit(streams, first, units, configuration.queue))
        numbers = np.arange(elements)
        # How many come before an element, where another was served last.
        self._before = (numbers[:, np.newaxis] - numbers - 1) % elements
        self._last = np.full(units, elements - 1)

    def chosen(self, ready: Bool) -> tuple[Int64, Int64]:
        """Of the units that are ``ready``, bool (units,), those that something waits for, and the
        element that each takes it from: elements, and units."""
        waiting = self.queues.waiting & ready
        unit = np.flatnonzero(waiting.any(axis=0))
        before = np.where(waiting[:, unit], self._before[:, self._last[unit]], len(waiting))
        element = before.argmin(axis=0)
        self._last[unit] = element
        return element, unit
