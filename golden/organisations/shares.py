"""Which node draws which triangle: a contract between host, machine and golden models."""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from ..specification.configuration import ONE_PACKET_EACH, Packet
from ..specification.display_list import DisplayList
from ..specification.errors import InputError

Int64 = NDArray[np.int64]


@dataclass(frozen=True)
class Shares:
    """The triangles of a display list dealt out to nodes, a packet at a time.

    ``nodes``      how many there are
    ``triangles``  of the whole display list, before set-up leaves anything out: what that leaves
                   out depends on the resolution, and a share must not
    ``packet``     triangles that follow one another in the list and go to one node; 1 is round
                   robin, ``"contiguous"`` gives each node one run of the list, of as many
                   triangles, ``"work"`` one of as much ``work``
    ``work``       int64 (triangles,): see ``triangle_work``; only for that

    Raises ``InputError`` where a number is out of range.

    >>> shares = Shares(nodes=2, triangles=7, packet=2)
    >>> shares.node.tolist(), shares.round.tolist()
    ([0, 0, 1, 1, 0, 0, 1], [0, 0, 0, 0, 1, 1, 1])
    >>> shares.host_order.tolist()
    [0, 2, 1, 3, 4, 6, 5]
    """

    nodes: int
    triangles: int
    packet: Packet = 1
    work: Int64 | None = field(default=None, compare=False)

    @classmethod
    def of(cls, display_list: DisplayList, nodes: int, packet: Packet) -> Shares:
        """Of a display list."""
        work = triangle_work(display_list) if packet == "work" else None
        return cls(nodes, display_list.triangles, packet, work)

    def __post_init__(self) -> None:
        if self.nodes < 1:
            raise InputError(f"nodes: {self.nodes} is less than 1")
        if isinstance(self.packet, int) and self.packet < 1:
            raise InputError(f"packet: {self.packet} is less than 1; take how many triangles "
                             "follow one another to a node, or contiguous, or work")
        if (self.packet == "work") != (self.work is not None):
            raise ValueError("work is for packets of equal work, and for no others")

    @property
    def items(self) -> int:
        """What a packet counts: triangles."""
        return self.triangles

    @property
    def packet_triangles(self) -> int:
        """Triangles in a packet, as a number; not where packets differ."""
        if self.packet == "contiguous":
            return max(1, -(-self.triangles // self.nodes))
        assert isinstance(self.packet, int)
        return self.packet

    @property
    def rounds(self) -> int:
        """How often every node has its turn; 1 at least."""
        if self.packet in ONE_PACKET_EACH:
            return 1
        return max(1, -(-self.triangles // (self.packet_triangles * self.nodes)))

    @property
    def order_bits(self) -> int:
        """Bits that number the rounds; none where there is only one."""
        return (self.rounds - 1).bit_length()

    @cached_property
    def node(self) -> Int64:
        """int64 (triangles,): the node that draws each."""
        if self.work is not None:  # in whose share of all work the middle of its own lies
            total = max(1, int(self.work.sum()))
            middle = 2 * self._work_before + self.work
            return np.asarray(np.minimum(middle * self.nodes // (2 * total), self.nodes - 1))
        return np.arange(self.triangles) // self.packet_triangles % self.nodes

    @cached_property
    def round(self) -> Int64:
        """int64 (triangles,): the round in which its node draws each."""
        if self.work is not None:
            return np.zeros(self.triangles, np.int64)
        return np.arange(self.triangles) // (self.packet_triangles * self.nodes)

    @cached_property
    def host_order(self) -> Int64:
        """int64 (triangles,): the triangles in the order in which the host sends them.

        Round by round, and within a round the first of each node's packet, the second of each, and
        so on: each node gets its own in the list's order, and triangles that follow one another
        go to different nodes, whatever the packet is.  Of equal work: in the order of the work that
        its node has before each, so that all nodes are as far at any time.
        """
        if self.work is not None:
            begins = np.searchsorted(self.node, np.arange(self.nodes + 1))
            before = np.append(self._work_before, self.work.sum())
            return np.lexsort((self.node, self._work_before - before[begins[self.node]]))
        position = np.arange(self.triangles) % self.packet_triangles
        return np.lexsort((self.node, position, self.round))

    @property
    def _work_before(self) -> Int64:
        """int64 (triangles,): the work of all triangles before each in the list."""
        assert self.work is not None
        return np.cumsum(self.work) - self.work

    @cached_property
    def host_place(self) -> Int64:
        """int64 (triangles,): how many triangles the host sends before each."""
        place = np.empty(self.triangles, np.int64)
        place[self.host_order] = np.arange(self.triangles)
        return place

    def of_node(self, node: int) -> Int64:
        """The triangles of one node, in the list's order."""
        return np.flatnonzero(self.node == node)


def triangle_work(display_list: DisplayList) -> Int64:
    """int64 (triangles,): about the clocks that a processing element needs for each: its rows or
    the pixels of its area, whichever are more; 0 where its box has no pixel on the screen.

    A whole number, of the highest resolution whatever the machine draws at, so that host, machine
    and models agree.  A row or a column counts if the centres of its pixels lie in the box.
    """
    unit = 1 << display_list.sub_bits
    position = display_list.position.astype(np.int64)
    size = np.array([display_list.width, display_list.height])
    first, end = (np.clip(-((unit // 2 - ends) // unit), 0, size)
                  for ends in (position.min(axis=1), position.max(axis=1)))
    columns, rows = (end - first).T
    (ax, ay), (bx, by) = ((position[:, corner] - position[:, 0]).T for corner in (1, 2))
    area = abs(ax * by - ay * bx) >> (2 * display_list.sub_bits + 1)
    return np.where(columns * rows > 0, np.maximum(rows, np.minimum(area, columns * rows)), 0)
