"""Which node makes which object, and so draws which triangle."""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from ..specification.configuration import Packet
from ..specification.display_list import DisplayList
from ..specification.errors import InputError
from .shares import Shares, triangle_work

Int64 = NDArray[np.int64]

ONLY_OBJECTS = ("objects: only a scene file without perspective has them, meshes that are moved; "
                "take such a .scene (no display list keeps them), or leave objects out")


@dataclass(frozen=True)
class ObjectShares(Shares):
    """Objects dealt out to nodes, a packet of them at a time; an object's triangles all go with it.

    ``object_triangles``  int64 (objects,): of each, in the list's order
    ``packet``            counts objects, but is otherwise as of ``Shares``; so are ``node``,
                          ``round`` and ``host_order``, of every triangle

    >>> shares = ObjectShares(nodes=2, triangles=7, object_triangles=np.array([2, 1, 0, 3, 1]))
    >>> shares.node.tolist(), shares.round.tolist()
    ([0, 0, 1, 1, 1, 1, 0], [0, 0, 0, 1, 1, 1, 2])
    """

    object_triangles: Int64 = field(default_factory=lambda: np.zeros(0, np.int64), compare=False)

    @classmethod
    def of(cls, display_list: DisplayList, nodes: int, packet: Packet) -> ObjectShares:
        """Of a display list that is made of objects; ``InputError`` for any other."""
        counts = display_list.object_triangles
        if counts is None:
            raise InputError(ONLY_OBJECTS)
        work = triangle_work(display_list) if packet == "work" else None
        return cls(nodes, display_list.triangles, packet, work, counts)

    @cached_property
    def object(self) -> Int64:
        """int64 (triangles,): the object of each."""
        return np.repeat(np.arange(len(self.object_triangles)), self.object_triangles)

    @cached_property
    def objects(self) -> Shares:
        """How the objects themselves are dealt out."""
        count = len(self.object_triangles)
        work = None
        if self.work is not None:
            work = np.bincount(self.object, self.work, count).astype(np.int64)
        return Shares(self.nodes, count, self.packet, work)

    @property
    def items(self) -> int:
        """Objects."""
        return len(self.object_triangles)

    @property
    def packet_triangles(self) -> int:
        raise NotImplementedError("objects have any number of triangles")

    @property
    def rounds(self) -> int:
        return self.objects.rounds

    @cached_property
    def node(self) -> Int64:
        return self.objects.node[self.object]

    @cached_property
    def round(self) -> Int64:
        return self.objects.round[self.object]

    @cached_property
    def host_order(self) -> Int64:
        """As ``Shares.host_order`` has objects; an object's triangles follow one another."""
        return np.argsort(self.objects.host_place[self.object], kind="stable")
