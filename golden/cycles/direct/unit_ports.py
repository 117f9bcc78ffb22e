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
from ..one_port.scan_reads import scan_share
from .element_streams import ElementStreams
from .scan_slots import slots_from

Bool = NDArray[np.bool_]
Int64 = NDArray[np.int64]


class UnitPorts(Protocol):
    """The ports of all units; in each clock it is asked who is ``ready``, and told what they
    ``take``.

    ``latency``  clocks from when a fragment is looked at until it may be written at last
    """

    latency: int

    def ready(self) -> Bool:
        """bool (units,): each can take a fragment in this clock."""

    def take(self, unit: Int64, fragment: Int64) -> Int64:
        """These units take these fragments; those that are looked at in this clock."""

    @property
    def idle(self) -> bool:
        """All that was taken is done."""

    @property
    def bound(self) -> float:
        """Clocks that the busiest of them needs for what it took."""


class TwoPortUnits:
    """A fragment a clock, seen or not."""

    latency = 0

    def __init__(self, units: int) -> None:
        self._ready = np.ones(units, bool)
        self._taken = np.zeros(units, np.int64)

    def ready(self) -> Bool:
        return self._ready

    def take(self, unit: Int64, fragment: Int64) -> Int64:
        self._taken[unit] += 1
        return fragment

    @property
    def idle(self) -> bool:
        return True

    @property
    def bound(self) -> float:
        return float(self._taken.max())


class OnePortUnits:
    """Some fragments wait for a port that has a read of each and, of each that is nearer than all
    before it, a write, which goes first; and before both the scan (``scan_slots``), which ``begin``
    clocks before the first clock here began to show its first line."""

    latency = 3

    def __init__(self, configuration: MachineConfiguration, streams: ElementStreams,
                 after: DisplayList | None, begin: int | None = None) -> None:
        organisation, units = organisation_of(configuration), configuration.units
        self._place, self._rank = streams.place, streams.rank
        self._nearest = np.full(units * organisation.words, configuration.rank_background)
        if after is not None:
            depth = draw(after, shading="flat", **organisation.resolution.shifts).depth
            y, x = np.mgrid[:depth.shape[0], :depth.shape[1]]
            place = organisation.unit(x, y) * organisation.words + organisation.word(x, y)
            self._nearest[place] = depth << configuration.order_bits
        self._share, self._scan = scan_share(configuration), slots_from(configuration, begin)
        self._accesses = np.zeros(units, np.int64)
        self._units = np.arange(units)
        # Fragments that wait, from the place ``_first`` on in a ring, and those that do not show
        # yet; whether each is nearer.
        self._waiting, self._first, self._new = (np.zeros(units, np.int64) for _ in range(3))
        self._fragment = np.zeros((units, FRAGMENTS_WAITING), np.int64)
        self._nearer = np.zeros((units, FRAGMENTS_WAITING), bool)
        # Of three stages behind the read whether they hold one, and whether that is nearer.
        self._answer, self._compare, self._write = (np.zeros(units, bool) for _ in range(3))
        self._answer_nearer, self._compare_nearer = (np.zeros(units, bool) for _ in range(2))

    def ready(self) -> Bool:
        return self._waiting < FRAGMENTS_WAITING

    def take(self, unit: Int64, fragment: Int64) -> Int64:
        found = self._clock()
        place, rank = self._place[fragment], self._rank[fragment]
        nearer = rank < self._nearest[place]
        self._nearest[place] = np.minimum(rank, self._nearest[place])
        self._accesses[unit] += 1 + nearer
        ring = (self._first + self._waiting)[unit] % FRAGMENTS_WAITING
        self._fragment[unit, ring], self._nearer[unit, ring] = fragment, nearer
        self._waiting[unit] += 1
        self._new[:] = 0
        self._new[unit] = 1
        return found

    def _clock(self) -> Int64:
        """What the ports do; the fragments read."""
        scans = next(self._scan)
        write_moves = ~self._write if scans else np.ones_like(self._write)
        compare_moves = ~self._compare | write_moves
        answer_moves = ~self._answer | compare_moves
        reads = answer_moves & (self._waiting > self._new) & ~self._write & (not scans)
        nearer = self._nearer[self._units, self._first]
        found = self._fragment[self._units, self._first][reads]
        self._write = np.where(write_moves, self._compare & self._compare_nearer, self._write)
        self._compare_nearer = np.where(compare_moves, self._answer_nearer, self._compare_nearer)
        self._compare = np.where(compare_moves, self._answer, self._compare)
        self._answer_nearer = np.where(answer_moves, nearer, self._answer_nearer)
        self._answer = np.where(answer_moves, reads, self._answer)
        self._waiting -= reads
        self._first = (self._first + reads) % FRAGMENTS_WAITING
        return np.asarray(found)

    @property
    def idle(self) -> bool:
        return not (self._waiting.any() or self._answer.any() or self._compare.any()
                    or self._write.any())

    @property
    def bound(self) -> float:
        return float(self._accesses.max()) / (1 - self._share)
