"""What one node keeps, and the minimum that merges two of them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import reduce
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..organisations.shares import Shares
from ..reference.exact import draw
from ..specification.display_list import DisplayList, Shading, shading_for
from ..specification.picture import NO_PRIMITIVE, Picture

Int64 = NDArray[np.int64]


@dataclass(frozen=True, eq=False)
class NodePicture:
    """The words of a node's memory, each where its pixel is.

    ``picture``  colour, depth and winner; the winner, a number in the whole display list, is for
                 whoever wants to know why, and decides nothing
    ``order``    int64 (height, width): the round of the winner; the greatest that its bits hold
                 where nothing was drawn
    """

    picture: Picture
    order: Int64

    @property
    def drawn(self) -> NDArray[np.bool_]:
        """bool (height, width): where the node, or one that was merged into it, drew."""
        return np.asarray(self.picture.winner != NO_PRIMITIVE)


def higher_is_nearer(lower: NodePicture, higher: NodePicture) -> NDArray[np.bool_]:
    """bool (height, width): where the less (depth, order) is that of ``higher``."""
    one, other = lower.picture, higher.picture
    return np.asarray((other.depth < one.depth)
                      | ((other.depth == one.depth) & (higher.order < lower.order)))


def nearer(lower: NodePicture, higher: NodePicture) -> NodePicture:
    """Two nodes' pictures as one: in every pixel the less (depth, order), and where these are
    equal that of ``lower``, the nodes with the lower numbers.

    A word that was not drawn has the greatest of both, so it is the identity.  The minimum is
    associative: any order of merging neighbours gives the same words.
    """
    one, other = lower.picture, higher.picture
    takes = higher_is_nearer(lower, higher)

    def chosen(mine: NDArray[Any], others: NDArray[Any]) -> NDArray[Any]:
        mask = takes if mine.ndim == takes.ndim else takes[..., None]
        return np.where(mask, others, mine)

    return NodePicture(
        Picture(color=chosen(one.color, other.color), depth=chosen(one.depth, other.depth),
                winner=chosen(one.winner, other.winner)),
        chosen(lower.order, higher.order))


def merged(pictures: Sequence[NodePicture]) -> NodePicture:
    """The pictures of all nodes, in the order of their numbers, as one."""
    return reduce(nearer, pictures)


def node_pictures(display_list: DisplayList, shares: Shares, *, order_bits: int | None = None,
                  shading: Shading | None = None, x_shift: int = 0, y_shift: int = 0,
                  ) -> list[NodePicture]:
    """What each node draws of a display list.

    ``order_bits``  of the order that a pixel carries, by default as many as number the rounds;
                    0 carries none, which is right where no two nodes tie
    """
    greatest = (1 << (shares.order_bits if order_bits is None else order_bits)) - 1
    shading = shading_for(display_list, shading)
    pictures = []
    for node in range(shares.nodes):
        own = shares.of_node(node)
        drawn = draw(display_list.chosen(own), shading=shading, x_shift=x_shift, y_shift=y_shift)
        seen = drawn.winner != NO_PRIMITIVE
        primitive = own[drawn.winner[seen]]
        winner = drawn.winner.copy()
        winner[seen] = primitive
        order = np.full(winner.shape, greatest, np.int64)
        order[seen] &= shares.round[primitive]
        pictures.append(NodePicture(replace(drawn, winner=winner), order))
    return pictures
