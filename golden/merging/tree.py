"""Merging pair by pair after drawing (Blazek 1991, chapter V, algorithm 4, figure 10)."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np

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


def merge_tree(pictures: Sequence[NodePicture]) -> tuple[NodePicture, Traffic]:
    """The merged picture, which node 0 ends up with, and the sends: what the sender, and those that
    were merged into it, have drawn, and nothing else."""
    kept = list(pictures)
    sends = []
    for step, sender, receiver in tree_pairs(len(pictures)):
        sends.append(Send(
            step, sender, receiver, int(np.count_nonzero(kept[sender].drawn)),
            int(np.count_nonzero(higher_is_nearer(kept[receiver], kept[sender])))))
        kept[receiver] = nearer(kept[receiver], kept[sender])
    return kept[0], Traffic(len(pictures), sends)
