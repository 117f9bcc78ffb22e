"""Merging in memory: each fragment goes to the unit of its pixel, which keeps the nearest (Denali,
in Cox and Hanrahan 1993, section 4)."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field, replace

import numpy as np
from numpy.typing import NDArray

from ..organisations.organisation import Organisation
from ..reference.coverage import FRAGMENT_LIMIT, Triangles, spans
from ..specification.display_list import DisplayList
from ..specification.sampling_grid import Grid
from .node_picture import NodePicture, merged
from .traffic import Send, Traffic

Int64 = NDArray[np.int64]


@dataclass(frozen=True)
class DirectTraffic(Traffic):
    """Every fragment, on private lines: from its element, and then to its memory unit.

    ``taken``  int64 (elements, units): fragments of each element for each unit
    """

    taken: Int64 = field(kw_only=True)

    @property
    def pieces(self) -> Int64:
        """int64 (elements + units,): the fragments on the line from each element, then on that to
        each unit."""
        return np.concatenate([self.taken.sum(axis=1), self.taken.sum(axis=0)])


def merge_direct(pictures: Sequence[NodePicture], node_order_bits: int) -> NodePicture:
    """The picture that memory keeps of those that elements would draw alone.

    Fragments of different elements come in any order, so that the number of the element is kept,
    as the lowest ``node_order_bits`` of the order; 0 keeps none, which is right where no two
    elements tie, and else leaves open who wins: here the lower one.
    """
    return merged([
        replace(picture, order=np.where(
            picture.drawn, picture.order << node_order_bits | node,
            ((picture.order + 1) << node_order_bits) - 1) if node_order_bits else picture.order)
        for node, picture in enumerate(pictures)])


def direct_traffic(organisation: Organisation, display_list: DisplayList) -> DirectTraffic:
    """Who sends how many fragments to which unit, hidden ones too."""
    node = organisation.shares(display_list).node
    units, resolution = organisation.memory_units, organisation.resolution
    counts = np.zeros(organisation.nodes * units, np.int64)
    triangles = Triangles.of(display_list, Grid.of(display_list, **resolution.shifts))
    for rows in spans(triangles):
        for runs in rows.chunks(FRAGMENT_LIMIT):
            span, column = runs.expand()
            unit = organisation.unit(runs.first[span] + column, runs.row[span])
            element = node[triangles.primitive[runs.triangle]][span]
            counts += np.bincount(element * units + unit, minlength=len(counts))
    taken = counts.reshape(-1, units)
    return DirectTraffic(
        organisation.nodes, [Send(0, element, None, fragments) for element, fragments in
                             enumerate(taken.sum(axis=1).tolist())], taken=taken)
