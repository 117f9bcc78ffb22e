"""What each triangle costs the processing elements of the node that draws it."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import pairwise
from typing import Any, Protocol

import numpy as np
from numpy.typing import NDArray

from ..organisations.organisation import Organisation
from ..organisations.organisation_of import organisation_of
from ..reference.coverage import Triangles
from ..specification.configuration import MachineConfiguration
from ..specification.display_list import DisplayList
from ..specification.sampling_grid import Grid
from .broadcast import Element
from .element_latencies import Pipeline
from .element_spans import lattice_spans
from .one_port.one_port_element import OnePort
from .one_port.port_accesses import PortAccesses
from .row_clocks import Entries, WalkedSpans, entries_of
from .two_port_element import TwoPorts

Float64 = NDArray[np.float64]
Int64 = NDArray[np.int64]

#: Which of the node's elements, clocks of its walker, cost at its ports.
ElementWork = tuple[int, int, Any]


class _Ports(Protocol):
    """The ports of a node's memory units, and the elements before them.

    ``bound``  clocks that the busiest of them needs at least; 0 where none ever waits
    """

    @property
    def elements(self) -> Sequence[Element]: ...

    @property
    def bound(self) -> float: ...

    def costs(self, entries: Entries, spans: WalkedSpans) -> Sequence[Any]:
        """The cost of each pair, as the pair's element takes it."""


class NodeWork:
    """The triangles of a display list that one node draws.

    ``primitive``  int64 (n,): which of the whole list may cover a pixel, in its order
    ``elements``   of the node
    ``bound``      float64 (elements,): clocks in which each alone, all triangles at hand, finds its
                   rows, and in which it has a fragment each, the greater; of triangles asked for

    The list ``after`` was drawn before it, by all nodes.  ``begin``: as of ``predict_cycles``.
    ``scanned``: as of ``OnePort``.
    """

    def __init__(self, organisation: Organisation, display_list: DisplayList, node: int,
                 pipeline: Pipeline, after: DisplayList | None = None,
                 begin: int | None = None, scanned: Organisation | None = None) -> None:
        configuration = organisation.configuration
        own, listed = share_of_node(configuration, display_list, node)
        before = None if after is None else share_of_node(configuration, after, node)[1]
        self._organisation = organisation.each[node]
        self._triangles = Triangles.of(listed, Grid.of(listed, **organisation.resolution.shifts))
        self.primitive = own[self._triangles.primitive]
        self._pipeline = pipeline
        self._ports: _Ports = (
            OnePort(organisation, PortAccesses(organisation, listed, self._triangles, before, node),
                    pipeline, node, begin, scanned)
            if configuration.memory_ports == 1
            else TwoPorts(len(self._organisation.domains), pipeline))
        self.elements: Sequence[Element] = self._ports.elements
        self._bound = np.zeros((2, len(self.elements)))

    def _walked(self) -> Iterator[tuple[Entries, WalkedSpans]]:
        """Some triangles after others, and what leaves the walkers for them."""
        blocks = self._organisation.blocks
        for spans in lattice_spans(self._triangles, blocks):
            yield entries_of(blocks, len(self.elements), spans, self._pipeline), spans

    def __iter__(self) -> Iterator[list[ElementWork]]:
        """Of each triangle, in order, what it costs those elements that keep it."""
        elements = len(self.elements)
        for entries, spans in self._walked():
            self._bound += [np.bincount(entries.element, entries.walk, elements),
                            np.bincount(spans.element, spans.length, elements)]
            work = list(zip(entries.element.tolist(), entries.walk.tolist(),
                            self._ports.costs(entries, spans), strict=True))
            count = spans.end - spans.begin
            places = np.searchsorted(entries.triangle, np.arange(count + 1)).tolist()
            for first, end in pairwise(places):
                yield work[first:end]

    @property
    def bound(self) -> Float64:
        return np.asarray(self._bound.max(axis=0))

    @property
    def port_bound(self) -> float:
        """Clocks of the node's busiest unit's one port, likewise; 0 with two."""
        return self._ports.bound


def share_of_node(configuration: MachineConfiguration, display_list: DisplayList,
                  node: int) -> tuple[Int64, DisplayList]:
    """The numbers of a node's triangles, and a list of these."""
    shares = organisation_of(configuration).shares(display_list)
    own = shares.of_node(node)
    return own, display_list if shares.nodes == 1 else display_list.chosen(own)
