"""What memory units behind a crossbar take, and when they have done it."""

from __future__ import annotations

from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from ...organisations.organisation_of import organisation_of
from ...reference.exact import draw
from ...specification.configuration import MachineConfiguration
from ...specification.display_list import DisplayList
from ...specification.queues import FRAGMENTS_WAITING
from ..one_port_lanes import scan_share
from .element_streams import ElementStreams

Bool = NDArray[np.bool_]
Int64 = NDArray[np.int64]


class UnitPorts(Protocol):
    """The ports of all units."""

    @property
    def bound(self) -> float:
        """Clocks that the busiest of them needs for what it took."""

    def ready(self) -> Bool:
        """bool (units,): each can take a fragment in the next clock, which begins."""

    def take(self, unit: Int64, fragment: Int64) -> None:
        """These units take these fragments."""

    @property
    def idle(self) -> bool:
        """All that was taken is done."""


class TwoPortUnits:
    """A fragment a clock, seen or not."""

    def __init__(self, units: int) -> None:
        self._ready = np.ones(units, bool)
        self._taken = np.zeros(units, np.int64)

    @property
    def bound(self) -> float:
        return float(self._taken.max())

    def ready(self) -> Bool:
        return self._ready

    def take(self, unit: Int64, fragment: Int64) -> None:
        self._taken[unit] += 1

    @property
    def idle(self) -> bool:
        return True


class OnePortUnits:
    """A fragment is read and, if it is nearer than all before it, written, at a port that the scan
    has now and then; some wait before it."""

    def __init__(self, configuration: MachineConfiguration, streams: ElementStreams,
                 after: DisplayList | None) -> None:
        organisation, units = organisation_of(configuration), configuration.units
        self._place, self._rank = streams.place, streams.rank
        self._nearest = np.full(units * organisation.words, configuration.rank_background)
        if after is not None:
            depth = draw(after, shading="flat", **organisation.resolution.shifts).depth
            y, x = np.mgrid[:depth.shape[0], :depth.shape[1]]
            place = organisation.unit(x, y) * organisation.words + organisation.word(x, y)
            self._nearest[place] = depth << configuration.order_bits
        self._pace = 1 - scan_share(configuration)
        self._accesses = np.zeros(units)
        # Of those that wait: how many, and the accesses that each takes.
        self._waiting = np.zeros(units, np.int64)
        self._costs = np.zeros((units, FRAGMENTS_WAITING))
        self._begun = np.zeros(units, np.int64)
        self._left = np.zeros(units)

    @property
    def bound(self) -> float:
        return float(self._accesses.max()) / self._pace

    @property
    def idle(self) -> bool:
        return not self._waiting.any()

    def ready(self) -> Bool:
        self._left -= self._pace
        done = np.flatnonzero((self._waiting > 0) & (self._left <= 0))
        self._waiting[done] -= 1
        self._begun[done] += 1
        self._left[done] += self._costs[done, self._begun[done] % FRAGMENTS_WAITING]
        return self._waiting < FRAGMENTS_WAITING

    def take(self, unit: Int64, fragment: Int64) -> None:
        place, rank = self._place[fragment], self._rank[fragment]
        cost = 1.0 + (rank < self._nearest[place])
        self._nearest[place] = np.minimum(rank, self._nearest[place])
        self._accesses[unit] += cost
        waiting = self._waiting[unit]
        self._costs[unit, (self._begun[unit] + waiting) % FRAGMENTS_WAITING] = cost
        self._left[unit] = np.where(waiting > 0, self._left[unit], cost)
        self._waiting[unit] += 1
