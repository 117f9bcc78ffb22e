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

In a cage of nodes the elements of a node only get its own triangles.  The host sends them all
through one broadcast, which waits only for the queues of the node that is to get the next one;
or each node has its share in a list, and all send theirs at the same time; or each makes the
triangles of its objects itself (``objects``).  Elements without
pixels of their own are followed clock by clock (``direct``): they wait for memory units, and so for
one another.  Where regions are dealt out a triangle is walked visit by visit (``regions``).

Where units have one port each span is followed by itself, and its clocks are a model
too: what reads and writes come to on average, and the scan's slots.  Where it is not told
where the scan is as a list begins, a list that takes less than a scan may be five percent off,
and with regions, which the scan reads one after another, twenty.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..organisations.dealt_regions import DealtRegions
from ..organisations.organisation_of import organisation_of
from ..specification.configuration import MachineConfiguration
from ..specification.display_list import DisplayList
from .broadcast import ControllersBroadcast, ListBroadcasts, NodeQueues, SetUp, SetupTiming
from .direct.direct_work import DirectWork
from .element_latencies import NEVER, PIPELINE, Pipeline
from .node_work import NodeWork
from .objects.element_objects import ForwardedRun
from .objects.node_objects import ObjectRun
from .regions.region_work import RegionWork

Float64 = NDArray[np.float64]
Int64 = NDArray[np.int64]


@dataclass(frozen=True, eq=False)
class CyclePrediction:
    """What the model says of a list on a machine that is idle before, its pictures clear.

    ``finished``          float64 (n,): clocks from the first triangle taken, or from the command to
                          draw the lists, until the machine is done, were this triangle the last;
                          of those that may cover a pixel, in the order in which the host sends
                          them, those of lists in the display list's; where elements pass objects
                          on of each object
    ``setup_bound``       clocks to set up all of them at best; 0 where that was done before; where
                          nodes do it, all those of one
    ``broadcast_bound``   clocks to send all of them, or the objects, at best
    ``element_bound``     float64 (elements,): clocks in which each processing element alone, all
                          triangles at hand, finds its rows, and in which it has a fragment each;
                          the greater
    ``port_bound``        clocks of the busiest unit's one port; 0 with two, but where elements
                          share units what the busiest one takes
    """

    finished: Float64
    setup_bound: float
    broadcast_bound: float
    element_bound: Float64
    port_bound: float

    @property
    def cycles(self) -> float:
        """First triangle taken, or the command to draw the lists … last fragment written."""
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
                   setup: SetupTiming | None = None, retained: bool = False,
                   table: Int64 | None = None, begin: int | None = None,
                   shown: Int64 | None = None) -> CyclePrediction:
    """The clocks for ``display_list``.

    ``after`` was drawn before on the same picture: it hides what lies behind.  ``setup`` is the
    machine's own set-up, or None where the triangles come prepared; ``pipeline`` is that of the
    machine.  ``retained``: the nodes draw it from their lists.  ``table``: what regions are dealt
    out by, int64 (regions,), or None for what a machine begins with.  ``begin``: the first triangle
    is taken, or the command to draw the lists, so many clocks after a scan began to show its first
    line; None where nobody knows.  Only where units have one port is it looked at: then lists of
    a few scan lines are within 2 % of the machine, too.  ``shown``: the table of the picture that
    is shown meanwhile, by which the scan reads, if it is another; before the first one is shown
    nobody has written it.  Precision does not matter to the clocks.
    """
    if configuration.merges_directly:
        return _predict_direct(configuration, display_list, pipeline, after, setup, retained,
                               begin)
    organisation = organisation_of(configuration).dealt(table)
    works: list[Any] = (
        [RegionWork(organisation, display_list, pipeline, after, begin,
                    None if shown is None else organisation.dealt(shown))]
        if isinstance(organisation, DealtRegions) else
        [NodeWork(organisation, display_list, node, pipeline, after, begin)
         for node in range(configuration.nodes)])
    if configuration.forwards_objects and setup is not None:
        return _predict_forwarded(configuration, display_list, works[0], pipeline, setup)
    if configuration.objects in ("nodes", "controller") and setup is not None:
        return _predict_objects(configuration, display_list, works, pipeline, setup)
    sent, nodes, _ = _sending_order(
        configuration, display_list, np.concatenate([work.primitive for work in works]), retained)
    broadcast = (ListBroadcasts() if retained else
                 ControllersBroadcast(None if setup is None else SetUp(setup, sent)))
    queues = [NodeQueues(work.elements, configuration.fifo_depth, pipeline) for work in works]
    triangles = [iter(work) for work in works]
    finished: list[float] = []
    done = NEVER
    for node in nodes.tolist():
        queue = queues[node]
        broadcast.send(queue)
        for element, walk, cost in next(triangles[node]):
            queue.take(element, walk, cost)
        done = max(done, queue.finished)
        finished.append(done)
    kept = [len(work.primitive) for work in works]
    return CyclePrediction(
        np.array(finished), _setup_bound(display_list, setup, sum(kept), retained),
        float(max(kept) if retained else sum(kept)),
        np.concatenate([work.bound for work in works]), max(work.port_bound for work in works))


def _predict_forwarded(configuration: MachineConfiguration, display_list: DisplayList,
                       work: NodeWork, pipeline: Pipeline,
                       setup: SetupTiming) -> CyclePrediction:
    """Where processing elements make the triangles of objects, and pass objects on."""
    run = ForwardedRun(configuration, display_list, work, pipeline, setup)
    return CyclePrediction(
        np.array(run.finished),
        float(np.maximum(setup.interval * run.kept, run.made).max(initial=0)),
        float(run.commands), work.bound, work.port_bound)


def _predict_objects(configuration: MachineConfiguration, display_list: DisplayList,
                     works: list[NodeWork], pipeline: Pipeline,
                     setup: SetupTiming) -> CyclePrediction:
    """Where each node makes the triangles of its objects, or the controller those of all."""
    run = ObjectRun(configuration, display_list, works, pipeline, setup)
    made = np.bincount(organisation_of(configuration).shares(display_list).node,
                       minlength=configuration.nodes)
    return CyclePrediction(
        np.array(run.finished),
        float(np.maximum(setup.interval * run.kept, made).max()), float(run.commands),
        np.concatenate([work.bound for work in works]), max(work.port_bound for work in works))


def _predict_direct(configuration: MachineConfiguration, display_list: DisplayList,
                    pipeline: Pipeline, after: DisplayList | None, setup: SetupTiming | None,
                    retained: bool, begin: int | None) -> CyclePrediction:
    """Where elements have no pixels of their own."""
    work = DirectWork(configuration, display_list, pipeline, after, begin)
    sent, nodes, order = _sending_order(configuration, display_list, work.primitive, retained)
    drawn = work.drawn(nodes, None if setup is None else SetUp(setup, sent), retained)
    triangles = len(sent)
    broadcast = np.bincount(nodes, minlength=1).max() if retained else triangles
    return CyclePrediction(
        np.maximum.accumulate(drawn[order]),
        _setup_bound(display_list, setup, triangles, retained), float(broadcast), work.bound,
        work.port_bound)


def _setup_bound(display_list: DisplayList, setup: SetupTiming | None, kept: int,
                 retained: bool) -> float:
    if retained or setup is None:
        return 0.0
    return float(max(setup.interval * kept, display_list.triangles))


def _sending_order(configuration: MachineConfiguration, display_list: DisplayList,
                   primitive: Int64, retained: bool) -> tuple[Int64, Int64, Int64]:
    """Of the triangles ``primitive``, which may cover a pixel, one after another as the host sends
    them, the place of each among all, its node, and which of them it is.

    Lists that are retained are followed side by side: triangle by triangle of the display list.
    """
    shares = organisation_of(configuration).shares(display_list)
    place = np.arange(shares.triangles) if retained else shares.host_place
    order = np.argsort(place[primitive])
    return place[primitive][order], shares.node[primitive][order], order
