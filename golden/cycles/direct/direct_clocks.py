"""When a cage whose elements have no pixels has drawn its triangles: followed clock by clock.

Elements draw at their own pace, from one broadcast or each from its list, as long as there is room
for their fragments; units take one a clock, if any waits.  Which units are wanted at the same time
decides, so there is no sum that would do.  In each clock all elements and all units are looked at
together::

    unit       takes a fragment of the next element that has one for it
    element    puts the next one of a row that has been found into a queue, if it has room
    walker     finds the next row, if it has a place
    broadcast  sends a triangle, if its element has a place

As in ``broadcast`` and ``two_port_element``, which follow elements that never wait for others, a
place is known to be free some clocks ahead of the fragments.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ..broadcast import LIST_LATENCY, SetUp
from ..element_latencies import Pipeline
from .crossbar import Crossbar
from .element_streams import NO_FRAGMENT, ElementStreams
from .unit_ports import UnitPorts

Bool = NDArray[np.bool_]
Float64 = NDArray[np.float64]
Int64 = NDArray[np.int64]


class Elements:
    """All processing elements; triangles, rows and slots as in ``ElementStreams``, of which each
    element has its own, from one on to another.

    ``sent``  int64 (elements,): the next triangle to be sent to each
    ``end``   int64 (elements,): beyond its last one
    """

    def __init__(self, streams: ElementStreams, firsts: Int64, fifo_depth: int,
                 pipeline: Pipeline) -> None:
        triangle, entry, slot, _ = firsts
        self._pipeline, self._places = pipeline, fifo_depth - 2

        def padded(values: Int64, more: int = 0) -> Int64:
            return np.append(values, more)

        self._walk = padded(streams.walk)
        self._last_entry = padded(streams.last_entry, len(streams.offset))
        self._slot_end = padded(streams.slot[streams.last_entry + 1])
        self._entry_of, self._offset = padded(streams.entry_of, -1), padded(streams.offset)
        self._slot, self._unit = streams.slot, padded(streams.unit, NO_FRAGMENT)
        self._triangle = np.repeat(streams.entry_of, streams.clocks)  # of each slot
        # When each triangle was sent, and each row found.
        self._sent_at = np.full(len(self._walk), -1)
        self._found_at = np.full(len(self._offset), -1)
        self.sent, self.end = triangle[:-1].copy(), triangle[1:]
        self._latest = np.full(len(self.sent), -9)  # clock of the last send
        self._loaded = triangle[:-1].copy()  # the triangle in the walker, or the next
        self._step = np.full(len(self.sent), -1)  # of its walk; -1 before its load
        self._first_entry = entry[:-1]
        self._found, self._arrived = entry[:-1].copy(), entry[:-1].copy()
        self._drawn = slot[:-1].copy()  # the next slot
        self._drawn_end = slot[1:]
        self._freed = triangle[:-1].copy()

    @property
    def done(self) -> bool:
        """All slots are drawn."""
        return bool((self._drawn == self._drawn_end).all())

    def draw(self, now: int, crossbar: Crossbar) -> Int64:
        """The next slot of each, where there is one and room for it; the triangles of which this
        clock drew a part without a fragment."""
        arrived = np.flatnonzero((self._arrived < self._found) & (
            self._found_at[self._arrived] + self._pipeline.latency <= now))
        self._arrived[arrived] += 1
        unit = self._unit[self._drawn]
        fits = (unit == NO_FRAGMENT) | crossbar.queues.room(unit)
        element = np.flatnonzero(fits & (self._drawn < self._slot[self._arrived]))
        self._drawn[element] += 1
        unit = unit[element]
        fragment = unit != NO_FRAGMENT
        crossbar.queues.put(element[fragment], unit[fragment])
        return np.asarray(self._triangle[self._drawn[element[~fragment]] - 1])

    def walk(self, now: int) -> None:
        """The next row of each that has a triangle."""
        pipeline, loaded, found = self._pipeline, self._loaded, self._found
        loads = (self._step < 0) & (loaded < self.sent) & (
            self._sent_at[loaded] + pipeline.queue <= now)
        self._step += loads
        row = (self._step >= 0) & (self._entry_of[found] == loaded) & (
            self._offset[found] == self._step)
        # A place is that of a row that is begun by then.
        before = np.maximum(found - pipeline.spans_ahead, self._first_entry)
        held = row & (self._slot[before] - self._drawn > pipeline.lead)
        finds = np.flatnonzero(row & ~held)
        self._found_at[found[finds]] = now
        found[finds] += 1
        self._step += (self._step >= 0) & ~held
        done = np.flatnonzero(self._step == self._walk[loaded])
        self._step[done] = -1
        loaded[done] += 1

    def ready(self, now: int) -> Bool:
        """bool (elements,): each can be sent a triangle."""
        freed, valued = self._freed, self._pipeline.valued
        last = self._last_entry[freed]
        frees = (last < self._found) & (self._slot_end[freed] - self._drawn < valued - 1) & (
            self._found_at[last] + self._pipeline.latency + 2 - valued <= now)
        freed += frees
        # What was sent a clock ago does not show yet.
        return np.asarray(self.sent - (self._latest == now - 1) - freed <= self._places)

    def send(self, now: int, element: Int64) -> None:
        """The next triangle of each of these."""
        self._sent_at[self.sent[element]] = now
        self.sent[element] += 1
        self._latest[element] = now


class ControllersBroadcast:
    """A triangle a clock, for one node or another: those of ``nodes``, one after the other."""

    def __init__(self, nodes: Int64, setup: SetUp | None) -> None:
        self._nodes = nodes.tolist()
        self._setup = setup
        self._sent = 0
        self._arrival = 0.0 if setup is None or not len(nodes) else setup.arrival()

    def send(self, now: int, elements: Elements) -> None:
        ready = elements.ready(now)
        if self._sent == len(self._nodes) or self._arrival > now:
            return
        node = self._nodes[self._sent]
        if ready[node]:
            elements.send(now, np.array([node]))
            self._sent += 1
            if self._setup is not None:
                self._setup.leaves(now)
                if self._sent < len(self._nodes):
                    self._arrival = self._setup.arrival()


class ListBroadcasts:
    """A triangle a clock in each node; the command to draw the lists is sent at 0."""

    def send(self, now: int, elements: Elements) -> None:
        if now >= LIST_LATENCY:
            elements.send(now, np.flatnonzero(
                elements.ready(now) & (elements.sent < elements.end)))


def direct_clocks(elements: Elements, streams: ElementStreams, crossbar: Crossbar,
                  ports: UnitPorts, broadcast: ControllersBroadcast | ListBroadcasts
                  ) -> Float64:
    """float64 (triangles,): the last clock in which a unit is at work for each triangle, as
    ``streams`` count them."""
    drawn = np.zeros(len(streams.walk))
    now, queued = 0, True
    while queued or not ports.idle or not elements.done:
        element, unit = crossbar.chosen(ports.ready())
        drawn[elements.draw(now, crossbar)] = now
        found = ports.take(unit, crossbar.queues.take(element, unit))
        drawn[streams.triangle[found]] = now + ports.latency
        elements.walk(now)
        broadcast.send(now, elements)
        queued = bool(crossbar.queues.waiting.any())
        now += 1
    return drawn
