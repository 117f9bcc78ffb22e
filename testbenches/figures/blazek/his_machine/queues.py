"""When a node that takes messages one after another, as they come, has done what each asks for."""

from __future__ import annotations

import heapq
from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

Float64 = NDArray[np.float64]


def served(arrival: Float64, work: Float64) -> Float64:
    """When each of a node's messages, in the order in which they arrive, is done with: each begins
    as it is there and the one before it is done.

    done[k] = max(done[k-1], arrival[k]) + work[k], which is work up to k and the most that any
    message up to k came later than the work before it.
    """
    total = np.cumsum(work)
    return np.asarray(total + np.maximum.accumulate(arrival - (total - work)))


def forwarded(arrival: Float64, home: Sequence[int], visits: Sequence[Sequence[int]],
              tessellate: float, drawing: Sequence[Sequence[float]], message: float,
              nodes: int) -> tuple[list[float], list[float]]:
    """Nodes that pass objects on, event by event: when each is done, and how long it was at work.

    Object k comes from the host to node ``home[k]`` at ``arrival[k]``.  That tessellates it, sends
    its description to each other node of ``visits[k]``, which is a message each, and draws its own
    part; a node to which it is passed on tessellates it again.  ``drawing[k]`` goes along with
    ``visits[k]``.
    """
    events = [(time, number, home[number], True) for number, time in enumerate(arrival.tolist())]
    heapq.heapify(events)
    free, busy = [0.0] * nodes, [0.0] * nodes
    while events:
        time, number, node, first = heapq.heappop(events)
        begin = max(time, free[node])
        done = begin + tessellate
        own = 0.0
        for other, part in zip(visits[number], drawing[number], strict=True):
            if other == node:
                own = part
            elif first:
                done += message
                heapq.heappush(events, (done, number, other, False))
        free[node] = done + own
        busy[node] += free[node] - begin
    return free, busy
