"""Merging on a bus: nodes send in turn what no node before them has hidden (Cox and Hanrahan 1993,
section 7)."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from .node_picture import NodePicture, higher_is_nearer, nearer
from .traffic import Send, Traffic


def merge_snoop(pictures: Sequence[NodePicture]) -> tuple[NodePicture, Traffic]:
    """The merged picture, and what each node sends to the frame units, in ascending order.

    A node deletes its pixel as soon as it hears one that is as near or nearer.  What is sent is
    thus nearer than everything before it, and takes its place without being compared.
    """
    heard, sends = pictures[0], []
    for node, own in enumerate(pictures):
        sent = own.drawn if node == 0 else higher_is_nearer(heard, own)
        sends.append(Send(node, node, None, int(np.count_nonzero(sent))))
        heard = nearer(heard, own)
    return heard, Traffic(len(pictures), sends)
