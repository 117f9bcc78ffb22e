"""Objects, of which the machine itself makes triangles: what is checked of a configuration that
takes them, and what follows."""

from __future__ import annotations

from typing import Any, Literal, get_args

from ..card_order import NODE_ENDS
from ..errors import InputError
from ..ranges import MAXIMUM_WORDS, check_whole
from ..regions import Balance, Balancer
from ..widths import Widths

#: Where meshes are kept and the triangles of objects are made (Blazek 1991, chapter V): in each
#: node, which makes those of its share; once, at the controller, for all processing elements; or in
#: each processing element, which passes objects on to its neighbours.
Objects = Literal["controller", "nodes", "elements"]

MAXIMUM_MESHES = 1 << 12

#: The fields of a machine that takes triangles only.
NO_OBJECTS: dict[str, Any] = {"objects": None, "mesh_triangles": 0, "meshes": 0}


class MakingFields(Widths):
    """The fields ``objects``, ``mesh_triangles`` and ``meshes``."""

    setup: Literal["host", "hardware"]
    list_words: int
    balance: Balance
    balancer: Balancer
    objects: Objects | None
    mesh_triangles: int
    meshes: int

    @property
    def controller_sets_up(self) -> bool:
        """Vertices that the host sends, and no objects, are made prepared triangles in the
        controller, before they are broadcast."""
        return self.setup == "hardware" and self.objects is None

    @property
    def reports_full(self) -> bool:
        """Boards say when a list or a mesh finds no room."""
        return bool(self.list_words) or self.objects in ("nodes", "elements")

    @property
    def mesh_bits(self) -> int:
        """Bits of the number of a mesh, or of one more than there can be."""
        return self.meshes.bit_length()

    @property
    def forwards_objects(self) -> bool:
        """Processing elements pass objects on to their neighbours."""
        return self.objects == "elements"

    @property
    def takes_tables(self) -> bool:
        """The host says which regions of the screen are whose."""
        return (self.regions is not None and self.balancer == "host"
                and not self.forwards_objects)

    @property
    def keeps_list_order(self) -> bool:
        """Objects come to a processing element in any order, so that pixels of one node keep the
        number of their object beside the depth: their order."""
        return self.forwards_objects

    def _check_objects(self) -> None:
        """``InputError`` where objects cannot be made so, or what is for objects is asked of a
        machine that takes none."""
        if self.objects is None:
            for name in ("mesh_triangles", "meshes"):
                if getattr(self, name) != 0:
                    raise InputError(f"{name}: is for machines that make triangles of objects; "
                                     "give objects as well, or leave it out")
            return
        if self.objects not in get_args(Objects):
            raise InputError(f"objects: {self.objects!r} is none of {', '.join(get_args(Objects))}")
        check_whole("mesh_triangles", self.mesh_triangles, 1, MAXIMUM_WORDS)
        check_whole("meshes", self.meshes, 1, MAXIMUM_MESHES)
        if self.setup != "hardware":
            raise InputError("setup: the host prepares no triangle of an object; take set-up in "
                             "hardware, or leave objects out")
        if self.list_words:
            raise InputError("list_words: a machine that makes triangles of objects retains none; "
                             "leave one of the two out")
        self._check_place()

    def _check_place(self) -> None:
        if self.objects == "nodes":
            if self.merge not in NODE_ENDS:
                raise InputError(f"objects: {self.cards} has no nodes that keep meshes; end them "
                                 f"with {', '.join(NODE_ENDS[:-1])} or {NODE_ENDS[-1]}, as in "
                                 "2x(PMMC), or make triangles at the controller")
        elif self.merge is not None:
            raise InputError(f"objects: {self.cards} has nodes, which make triangles of their own "
                             "objects; take nodes, or a cage of one node, such as 4x(PMM)")
        elif self.objects == "elements":
            self._check_forwarding()

    def _check_forwarding(self) -> None:
        if self.regions is None:
            raise InputError("objects: processing elements pass objects on to whom regions of the "
                             "screen are dealt; give regions as well, or make triangles at the "
                             "controller")
        if self.balance != "static":
            raise InputError(f"balance: {self.balance} deals regions out anew, and processing "
                             "elements that pass objects on keep theirs; take static")
