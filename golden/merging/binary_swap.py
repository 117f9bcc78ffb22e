"""Merging by halves, as software does it on computers in a network: a model, to compare with.

Ma, Painter, Hansen and Krogh 1994: in each step two nodes split the part of the screen that both
have, each sends the half that it gives away, and in the end every node has a part of the picture.
No machine of this project does it: its nodes would need sends both ways over the same pieces of
the backplane.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..specification.picture import Picture
from .node_picture import NodePicture, nearer
from .traffic import Send, Traffic


def merge_binary_swap(pictures: Sequence[NodePicture]) -> tuple[NodePicture, Traffic]:
    """The merged picture, put together from its parts, and the sends of what was drawn.

    Where the number of nodes is no power of two, pairs of neighbours merge first, in step 0, until
    it is.  A part is halved into its even and its odd pixels, so that both halves have as much to
    do whatever was drawn where.
    """
    kept, sends = _fold([_each(picture, _flat) for picture in pictures])
    step = 1 if sends else 0
    parts = [slice(0, None, 1)] * len(kept)
    for distance in (1 << bit for bit in range(len(kept).bit_length() - 1)):
        swapped = []
        for place, (node, own) in enumerate(kept):
            partner, others = kept[place ^ distance]
            lower = place & distance == 0
            first = slice(0 if lower else 1, None, 2)
            mine, sent = _part(own, first), _part(others, first)
            sends.append(Send(step, partner, node, int(np.count_nonzero(sent.drawn))))
            swapped.append((node, nearer(mine, sent) if lower else nearer(sent, mine)))
            has = parts[place]
            parts[place] = slice(has.start + first.start * has.step, None, 2 * has.step)
        kept = swapped
        step += 1
    height, width = pictures[0].order.shape
    whole = _joined(parts, [picture for _, picture in kept])
    return (_each(whole, lambda array: array.reshape(height, width, *array.shape[1:])),
            Traffic(len(pictures), sends))


def _fold(pictures: list[NodePicture]) -> tuple[list[tuple[int, NodePicture]], list[Send]]:
    """A power of two of pictures, each with the number of the node that has it, and the sends that
    made it so: each picture is of nodes that follow one another, so ties are as ever."""
    numbered = list(enumerate(pictures))
    extra = len(pictures) - (1 << (len(pictures).bit_length() - 1))
    folded, sends = [], []
    for pair in range(extra):
        (receiver, own), (sender, others) = numbered[2 * pair:2 * pair + 2]
        sends.append(Send(0, sender, receiver, int(np.count_nonzero(others.drawn))))
        folded.append((receiver, nearer(own, others)))
    return folded + numbered[2 * extra:], sends


def _each(picture: NodePicture, change: Callable[[NDArray[Any]], NDArray[Any]]) -> NodePicture:
    """A picture with the same done to every array of it."""
    inner = picture.picture
    return NodePicture(Picture(change(inner.color), change(inner.depth), change(inner.winner)),
                       change(picture.order))


def _flat(array: NDArray[Any]) -> NDArray[Any]:
    """Pixels one after another, row by row."""
    return array.reshape(-1, *array.shape[2:])


def _part(picture: NodePicture, part: slice) -> NodePicture:
    return _each(picture, lambda array: array[part])


def _joined(parts: list[slice], pictures: list[NodePicture]) -> NodePicture:
    """One picture, of which each of ``pictures`` has a part."""
    size = sum(picture.order.size for picture in pictures)
    whole = _each(pictures[0], lambda array: np.empty((size, *array.shape[1:]), array.dtype))
    for part, picture in zip(parts, pictures, strict=True):
        inner, of = whole.picture, picture.picture
        inner.color[part], inner.depth[part], inner.winner[part] = of.color, of.depth, of.winner
        whole.order[part] = picture.order
    return whole
