"""Which node draws which triangle: a contract between host, machine and golden models."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from ..specification.configuration import Packet
from ..specification.errors import InputError

Int64 = NDArray[np.int64]


@dataclass(frozen=True)
class Shares:
    """The triangles of a display list dealt out to nodes, a packet at a time.

    ``nodes``      how many there are
    ``triangles``  of the whole display list, before set-up leaves anything out: what that leaves
                   out depends on the resolution, and a share must not
    ``packet``     triangles that follow one another in the list and go to one node; 1 is round
                   robin, ``"contiguous"`` gives each node one run of the list

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

    def __post_init__(self) -> None:
        if self.nodes < 1:
            raise InputError(f"nodes: {self.nodes} is less than 1")
        if self.packet != "contiguous" and self.packet < 1:
            raise InputError(f"packet: {self.packet} is less than 1; take how many triangles "
                             "follow one another to a node, or contiguous")

    @property
    def packet_triangles(self) -> int:
        """Triangles in a packet, as a number."""
        if self.packet == "contiguous":
            return max(1, -(-self.triangles // self.nodes))
        return self.packet

    @property
    def rounds(self) -> int:
        """How often every node has its turn; 1 at least."""
        return max(1, -(-self.triangles // (self.packet_triangles * self.nodes)))

    @property
    def order_bits(self) -> int:
        """Bits that number the rounds; none where there is only one."""
        return (self.rounds - 1).bit_length()

    @cached_property
    def node(self) -> Int64:
        """int64 (triangles,): the node that draws each."""
        return np.arange(self.triangles) // self.packet_triangles % self.nodes

    @cached_property
    def round(self) -> Int64:
        """int64 (triangles,): the round in which its node draws each."""
        return np.arange(self.triangles) // (self.packet_triangles * self.nodes)

    @cached_property
    def host_order(self) -> Int64:
        """int64 (triangles,): the triangles in the order in which the host sends them.

        Round by round, and within a round the first of each node's packet, the second of each, and
        so on: each node gets its own in the list's order, and triangles that follow one another
        go to different nodes, whatever the packet is.
        """
        position = np.arange(self.triangles) % self.packet_triangles
        return np.lexsort((self.node, position, self.round))

    @cached_property
    def host_place(self) -> Int64:
        """int64 (triangles,): how many triangles the host sends before each."""
        place = np.empty(self.triangles, np.int64)
        place[self.host_order] = np.arange(self.triangles)
        return place

    def of_node(self, node: int) -> Int64:
        """The triangles of one node, in the list's order."""
        return np.flatnonzero(self.node == node)
