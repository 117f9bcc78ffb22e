"""Clocks that a machine takes for a list of triangles, by model instead of simulation.

A triangle costs a processing element clocks of its walker and clocks of its memory
ports (``element_clocks``); the list is followed triangle by triangle, all elements at
once::

    load   = max(broadcast + queue, the load before + its walk)
    drawn  = max(drawn before + draw, load + latency + alone)

The walk is held up where the spans found ahead fill their places, and the broadcast
where the queue of any element is full.  All rows of a triangle are thought to run
ahead together; only of its last one is it asked whether there was a place.
``cycle_estimate`` is the rough and quick sum of the same parts.

Where a unit has one port, the clocks of a span are a model too: what reads, writes
and the scan's slots come to on average.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from .configuration import MachineConfiguration
from .coverage import Triangles
from .display_list import DisplayList
from .element_clocks import ElementClocks, Pipeline, element_clocks
from .grid import Grid
from .lattice_spans import lattice_blocks, lattice_spans
from .port_clocks import PortClocks

Float64 = NDArray[np.float64]
Int64 = NDArray[np.int64]

PIPELINE = Pipeline()

#: Long before all that counts.
_NEVER = -1e15


@dataclass(frozen=True)
class SetupTiming:
    """A set-up in hardware, in clocks unless said otherwise.

    ``interval``  between two triangles that may cover a pixel; others take one each
    ``latency``   from a triangle to its broadcast
    ``waiting``   triangles that can wait to be set up
    ``inside``    triangles that can be in it, prepared ones that wait included
    ``leaving``   between two broadcasts of waiting ones
    """

    interval: int
    latency: int = 0
    waiting: int = 16
    inside: int = 1
    leaving: int = 2


@dataclass(frozen=True, eq=False)
class CyclePrediction:
    """What the model says of a list on a machine that is idle before, its pictures clear.

    ``finished``          float64 (n,): clocks from the first triangle taken until the machine is
                          done, were this triangle the last; of those that may cover a pixel
    ``setup_bound``       clocks to set up all of them at best; 0 where the host has done it
    ``broadcast_bound``   clocks to send all of them at best
    ``element_bound``     float64 (elements,): clocks in which each processing element alone, all
                          triangles at hand, must walk, and in which it must draw; the greater
    """

    finished: Float64
    setup_bound: float
    broadcast_bound: float
    element_bound: Float64

    @property
    def cycles(self) -> float:
        """First triangle taken … last fragment written."""
        return float(self.finished[-1]) if len(self.finished) else 0.0

    @property
    def bounds(self) -> dict[str, float]:
        """What no machine of these parts is faster than, by name."""
        return {"busiest element": float(self.element_bound.max(initial=0)),
                "set-up": self.setup_bound, "broadcast": self.broadcast_bound}

    @property
    def binding(self) -> str:
        """The greatest of the bounds."""
        return max(self.bounds, key=self.bounds.__getitem__)

    @property
    def bound(self) -> float:
        return self.bounds[self.binding]


def predict_cycles(configuration: MachineConfiguration, display_list: DisplayList,
                   pipeline: Pipeline = PIPELINE, fifo_depths: Sequence[int] | None = None,
                   after: DisplayList | None = None,
                   setup: SetupTiming | None = None) -> list[CyclePrediction]:
    """The clocks for ``display_list``, for each depth of the FIFOs; by default the machine's own.

    ``after`` was drawn before on the same picture: it hides what lies behind.  ``setup`` is the
    machine's own set-up, or None where the triangles come prepared.  Precision does not matter to
    the clocks.
    """
    interlace = configuration.interlace
    triangles = Triangles.of(display_list,
                             Grid.of(display_list, interlace.x_shift, interlace.y_shift))
    blocks = lattice_blocks(configuration)
    elements = configuration.processing_elements
    depths = [configuration.fifo_depth] if fifo_depths is None else list(fifo_depths)
    ports = PortClocks(configuration, display_list, triangles, after)
    cage = _Cage(elements, depths, pipeline)
    arrivals = _Prepared() if setup is None else _SetUp(setup, triangles.primitive, len(depths))
    finished = np.zeros((len(depths), len(triangles)))
    bound = np.zeros((2, elements))
    for spans in lattice_spans(triangles, blocks):
        clocks = element_clocks(blocks, elements, spans, ports.of(spans), pipeline)
        bound += [np.bincount(clocks.element, sums, elements) for sums in (clocks.walk,
                                                                           clocks.draw)]
        bounds = np.searchsorted(clocks.triangle, np.arange(spans.end - spans.begin + 1)).tolist()
        for place, (first, end) in enumerate(pairwise(bounds)):
            number = spans.begin + place
            sent = cage.broadcast(arrivals.arrival(number))
            arrivals.leaves(number, sent)
            cage.take(clocks, slice(first, end))
            finished[:, number] = cage.finished
    triangles_bound = float(len(triangles))
    setup_bound = 0.0
    if setup is not None:
        setup_bound = max(setup.interval * triangles_bound, float(display_list.triangles))
    return [CyclePrediction(done, setup_bound, triangles_bound, bound.max(axis=0))
            for done in finished]


class _Prepared:
    """Triangles that are always at hand."""

    def arrival(self, number: int) -> Float64:
        return np.zeros(1)

    def leaves(self, number: int, sent: Float64) -> None:
        pass


class _SetUp:
    """When the set-up has each triangle ready; for several depths of the FIFOs at once."""

    def __init__(self, timing: SetupTiming, primitive: Int64, depths: int) -> None:
        self._timing = timing
        #: Clocks that it takes to offer each triangle, and those before it that cover no pixel.
        self._offer = np.diff(primitive, prepend=-1)
        self._offered = np.full(depths, -1.0)
        self._entered = np.full((len(primitive), depths), _NEVER)
        self._sent = np.full((len(primitive), depths), _NEVER)

    def arrival(self, number: int) -> Float64:
        timing, entered, sent = self._timing, self._entered, self._sent

        def earlier(times: Float64, places: int) -> Float64:
            return np.asarray(times[number - places] if number >= places else _NEVER)

        self._offered = np.maximum(self._offered + self._offer[number],
                                   earlier(entered, timing.waiting))
        entered[number] = np.maximum.reduce(np.broadcast_arrays(
            self._offered, earlier(entered, 1) + timing.interval, earlier(sent, timing.inside)))
        return np.asarray(np.maximum(entered[number] + timing.latency,
                                     earlier(sent, 1) + timing.leaving))

    def leaves(self, number: int, sent: Float64) -> None:
        self._sent[number] = sent


class _Cage:
    """The broadcast and all processing elements, for several depths of the FIFOs at once."""

    def __init__(self, elements: int, depths: list[int], pipeline: Pipeline) -> None:
        self._pipeline = pipeline
        never = np.full((len(depths), elements), _NEVER)
        self._load, self._drawn, self._room = never, never.copy(), never.copy()
        self._sent = np.full(len(depths), -1.0)
        #: From when on all have a place: with, and without the last triangle that was sent.
        self._all_room = self._earlier_room = np.full(len(depths), _NEVER)
        # When the places of each element's triangles became free, in a ring.
        self._places = np.array(depths)[:, np.newaxis] - 1
        self._freed = np.full((len(depths), elements, max(depths)), _NEVER)
        self._taken = np.zeros(elements, np.int64)
        self._lines = np.arange(len(depths))[:, np.newaxis]
        self.finished = np.zeros(len(depths))

    def broadcast(self, arrival: Float64) -> Float64:
        """When a triangle that is ready at ``arrival`` is sent.

        A queue is ready while it has a place more than it shows; what was sent a clock ago does
        not show yet.
        """
        following = self._sent + 1
        at_once = (arrival <= following) & (self._earlier_room <= following)
        self._sent = np.where(at_once, following, np.maximum(
            np.maximum(arrival, following + 1), self._all_room))
        self._earlier_room = self._all_room
        return self._sent

    def take(self, clocks: ElementClocks, kept: slice) -> None:
        """The triangle that was sent; ``kept`` are its entries."""
        pipeline, element = self._pipeline, clocks.element[kept]
        if not len(element):
            return
        load = np.maximum(self._load[:, element], self._sent[:, np.newaxis] + pipeline.queue)
        walked = load + clocks.walk[kept]
        drawn = np.maximum(self._drawn[:, element] + clocks.draw[kept],
                           load + pipeline.latency + clocks.alone[kept])
        self._drawn[:, element] = drawn
        self._load[:, element] = np.maximum(walked, drawn - clocks.held[kept])
        size = self._freed.shape[2]
        taken = self._taken[element]
        self._freed[:, element, taken % size] = 1 + np.maximum(
            walked + pipeline.found, drawn - clocks.started[kept])
        self._taken[element] = taken = taken + 1
        # The place that the next triangle takes is that of so many triangles ago.
        self._room[:, element] = np.where(
            taken >= self._places,
            self._freed[self._lines, element, (taken - self._places) % size], _NEVER)
        self._all_room = self._room.max(axis=1)
        self.finished = np.maximum(self.finished, drawn.max(axis=1) + pipeline.finish)
