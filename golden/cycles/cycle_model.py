"""Clocks that a machine takes for a list of triangles, by model instead of simulation.

A triangle costs a processing element clocks of its walker (``row_clocks``) and
clocks of its memory ports (``two_port_element``, ``one_port_element``).  The list is
followed triangle by triangle, through those elements that keep it::

    load   = max(broadcast + queue, the load before + its walk)
    drawn  = max(drawn before + draw, load + latency + alone)    with two ports

The walk is held up where the spans found ahead fill their places, and the broadcast
where the queue of any element is full.  All rows of a triangle are thought to run
ahead together; only of its last one is it asked whether there was a place.
``cycle_estimate`` is the rough and quick sum of the same parts.

Where units have one port each span is followed by itself, and its clocks are a model
too: what reads, writes and the scan's slots come to on average.  The model does not know
where the scan is as a list begins, so for a list that takes less than a few scan lines
it may be five percent off.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import Any, Protocol

import numpy as np
from numpy.typing import NDArray

from ..organisations.organisation_of import organisation_of
from ..reference.coverage import Triangles
from ..specification.configuration import MachineConfiguration
from ..specification.display_list import DisplayList
from ..specification.queues import OUTLINES_WAITING
from ..specification.sampling_grid import Grid
from .element_latencies import NEVER, PIPELINE, Drawn, Pipeline
from .element_spans import LatticeSpans, lattice_spans
from .one_port_element import OnePort
from .port_accesses import PortAccesses
from .row_clocks import Entries, entries_of
from .two_port_element import TwoPorts

Float64 = NDArray[np.float64]
Int64 = NDArray[np.int64]


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


@dataclass(frozen=True, eq=False)
class CyclePrediction:
    """What the model says of a list on a machine that is idle before, its pictures clear.

    ``finished``          float64 (n,): clocks from the first triangle taken until the machine is
                          done, were this triangle the last; of those that may cover a pixel
    ``setup_bound``       clocks to set up all of them at best; 0 where the host has done it
    ``broadcast_bound``   clocks to send all of them at best
    ``element_bound``     float64 (elements,): clocks in which each processing element alone, all
                          triangles at hand, finds its rows, and in which it has a fragment each;
                          the greater
    ``port_bound``        clocks of the busiest unit's one port; 0 with two
    """

    finished: Float64
    setup_bound: float
    broadcast_bound: float
    element_bound: Float64
    port_bound: float

    @property
    def cycles(self) -> float:
        """First triangle taken … last fragment written."""
        return float(self.finished[-1]) if len(self.finished) else 0.0

    @property
    def bounds(self) -> dict[str, float]:
        """What no machine of these parts is faster than, by name."""
        return {"busiest element": float(self.element_bound.max(initial=0)),
                "busiest port": self.port_bound, "set-up": self.setup_bound,
                "broadcast": self.broadcast_bound}

    @property
    def binding(self) -> str:
        """The greatest of the bounds."""
        return max(self.bounds, key=self.bounds.__getitem__)

    @property
    def bound(self) -> float:
        return self.bounds[self.binding]


def predict_cycles(configuration: MachineConfiguration, display_list: DisplayList,
                   pipeline: Pipeline = PIPELINE, after: DisplayList | None = None,
                   setup: SetupTiming | None = None) -> CyclePrediction:
    """The clocks for ``display_list``.

    ``after`` was drawn before on the same picture: it hides what lies behind.  ``setup`` is the
    machine's own set-up, or None where the triangles come prepared; ``pipeline`` is that of the
    machine.  Precision does not matter to the clocks.
    """
    organisation = organisation_of(configuration)
    triangles = Triangles.of(display_list,
                             Grid.of(display_list, **organisation.resolution.shifts))
    blocks = organisation.blocks
    elements = len(organisation.domains)
    ports: _Ports = (
        OnePort(configuration, PortAccesses(configuration, display_list, triangles, after),
                pipeline)
        if configuration.memory_ports == 1 else TwoPorts(configuration, pipeline))
    cage = _Cage(ports.elements, configuration.fifo_depth, pipeline)
    arrivals = None if setup is None else _SetUp(setup, triangles.primitive)
    finished: list[float] = []
    bound = np.zeros((2, elements))
    for spans in lattice_spans(triangles, blocks):
        entries = entries_of(blocks, elements, spans, pipeline)
        bound += [np.bincount(entries.element, entries.walk, elements),
                  np.bincount(spans.element, spans.length, elements)]
        pairs = list(zip(entries.element.tolist(), entries.walk.tolist(),
                         ports.costs(entries, spans), strict=True))
        places = np.searchsorted(entries.triangle, np.arange(spans.end - spans.begin + 1)).tolist()
        for first, end in pairwise(places):
            sent = cage.broadcast(0.0 if arrivals is None else arrivals.arrival())
            if arrivals is not None:
                arrivals.leaves(sent)
            for element, walk, cost in pairs[first:end]:
                cage.take(element, walk, cost)
            finished.append(cage.finished)
    kept = len(triangles)
    setup_bound = 0 if setup is None else max(setup.interval * kept, display_list.triangles)
    return CyclePrediction(np.array(finished), float(setup_bound), float(kept), bound.max(axis=0),
                           ports.bound)


class _Element(Protocol):
    """A processing element, told its triangles in drawing order."""

    def take(self, load: float, cost: Any) -> Drawn:
        """A triangle that its walker loads then, and what it costs at the ports."""


class _Ports(Protocol):
    """The ports of all memory units, and the elements before them.

    ``bound``  clocks that the busiest of them needs at least; 0 where none ever waits
    """

    @property
    def elements(self) -> Sequence[_Element]: ...

    @property
    def bound(self) -> float: ...

    def costs(self, entries: Entries, spans: LatticeSpans) -> Sequence[Any]:
        """The cost of each pair, as the pair's element takes it."""


class _SetUp:
    """When the set-up has each triangle ready."""

    def __init__(self, timing: SetupTiming, primitive: Int64) -> None:
        self._timing = timing
        #: Clocks to offer each triangle together with those before it that cover no pixel.
        self._offers = iter(np.diff(primitive, prepend=-1).tolist())
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
        self._sent.append(sent)


class _Cage:
    """The broadcast and all processing elements.

    ``finished``  when all would be done, were there no more triangles
    """

    def __init__(self, elements: Sequence[_Element], fifo_depth: int,
                 pipeline: Pipeline) -> None:
        self._pipeline = pipeline
        self._elements = elements
        self._load = [NEVER] * len(elements)
        # When the places of each element's triangles became free, the next one to be taken first.
        self._free = [deque([NEVER] * (fifo_depth - 1)) for _ in elements]
        self._sent = -1.0
        # From when on all have a place: with, and without the last triangle that was sent.
        self._room = self._earlier_room = NEVER
        self.finished = NEVER

    def broadcast(self, arrival: float) -> float:
        """When a triangle that is ready at ``arrival`` is sent.

        A queue is ready while it has a place more than it shows; what was sent a clock ago does
        not show yet.
        """
        following = self._sent + 1
        if arrival <= following and self._earlier_room <= following:
            self._sent = following
        else:
            self._sent = max(arrival, following + 1, self._room)
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
