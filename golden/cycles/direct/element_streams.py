"""What the walkers of all processing elements find, and the fragments that leave them, in order."""

from __future__ import annotations

from dataclasses import dataclass, fields
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from ...organisations.organisation_of import organisation_of
from ...reference.coverage import Triangles
from ...reference.exact import fragments
from ...specification.configuration import MachineConfiguration
from ...specification.display_list import DisplayList
from ...specification.sampling_grid import Grid
from ..element_latencies import Pipeline
from ..element_spans import lattice_spans
from ..node_work import share_of_node
from ..row_clocks import entries_of

Int64 = NDArray[np.int64]

#: In place of a unit: the clock that a triangle's end without a span takes.
NO_FRAGMENT = -1


@dataclass(frozen=True, eq=False)
class ElementStreams:
    """int64 (n,) each, of some processing elements one after another.

    Of each triangle that may cover a pixel:

    ``primitive``  which of the display list
    ``walk``       clocks from this load of the walker to the next

    Of each entry, which is a row that leaves the walker:

    ``entry_of``   its triangle
    ``offset``     clocks from the load until it is found
    ``clocks``     slots that it is: its pixels, or one where it is no span but only the end

    Of each slot, which takes a clock:

    ``unit``       a fragment's memory unit, or ``NO_FRAGMENT``

    Of each fragment:

    ``triangle``   its triangle
    ``place``      unit · words + address
    ``rank``       depth and order; nothing where they were not asked for
    """

    primitive: Int64
    walk: Int64
    entry_of: Int64
    offset: Int64
    clocks: Int64
    unit: Int64
    triangle: Int64
    place: Int64
    rank: Int64

    @cached_property
    def last_entry(self) -> Int64:
        """Of each triangle."""
        return np.searchsorted(self.entry_of, np.arange(len(self.walk)), side="right") - 1

    @cached_property
    def slot(self) -> Int64:
        """int64 (entries + 1,): the first of each entry, and where all end."""
        return np.concatenate([[0], np.cumsum(self.clocks)])

    @property
    def lengths(self) -> tuple[int, int, int, int]:
        """Triangles, entries, slots and fragments."""
        return len(self.walk), len(self.offset), len(self.unit), len(self.place)


def joined(streams: list[ElementStreams]) -> tuple[ElementStreams, Int64]:
    """Those of several as one, and int64 (4, streams + 1): where triangles, entries, slots and
    fragments of each begin, and where all end."""
    firsts = np.cumsum([(0, 0, 0, 0), *(each.lengths for each in streams)], axis=0).T
    parts = {}
    for name in (field.name for field in fields(ElementStreams)):
        arrays = [getattr(each, name) for each in streams]
        if name in ("entry_of", "triangle"):
            arrays = [own + first for own, first in zip(arrays, firsts[0].tolist(), strict=False)]
        parts[name] = np.concatenate(arrays)
    return ElementStreams(**parts), firsts


def element_streams(configuration: MachineConfiguration, display_list: DisplayList, node: int,
                    pipeline: Pipeline, ranks: bool) -> ElementStreams:
    """Those of the element that is node ``node``; ``ranks``: ask for them."""
    organisation = organisation_of(configuration)
    own, listed = share_of_node(configuration, display_list, node)
    shifts = organisation.resolution.shifts
    triangles = Triangles.of(listed, Grid.of(listed, **shifts))
    primitive, blocks = own[triangles.primitive], organisation.each[node].blocks
    bits = configuration.order_bits
    order = ((organisation.shares(display_list).round[primitive]
              << configuration.node_order_bits) + node) & ((1 << bits) - 1)
    parts = []
    for spans in lattice_spans(triangles, blocks):
        entries, whole = entries_of(blocks, 1, spans, pipeline), spans.whole
        span, column = whole.expand()
        x, y, triangle = whole.first[span] + column, whole.row[span], whole.triangle[span]
        unit = organisation.unit(x, y)
        clocks = np.append(spans.length, 1)[entries.span]  # -1 where it is only the end
        slots = np.full(int(clocks.sum()), NO_FRAGMENT)
        slots[np.repeat(entries.span >= 0, clocks)] = unit
        rank = np.zeros(0, np.int64)
        if ranks:
            chosen = listed.chosen(triangles.primitive[spans.begin:spans.end])
            depth = fragments(chosen, shading="flat", **shifts).depth
            rank = (depth << bits) + order[triangle]
        parts.append(ElementStreams(
            primitive[spans.begin:spans.end], entries.walk,
            spans.begin + entries.triangle[entries.pair], entries.offset, clocks, slots, triangle,
            unit * organisation.words + organisation.word(x, y), rank))
    # Their triangles count from the first of the element already.
    return ElementStreams(*(np.concatenate([np.zeros(0, np.int64), *(
        getattr(part, field.name) for part in parts)]) for field in fields(ElementStreams)))
