"""Whether pixels have to carry an order, so that ties between nodes go to the right one."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from ..organisations.shares import Shares
from ..reference import exact
from ..specification.display_list import DisplayList
from ..specification.picture import NO_PRIMITIVE, Picture

Int64 = NDArray[np.int64]


def order_matters(display_list: DisplayList, shares: Shares,
                  draw: Callable[[DisplayList], Picture] = exact.draw) -> bool:
    """Whether the merged picture is wrong without an order: somewhere nodes tie in depth, and the
    winner is not of the lowest of them.

    Without an order the least (depth, node) wins, and in a node the first triangle: that is the
    picture of the list sorted by node.  ``draw`` is how the machine draws, at its resolution; it
    is asked twice at most.
    """
    if shares.rounds == 1:  # sorted already
        return False
    whole = draw(display_list).winner
    return not np.array_equal(whole, _winners(display_list, shares.node, draw))


def nodes_tie(display_list: DisplayList, shares: Shares,
              draw: Callable[[DisplayList], Picture] = exact.draw) -> bool:
    """Whether somewhere the nearest depth is that of two nodes, so that it matters whose fragment
    comes first: the winner is another one where the nodes draw in turn, and in turn backwards."""
    first, last = (_winners(display_list, node, draw) for node in (shares.node, -shares.node))
    return not np.array_equal(first, last)


def _winners(display_list: DisplayList, node: Int64,
             draw: Callable[[DisplayList], Picture]) -> Int64:
    """The triangle that is seen at each pixel, ties going to the one of the least ``node``, and of
    these to the first."""
    order = np.argsort(node, kind="stable")
    winner = draw(display_list.chosen(order)).winner
    return np.append(order, NO_PRIMITIVE)[winner]  # NO_PRIMITIVE is the last place
