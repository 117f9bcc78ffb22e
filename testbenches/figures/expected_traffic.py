"""The traffic that Cox and Hanrahan expect on a snooped bus, in pixels (1993, section 7.1).

A pixel on which d fragments fall is expected to be sent H(d) = 1 + 1/2 + … + 1/d times, if which of
them is nearer has nothing to do with which node has it.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray


def harmonic(depth: int) -> float:
    """H(depth); H(0) is 0."""
    return float((1 / np.arange(1, depth + 1)).sum())


def evenly(area: int, fragments: int) -> float:
    """Equation 4, the paper's bound: every pixel of ``area`` has the average depth, rounded down or
    up.  No other distribution of as many fragments has more traffic."""
    if not area:
        return 0.0
    whole, rest = divmod(fragments, area)
    return (area - rest) * harmonic(whole) + rest * harmonic(whole + 1)


def by_pixel(depths: ArrayLike) -> float:
    """Equation 3: each pixel with its own depth; ``depths`` of all of them."""
    counts = np.bincount(np.asarray(depths, np.int64))
    terms = np.append(0.0, 1 / np.arange(1, len(counts)))  # of depth 0, 1, …
    return float(counts @ np.cumsum(terms[:len(counts)]))


def by_pixel_among(depths: ArrayLike, nodes: int) -> float:
    """The same among few nodes, of which some have several fragments of a pixel; not in the paper.

    Each fragment is of one of ``nodes`` nodes, whichever the others are of.  The j-th nearest of a
    pixel is sent if its node, k, is lower than those of the j - 1 nearer ones:

        Σ over j = 1 … d of Σ over k = 0 … n-1 of  1/n · ((n - 1 - k)/n)^(j-1)

    With more and more nodes the inner sum becomes 1/j.
    """
    counts = np.bincount(np.asarray(depths, np.int64))
    deepest = len(counts) - 1
    if deepest < 1:
        return 0.0
    above: NDArray[np.float64] = np.arange(nodes) / nodes  # the part of nodes that are higher
    terms = [float((above**nearer).mean()) for nearer in range(deepest)]
    return float(counts @ np.cumsum([0.0, *terms]))
