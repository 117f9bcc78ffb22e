"""Who draws an object where processing elements pass objects on, and who passes it to whom.

Elements stand in a row.  One of them has an object from the host.  Every element that has a region
in which the object can have a pixel draws it; it comes there from neighbour to neighbour, away from
the one that had it first.  (Blazek 1991, node initiated with object forwarding.)
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

Int64 = NDArray[np.int64]
Bool = NDArray[np.bool_]


@dataclass(frozen=True, eq=False)
class ForwardedObjects:
    """``elements``  how many processing elements there are
    ``source``    int64 (objects,): the one that has each from the host
    ``met``       bool (objects, regions): the regions in which each can have a pixel
    ``table``     int64 (regions,): the processing element of each region, ascending

    >>> met = np.array([[True, True, False], [False, False, False], [False, True, True]])
    >>> forwarded = ForwardedObjects(3, np.array([2, 0, 1]), met, np.array([0, 1, 2]))
    >>> forwarded.drawn.sum(axis=0).tolist(), forwarded.left.tolist(), forwarded.right.tolist()
    ([1, 2, 1], [0, 1, 1], [0, 1, 0])
    """

    elements: int
    source: Int64
    met: Bool
    table: Int64

    @cached_property
    def drawn(self) -> Bool:
        """bool (objects, elements): who draws which."""
        drawn = np.zeros((len(self.source), self.elements), bool)
        objects, regions = np.nonzero(self.met)
        drawn[objects, self.table[regions]] = True
        return drawn

    @cached_property
    def _ends(self) -> tuple[Int64, Int64]:
        """int64 (objects, 1): the first and the last element that draws each; of one that nobody
        draws that which has it."""
        some = self.drawn.any(axis=1)
        first = np.where(some, self.drawn.argmax(axis=1), self.source)
        last = np.where(some, self.elements - 1 - self.drawn[:, ::-1].argmax(axis=1), self.source)
        return first[:, np.newaxis], last[:, np.newaxis]

    @cached_property
    def left(self) -> Int64:
        """int64 (elements,): objects that each has passed to its left neighbour."""
        element = np.arange(self.elements)
        passed = (self._ends[0] < element) & (element <= self.source[:, np.newaxis])
        return np.asarray(passed.sum(axis=0), np.int64)

    @cached_property
    def right(self) -> Int64:
        """int64 (elements,): to its right neighbour."""
        element = np.arange(self.elements)
        passed = (self.source[:, np.newaxis] <= element) & (element < self._ends[1])
        return np.asarray(passed.sum(axis=0), np.int64)
