"""Ways to deal the triangles out to nodes, the machine's packets and others.

All but the packets are runs: each node gets triangles that follow one another, in the list or in
another order.  What they are cut by is known to a host that sets triangles up.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ....golden.organisations.shares import Shares
from ....golden.reference.triangle_setup import outline
from ....golden.specification.configuration import Packet
from ....golden.specification.display_list import DisplayList
from ....golden.specification.sampling_grid import Grid

Int64 = NDArray[np.int64]
Float64 = NDArray[np.float64]

PACKETS: tuple[Packet, ...] = (1, 10, 30, 100, 300, "contiguous")


@dataclass(frozen=True)
class Assignment:
    """``node_of`` (a display list, a number of nodes) → int64 (triangles,): whose each is.

    ``keeps_order``  lower nodes have earlier triangles, or pixels carry their round: of equal
                     depths the earlier triangle keeps the pixel, as the picture's contract has it.
                     Otherwise the host draws the same triangles as another list.
    """

    name: str
    keeps_order: bool
    node_of: Callable[[DisplayList, int], Int64]


def packets(packet: Packet) -> Assignment:
    name = "contiguous" if packet == "contiguous" else (
        "round robin" if packet == 1 else f"packets of {packet}")
    return Assignment(name, True,
                      lambda listed, nodes: Shares(nodes, listed.triangles, packet).node)


def boxes(display_list: DisplayList) -> Float64:
    """float64 (triangles,): pixels of the box of each; none where set-up leaves it out."""
    return _estimates(display_list)[0]


def work(display_list: DisplayList) -> Float64:
    """float64 (triangles,): about the clocks that a processing element needs for each: one for a
    row, one for a pixel of its area; whichever are more."""
    _, rows, area = _estimates(display_list)
    return np.maximum(rows, np.where(rows > 0, area, 0))


def _estimates(display_list: DisplayList) -> tuple[Float64, Float64, Float64]:
    outlines = outline(display_list, Grid.of(display_list)).boxes
    box, rows = np.zeros((2, display_list.triangles))
    high = (outlines.bottom - outlines.top).astype(np.float64)
    rows[outlines.primitive] = high
    box[outlines.primitive] = high * (outlines.right - outlines.left)
    first, second, third = np.moveaxis(display_list.position.astype(np.float64), 1, 0)
    (ax, ay), (bx, by) = (second - first).T, (third - first).T
    return box, rows, abs(ax * by - ay * bx) / 2 / 4**display_list.sub_bits


def runs(costs: Float64, nodes: int, order: Int64 | None = None) -> Int64:
    """int64 (n,): whose each is, if every node gets one run of as equal a cost as can be; of the
    list, or of ``order``.

    >>> runs(np.array([1.0, 1.0, 1.0, 3.0]), 2).tolist()
    [0, 0, 0, 1]
    """
    order = np.arange(len(costs)) if order is None else order
    costs = costs[order]
    middle = np.cumsum(costs) - costs / 2
    total = max(float(costs.sum()), 1.0)
    node = np.empty(len(costs), np.int64)
    node[order] = np.minimum(middle * nodes / total, nodes - 1)
    return node


def nearest_first(display_list: DisplayList) -> Int64:
    """int64 (triangles,): the triangles by their nearest vertices."""
    return np.argsort(display_list.depth.min(axis=1), kind="stable")


def _nearest(display_list: DisplayList, nodes: int) -> Int64:
    return runs(np.ones(display_list.triangles), nodes, nearest_first(display_list))


def _nearest_work(display_list: DisplayList, nodes: int) -> Int64:
    return runs(work(display_list), nodes, nearest_first(display_list))


ROUND_ROBIN, EQUAL_WORK, NEAREST_WORK = (
    "round robin", "runs of equal work", "nearest first, runs of equal work")

ASSIGNMENTS = (
    *map(packets, PACKETS),
    Assignment("runs of equal boxes", True, lambda listed, nodes: runs(boxes(listed), nodes)),
    Assignment(EQUAL_WORK, True, lambda listed, nodes: Shares.of(listed, nodes, "work").node),
    Assignment("nearest first, contiguous", False, _nearest),
    Assignment(NEAREST_WORK, False, _nearest_work),
)
