"""Merging pair by pair after drawing (Blazek 1991, chapter V, algorithm 4, figure 10)."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from .node_picture import NodePicture, higher_is_nearer, nearer
from .traffic import Send, Traffic


def tree_pairs(nodes: int) -> Iterator[tuple[int, int, int]]:
    """(step, sender, receiver) of every send: in step s node k, a multiple of 2**(s + 1), receives
    from node k + 2**s, where there is one.

    >>> list(tree_pairs(5))
    [(0, 1, 0), (0, 3, 2), (1, 2, 0), (2, 4, 0)]
    """
    for step in range((nodes - 1).bit_length()):
        for receiver in range(0, nodes - (1 << step), 2 << step):
            yield step, receiver + (1 << step), receiver


class TreeSend(NamedTuple):
    """What one node sends to another in a step, pixel by pixel.

    ``sent``    bool (height, width): what the sender, and those merged into it, have drawn
    ``stored``  bool (height, width): what of it the receiver stores
    """

    step: int
    sender: int
    receiver: int
    sent: NDArray[np.bool_]
    stored: NDArray[np.bool_]


def tree_sends(kept: list[NodePicture]) -> Iterator[TreeSend]:
    """All sends, step by step; ``kept``, the pictures of the nodes, are merged on the way, in the
    end all into the first one."""
    for step, sender, receiver in tree_pairs(len(kept)):
        lower, higher = kept[receiver], kept[sender]
        yield TreeSend(step, sender, receiver, higher.drawn, higher_is_nearer(lower, higher))
        kept[receiver] = nearer(lower, higher)


def merge_tree(pictures: Sequence[NodePicture]) -> tuple[NodePicture, Traffic]:
    """The merged picture, which node 0 ends up with, and the sends: what the sender, and those that
    were merged into it, have drawn, and nothing else."""
    kept = list(pictures)
    sends = [Send(step, sender, receiver, int(np.count_nonzero(sent)))
             for step, sender, receiver, sent, _ in tree_sends(kept)]
    return kept[0], Traffic(len(pictures), sends)
