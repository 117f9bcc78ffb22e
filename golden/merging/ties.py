"""Whether pixels have to carry an order, so that ties between nodes go to the right one."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from ..organisations.shares import Shares
from ..reference import exact
from ..specification.display_list import DisplayList
from ..specification.picture import NO_PRIMITIVE, Picture


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
    by_node = np.argsort(shares.node, kind="stable")
    whole, without = draw(display_list).winner, draw(display_list.chosen(by_node)).winner
    seen = whole != NO_PRIMITIVE
    return not np.array_equal(whole[seen], by_node[without[seen]])
