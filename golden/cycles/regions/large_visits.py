"""When a processing element finds the regions that a triangle of a large box visits.

Band after band, two rows or four are probed, then all columns of regions that the triangle may
reach there are looked at, a column a clock, whosever they are; both go on while regions found
before are walked, as far as these are taken.  A region that is found waits until it is known
whether another one follows.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

from ..element_latencies import NEVER

#: From a row's probe until its extent is there.
PROBE_LATENCY = 5


@dataclass(frozen=True)
class Band:
    """What of a large box lies in one row of regions.

    ``probes``   rows that are probed; 0 where the band is passed over, which takes a clock
    ``columns``  of regions that are looked at
    ``own``      which of these, from the left, are visits
    """

    probes: int
    columns: int
    own: Sequence[int]


def find_visits(begin: float, bands: Sequence[Band], walk: Callable[[float], float]) -> None:
    """The visits of a triangle that is the next one at ``begin``.

    ``walk`` is called once for each of them, in order, with the clock in which it is known, and
    gives the one in which it is taken; where there are none, once for the triangle's end.
    """
    probed = begin  # the last probe so far
    extent = NEVER  # the last extent taken
    scanned = NEVER  # the last column looked at
    cleared = NEVER  # what was found there has been taken
    waits = False
    for band in bands:
        probed += max(band.probes, 1)
        if not band.probes:
            continue
        extent = max(probed + PROBE_LATENCY, extent + band.probes, scanned)
        if not band.columns:
            continue
        column, following = 0, max(extent + 1, cleared)
        for place in band.own:
            scanned = following + place - column
            cleared = walk(scanned + 1) if waits else scanned + 1
            waits = True
            column, following = place + 1, max(scanned + 1, cleared)
        if column < band.columns:
            scanned = following + band.columns - column - 1
    walk(max(probed + 1, extent + 1, scanned + 2, cleared + 1))
