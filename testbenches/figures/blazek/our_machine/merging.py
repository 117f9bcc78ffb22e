"""What a tree of nodes merges: the pixels that each has drawn, painted for all spheres at once."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np
from numpy.typing import NDArray

from .....golden.cycles.merge_clocks import merge_clocks
from .....golden.merging.tree import TreeSend, tree_pairs
from .....golden.reference.exact import fragments
from .....golden.specification.configuration import MachineConfiguration
from ..scenes.spheres import Size, sphere_places
from .our_scene import TRIANGLES, our_objects

Bool = NDArray[np.bool_]
Int64 = NDArray[np.int64]

#: Spheres painted together.
CHUNK = 64


def merging_clocks(configuration: MachineConfiguration, size: Size, seed: int,
                   spheres: Sequence[int], node_of: Int64) -> list[int]:
    """Of so many spheres, ascending: until node 0 has the picture, where nodes merge in a tree.

    ``node_of``  int64 (triangles,): who draws each triangle of the most spheres
    """
    return [sum(merge_clocks(configuration, tree_sends_of(drawn)))
            for drawn in drawn_by(configuration.nodes, size, seed, spheres, node_of)]


def drawn_by(nodes: int, size: Size, seed: int, spheres: Sequence[int],
             node_of: Int64) -> Iterator[Bool]:
    """bool (nodes, height, width), for each number of spheres: where each node has drawn."""
    places = sphere_places(size, seed, spheres[-1])
    triangle, x, y = _template(size)
    width, height = size
    drawn = np.zeros((nodes, height * width), bool)
    done = 0
    for count in spheres:
        for first in range(done, count, CHUNK):
            number = np.arange(first, min(first + CHUNK, count))[:, np.newaxis]
            pixel = ((places[number, 1] + y) * width + places[number, 0] + x)
            drawn[node_of[number * TRIANGLES + triangle], pixel] = True
        done = count
        yield drawn.reshape(nodes, height, width)


def tree_sends_of(drawn: Bool) -> Iterator[TreeSend]:
    """All sends; what of them is stored does not matter where units have two ports."""
    kept = list(drawn)
    for step, sender, receiver in tree_pairs(len(kept)):
        yield TreeSend(step, sender, receiver, kept[sender], kept[sender])
        kept[receiver] = kept[receiver] | kept[sender]


def _template(size: Size) -> tuple[Int64, Int64, Int64]:
    """Of one sphere about 0, 0: triangle, x and y of each fragment."""
    found = fragments(our_objects(size, 0, 1).display_list())
    [(left, top)] = sphere_places(size, 0, 1).tolist()
    return (found.primitive.astype(np.int64), found.x.astype(np.int64) - left,
            found.y.astype(np.int64) - top)
