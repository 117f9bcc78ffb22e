"""Clocks in which a node of one-port units takes the pixels that it receives in a tree's merge.

Pixels come one a clock at most, from two units in turn while both have any, then what is left of
one of them, then from the next two (``NodeSender``).  Units of the same numbers receive them: each
pixel is read, and where it is nearer written, in the lane of its unit (``one_port_lanes``).  What
comes waits before the lanes, and holds up what follows where more would wait than there is room
for.  The sender's own reads bound nothing, since no scan reads there.

Two things bound how fast the lanes work:

* the port of each: an access a clock, less the scan's slots;
* the memory bus, where both lanes are of one processing element: a read a clock, but for those that
  are lost to the scan (``lost_reads``).  The lane before which more waits has it first.

Runs of a few pixels are followed one after another.  Which line the scan shows decides what its
slots are: a line may be read of one of the two units alone.  So a merge that is short beside a scan
depends on when it begins.  Where that is known, this is within 2 % of the machine with four clocks
a pixel (``tests/machine/nodes/test_one_port_merges.py``), and within 4 % with two.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..merging.tree import TreeSend
from ..organisations.organisation_of import organisation_of
from ..specification.configuration import MachineConfiguration
from ..specification.queues import FRAGMENTS_WAITING
from .one_port.scan_reads import lane_of, shown_scan_shares

Float64 = NDArray[np.float64]
Int64 = NDArray[np.int64]

#: Pixels, accesses that a pixel takes about then, accesses in each of the two lanes.
Run = tuple[int, float, list[float]]

#: Pixels that are followed together.
RUN = 8

#: Of the fragments that can wait before a lane, two are on their way through the queue.
ROOM = FRAGMENTS_WAITING - 2

#: From a pixel before a lane until it may be read (``OnePortDepthTest.waiting``).
LANE_CLOCKS = 2


def sending_order(unit: Int64, word: Int64) -> Int64:
    """The order in which a node sends pixels that lie at these words of these units."""
    order = np.lexsort((word, unit))
    ordered = unit[order]
    place = np.arange(len(unit)) - np.searchsorted(ordered, ordered)  # in its unit
    return np.asarray(order[np.lexsort((ordered & 1, place, ordered >> 1))])


def received_clocks(configuration: MachineConfiguration, send: TreeSend, begin: float) -> float:
    """From the first pixel received until all are stored, where that one comes ``begin`` clocks
    after a scan began to show its first line.  Some pixel is sent."""
    organisation = organisation_of(configuration)
    y, x = np.nonzero(send.sent)
    unit = organisation.unit(x, y)
    order = sending_order(unit, organisation.word(x, y))
    unit, stored = unit[order], send.stored[y, x][order]
    now = done = begin
    lanes: PairOfLanes | None = None
    for first in np.unique(unit & ~1).tolist():
        pair = PairOfLanes(configuration, send.receiver, first)
        if lanes is None or lanes.names != pair.names:
            lanes = pair
        here = unit & ~1 == first
        for count, each, accesses in _runs(unit[here] & 1, stored[here]):
            now = lanes.take(now, count, each, accesses)
        done = max(done, lanes.drained(now))
    return LANE_CLOCKS + done - begin


def _runs(lane: Int64, stored: NDArray[np.bool_]) -> Iterator[Run]:
    place = np.arange(len(lane)) // RUN
    runs = int(place[-1]) + 1
    accesses = np.bincount(2 * place + lane, 1 + stored, 2 * runs).reshape(-1, 2)
    count = np.bincount(place)
    # What waits came with this run and those before; those beside it are much like it.
    each = _with_neighbours(accesses.sum(axis=1)) / _with_neighbours(count)
    return zip(count.tolist(), each.tolist(), accesses.astype(float).tolist(), strict=True)


def _with_neighbours(values: NDArray[Any]) -> NDArray[Any]:
    beside = np.pad(values, 1)
    return np.asarray(beside[:-2] + values + beside[2:])


class PairOfLanes:
    """The lanes of the units ``first`` and ``first + 1`` of a node, which receive pixels in turn; a
    lone unit has no other.

    ``names``    element and lane of each; the next two units may have the same ones
    ``waiting``  accesses to be made in each
    """

    def __init__(self, configuration: MachineConfiguration, node: int, first: int) -> None:
        organisation, timing = organisation_of(configuration), configuration.timing
        units = np.arange(first, min(first + 2, organisation.units))
        element, lane = organisation.owners[node, units], lane_of(configuration, units)
        self.names = list(zip(element.tolist(), lane.tolist(), strict=True))
        self.waiting = [0.0, 0.0]
        self._one_bus = len(set(element.tolist())) < len(units)
        # Of the lines of a scan, from the first one that is shown on.
        shown = shown_scan_shares(organisation)[:, element, lane]
        row = np.arange(timing.vertical_active) >> organisation.resolution.y_shift
        shares = np.zeros((timing.vertical_total, 2))
        shares[:len(row), :len(units)] = shown[row % len(shown)]
        self._shares: list[list[float]] = shares.tolist()
        self._line = timing.horizontal_total * configuration.clocks_per_pixel
        self._shown = timing.horizontal_active * configuration.clocks_per_pixel

    def _shares_at(self, clock: float) -> Sequence[float]:
        """Of each lane's time, what the scan takes then."""
        line, place = divmod(clock, self._line)
        return self._shares[int(line) % len(self._shares)] if place < self._shown else (0.0, 0.0)

    def take(self, now: float, count: int, each: float, accesses: Sequence[float]) -> float:
        """From ``now`` on there come ``count`` pixels, for so many ``accesses`` in each lane; when
        the last one has come.  Those that wait take ``each`` accesses on average."""
        shares, waiting = self._shares_at(now), self.waiting
        ports = [1 - share for share in shares]
        for lane in range(2):
            waiting[lane] += accesses[lane]
        room = ROOM * each
        first = int(waiting[1] > waiting[0])  # has the bus
        other = 1 - first
        clocks = max(count, *((waiting[lane] - room) / ports[lane] for lane in range(2)))
        bus = 2.0  # accesses a clock
        if self._one_bus:
            bus = each * (1 - lost_reads(shares, each - 1))
            # Until the other one has room again, whether the first one has work until then or not.
            held = (sum(waiting) - room) / bus
            if bus > ports[first]:
                held = min(held, (waiting[other] - room) / (bus - ports[first]))
            clocks = max(clocks, held)
        made = min(waiting[first], ports[first] * clocks)
        waiting[first] -= made
        waiting[other] -= min(waiting[other], ports[other] * clocks, bus * clocks - made)
        return now + clocks

    def drained(self, now: float) -> float:
        """When nothing waits any more, if nothing comes after ``now``."""
        return now + max(waiting / (1 - share) for waiting, share in zip(
            self.waiting, self._shares_at(now), strict=True))


def lost_reads(shares: Sequence[float], stored: float) -> float:
    """The share of the clocks of a memory bus in which nothing is read, though pixels wait before
    both lanes, of which the share ``stored`` is written; measured, not derived.

    A slot of the scan keeps one lane from the bus, and nothing is read if the other one writes.
    Where all slots are of one lane the two also get out of step: next both want to read, or to
    write.
    """
    if min(shares) > 0:
        return sum(shares) * stored / 2
    return float(sum(shares) * 2 / 3 * stored ** 1.4)
