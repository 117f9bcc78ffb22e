"""Our forms of the four methods: which machine, and how long it draws, by the cycle model."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

from .....golden.cycles.cycle_model import predict_cycles
from .....golden.objects.making import link_words, triangle_link_words
from .....golden.organisations.shares import Shares
from .....golden.specification.card_order import TREE_MERGE
from .....golden.specification.configuration import MachineConfiguration
from ....frames.setup_timing import setup_timing
from ..scenes.screen_parts import Parts, screen_grid_of
from ..scenes.spheres import Size
from .our_scene import TRIANGLES, our_objects

Int64 = NDArray[np.int64]

#: A memory unit takes a fragment a clock; two are the usual board set.
NODE_CARDS = "PMM"

#: Up to so many spheres each triangle is followed; each sphere beyond takes what those of the
#: second half of these take on average.
FOLLOWED = 256


Kind = Literal["host", "nodes", "forwarding", "broadcast"]

#: Who makes triangles of objects, where there are several.
_MAKERS = {"nodes": "nodes", "forwarding": "elements", "broadcast": "controller"}


@dataclass(frozen=True)
class Decomposition:
    """``packet`` of triangles, or of objects, where nodes keep a picture each; ``parts`` of the
    screen where elements share one."""

    kind: Kind
    packet: int = 0
    parts: Parts | None = None

    @property
    def name(self) -> str:
        return {"host": f"host initiated, {self.packet}", "nodes": "node initiated",
                "forwarding": f"forwarding, {self.parts}",
                "broadcast": f"broadcast, {self.parts}"}[self.kind]

    @property
    def merges(self) -> bool:
        """By a tree, after drawing."""
        return self.parts is None

    def cards(self, nodes: int) -> str:
        merge = TREE_MERGE if self.merges and nodes > 1 else ""
        return f"{nodes}x({NODE_CARDS}{merge})"

    def fields(self, size: Size, nodes: int) -> dict[str, Any]:
        """Of the machine's configuration, besides the cards."""
        fields: dict[str, Any] = {"memory_ports": 2, "clocks_per_pixel": 2, "setup": "hardware"}
        if self.kind != "host":
            fields |= {"objects": _MAKERS[self.kind] if nodes > 1 else "controller", "meshes": 1,
                       "mesh_triangles": TRIANGLES}
        if nodes == 1:
            return fields
        if self.merges:
            fields["packet"] = self.packet
        elif self.parts == "lines":
            fields["lines"] = True
        elif self.parts is not None:
            grid = screen_grid_of(size, nodes, self.parts)
            fields |= {"regions": (grid.columns, grid.count // grid.columns), "balance": "static"}
        return fields

    def configuration(self, size: Size, nodes: int) -> MachineConfiguration:
        """Such a machine, for every triangle."""
        return MachineConfiguration(self.cards(nodes), *size, **self.fields(size, nodes))


HOST_PACKETS = (10, 100, 1000)

DECOMPOSITIONS = {each.name: each for each in (
    *(Decomposition("host", packet) for packet in HOST_PACKETS), Decomposition("nodes", 1),
    *(Decomposition("forwarding", parts=parts) for parts in ("strips", "grid")),
    *(Decomposition("broadcast", parts=parts) for parts in ("lines", "strips", "grid")))}


def drawing_clocks(decomposition: Decomposition, size: Size, seed: int, nodes: int,
                   spheres: Sequence[int]) -> list[float]:
    """From the first command to the last fragment, for each number of spheres, ascending."""
    machine = decomposition.configuration(size, nodes)
    asked = {count for count in spheres if count <= FOLLOWED}
    if spheres[-1] > FOLLOWED:
        asked |= {FOLLOWED // 2, FOLLOWED}
    clocks = _each if decomposition.kind == "host" else _nested
    found = dict(zip(sorted(asked), clocks(machine, size, seed, sorted(asked)), strict=True))
    return [found[count] if count in found else _beyond(found, count) for count in spheres]


def _beyond(found: dict[int, float], spheres: int) -> float:
    """Of more spheres than are followed."""
    each = (found[FOLLOWED] - found[FOLLOWED // 2]) / (FOLLOWED - FOLLOWED // 2)
    return found[FOLLOWED] + (spheres - FOLLOWED) * each


def _each(machine: MachineConfiguration, size: Size, seed: int,
          spheres: Sequence[int]) -> list[float]:
    """The order in which the host sends triangles to nodes depends on how many there are."""
    return [predict_cycles(machine, our_objects(size, seed, count).display_list(),
                           setup=setup_timing(machine)).cycles for count in spheres]


def _nested(machine: MachineConfiguration, size: Size, seed: int,
            spheres: Sequence[int]) -> list[float]:
    """Fewer spheres are the first of more, sent in the same order.  What is finished is told of
    each triangle, or of each object."""
    listed = our_objects(size, seed, spheres[-1]).display_list()
    finished = predict_cycles(machine, listed, setup=setup_timing(machine)).finished
    sent = len(finished) * np.array(spheres) // spheres[-1]  # all spheres have as many that are
    return [float(clocks) for clocks in finished[sent - 1]]


def words_on_link(decomposition: Decomposition, size: Size, seed: int, nodes: int,
                  spheres: Sequence[int]) -> list[int]:
    """32-bit words from the host for a frame, the mesh loaded anew; of each number of spheres."""
    machine = decomposition.configuration(size, nodes)

    def words(count: int) -> int:
        listed = our_objects(size, seed, count).display_list()
        return (triangle_link_words(machine, listed) if machine.objects is None else
                link_words(machine, listed).total)

    one, two = map(words, (1, 2))
    return [one + (count - 1) * (two - one) for count in spheres]  # none is clipped


def node_of_triangles(decomposition: Decomposition, nodes: int, spheres: int) -> Int64:
    """int64 (triangles,): packets of triangles or of objects, dealt out in turn."""
    packet = decomposition.packet * (TRIANGLES if decomposition.kind == "nodes" else 1)
    return Shares(nodes, spheres * TRIANGLES, packet).node
