"""The tables by which regions are dealt out to processing elements.

A table has for each region, row by row, the number of its processing element: int64 (regions,).
The slots of an element are its regions in ascending order.
"""

from __future__ import annotations

import heapq
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..specification.errors import InputError
from ..specification.ranges import MAXIMUM_SIZE, check_whole
from ..specification.regions import MAXIMUM_REGIONS

Int64 = NDArray[np.int64]

#: Weights of all regions together stay far below what int64 holds.
MOST_COUNTED = 1 << 48


def static_table(regions: int, elements: int) -> Int64:
    """Region modulo elements: what a machine begins with."""
    return np.arange(regions, dtype=np.int64) % elements


def runs_table(regions: int, elements: int) -> Int64:
    """A run of regions for each element: to element i of n the regions from i · R / n, rounded
    down, up to those of element i + 1.  Where a region is as wide as the screen these are Blazek's
    strips (1991), of any number of rows each.

    >>> runs_table(7, 3).tolist()
    [0, 0, 1, 1, 2, 2, 2]
    """
    ends = np.arange(1, elements + 1, dtype=np.int64) * regions // elements
    return np.searchsorted(ends, np.arange(regions), side="right")


def slots_of(table: Int64) -> Int64:
    """int64 (regions,): how many lower regions its processing element has."""
    order = np.argsort(table, kind="stable")
    begins = np.searchsorted(table[order], table[order])
    slots = np.empty(len(table), np.int64)
    slots[order] = np.arange(len(table)) - begins
    return slots


def _checked(counts: Any) -> Int64:
    """``InputError`` for what are no counts of regions."""
    numbers = np.asarray(counts)
    if (numbers.ndim != 1 or not np.issubdtype(numbers.dtype, np.integer)
            or (numbers < 0).any() or (numbers > MOST_COUNTED).any()):
        raise InputError("counts: are not whole numbers from 0 on, one for each region")
    return numbers.astype(np.int64)


def packed_table(counts: Int64, elements: int, slots: int) -> Int64:
    """The table for the next picture, from what was counted of each region in the last one.

    A region weighs its count and one more.  The heaviest comes first, of equal ones the lowest;
    each goes to the element that bears least so far, of these to one with fewest regions, of these
    to the lowest; an element that has ``slots`` regions gets no more.  Without the one more, and
    the limit, all empty regions would fall to one element.

    Ellsworth 1994, the greedy multiple-bin packing before figure 3.

    ``counts``           int64 (regions,), or anything that numpy makes that of
    ``elements, slots``  how many processing elements, and regions of each; together there is room
                         for all

    Raises ``InputError`` for anything else.

    >>> import cardcage
    >>> cardcage.packed_table([7, 1, 40, 2], elements=2, slots=3).tolist()
    [1, 1, 0, 1]
    """
    counts = _checked(counts)
    for name, number in (("elements", elements), ("slots", slots)):
        check_whole(name, number, 1, MAXIMUM_REGIONS * MAXIMUM_SIZE)
    if elements * slots < len(counts):
        raise InputError(f"slots: {slots} in each of {elements} processing elements do not hold "
                         f"{len(counts)} regions")
    weights = counts + 1
    table = np.empty(len(weights), np.int64)
    # Load, regions, number of each element that has room.
    room = [(0, 0, element) for element in range(elements)]
    for region in np.argsort(-weights, kind="stable").tolist():
        load, held, element = heapq.heappop(room)
        table[region] = element
        if held + 1 < slots:
            heapq.heappush(room, (load + int(weights[region]), held + 1, element))
    return table
