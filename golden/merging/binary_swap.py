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
    it is.  Parts are runs of pixels, row by row.
    """
    kept, sends = _fold([_each(picture, _flat) for picture in pictures])
    step = len(sends) and 1
    parts = [slice(0, pictures[0].order.size)] * len(kept)
    for distance in (1 << bit for bit in range(len(kept).bit_length() - 1)):
        swapped = []
        for place, (node, own) in enumerate(kept):
            partner, others = kept[place ^ distance]
            lower = place & distance == 0
            part = _half(parts[place], first=lower)
            mine, sent = _part(own, parts[place], part), _part(others, parts[place], part)
            sends.append(Send(step, partner, node, int(np.count_nonzero(sent.drawn))))
            swapped.append((node, nearer(mine, sent) if lower else nearer(sent, mine)))
        parts = [_half(part, first=place & distance == 0) for place, part in enumerate(parts)]
        kept = swapped
        step += 1
    in_order = sorted(zip(parts, kept, strict=True), key=lambda item: item[0].start)
    whole = _joined([picture for _, (_, picture) in in_order])
    height, width = pictures[0].order.shape
    return (_each(whole, lambda array: array.reshape(height, width, *array.shape[1:])),
            Traffic.of(len(pictures), sends))


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


def _half(part: slice, *, first: bool) -> slice:
    middle = (part.start + part.stop) // 2
    return slice(part.start, middle) if first else slice(middle, part.stop)


def _part(picture: NodePicture, has: slice, wanted: slice) -> NodePicture:
    """The pixels ``wanted`` of a picture that has the pixels ``has``."""
    return _each(picture, lambda array: array[wanted.start - has.start:wanted.stop - has.start])


def _joined(parts: list[NodePicture]) -> NodePicture:
    pictures = [part.picture for part in parts]
    return NodePicture(
        Picture(np.concatenate([picture.color for picture in pictures]),
                np.concatenate([picture.depth for picture in pictures]),
                np.concatenate([picture.winner for picture in pictures])),
        np.concatenate([part.order for part in parts]))
