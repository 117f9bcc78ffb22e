"""What processing elements did with their clocks, as an engine recorded it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ...golden.specification.activity import ACTIVITY_BITS, Activity
from ...golden.specification.commands import Opcode, ResponseKind, opcode_of

#: Commands with which a record begins.
DRAWING = (Opcode.FRAME_START, Opcode.TRIANGLE, Opcode.PREPARED_TRIANGLE)

#: A record is cut into at most so many buckets.
BUCKETS = 256

#: Room for every kind of ``Activity``.
KINDS = 1 << ACTIVITY_BITS


@dataclass(frozen=True)
class Kind:
    """A kind of activity for people: a short ``name``, a ``title``, and a ``color`` of a chart."""

    activity: Activity
    name: str
    title: str
    color: str


#: Fragments first, then what is lost to the picture, to the pipeline, and to others.
ACTIVITY_KINDS = (
    Kind(Activity.FRAGMENT, "fragment", "fragment drawn", "#3b82c4"),
    Kind(Activity.PORT, "port_conflict", "waits for its port: a write", "#b3261e"),
    Kind(Activity.SCAN, "scan_slot", "waits for its port: the scan", "#e07a5f"),
    Kind(Activity.EMPTY_ROW, "empty_row", "row without its pixels", "#d98a2b"),
    Kind(Activity.PREPARING, "preparing", "another block of units", "#f0c05a"),
    Kind(Activity.FILLING, "filling", "pipeline fills", "#8a6fb0"),
    Kind(Activity.BROADCAST, "broadcast_wait", "another FIFO is full", "#7a8794"),
    Kind(Activity.SETUP, "setup_wait", "no triangle is ready", "#a9b4be"),
    Kind(Activity.DRAIN, "drain", "done, others are not", "#cfd6dc"),
    Kind(Activity.SERVICE, "service", "surveys or reports", "#4f8f6a"),
)


@dataclass(frozen=True, eq=False)
class ActivityRecord:
    """One stretch of drawing: from a frame's start, or the first triangle after the counters were
    read, until the frame is drawn, or the machine is done and the counters are read.

    ``begin``          cycle of its first clock
    ``clocks``         how long it is
    ``bucket_clocks``  clocks of each bucket but the last, a power of two
    ``counts``         int64 (buckets, elements, ``KINDS``): clocks of each kind
    """

    begin: int
    clocks: int
    bucket_clocks: int
    counts: NDArray[np.int64]

    @property
    def by_element(self) -> NDArray[np.int64]:
        """int64 (elements, ``ACTIVITY_KINDS``): clocks of each kind in all, in their order."""
        order = [kind.activity.value for kind in ACTIVITY_KINDS]
        return np.asarray(self.counts.sum(axis=0)[:, order])

    def shares(self) -> dict[str, float]:
        """Name of each kind → its part of all elements' clocks."""
        totals = self.by_element.sum(axis=0)
        whole = max(int(totals.sum()), 1)
        return {kind.name: int(total) / whole
                for kind, total in zip(ACTIVITY_KINDS, totals, strict=True)}


def activity_record(begin: int, samples: Sequence[int], elements: int) -> ActivityRecord:
    """A record of ``samples``, the machine's ``activity`` clock by clock, as an integer each."""
    clocks = len(samples)
    bucket_clocks = 1
    while bucket_clocks * BUCKETS < clocks:
        bucket_clocks *= 2
    bucket = np.arange(clocks) // bucket_clocks
    counts = np.zeros((int(bucket[-1]) + 1 if clocks else 0, elements, KINDS), np.int64)
    for element in range(elements):
        kind = np.array([sample >> ACTIVITY_BITS * element & KINDS - 1 for sample in samples],
                        np.int64)
        places: Any = (bucket, element, kind)  # numpy's types know of no index but an array
        np.add.at(counts, places, 1)
    return ActivityRecord(begin, clocks, bucket_clocks, counts)


class ActivityWatch:
    """Makes records of what a machine says clock by clock.

    The compiled model's main program does the same.
    """

    def __init__(self, elements: int) -> None:
        self._elements = elements
        self._begin: int | None = None
        self._samples: list[int] = []
        self.records: list[ActivityRecord] = []

    def clock(self, cycle: int, activity: int, command: int | None,
              response: ResponseKind | None) -> None:
        """``command`` is taken and a ``response`` given in this clock, unless None."""
        opcode = None if command is None else opcode_of(command)
        if opcode == Opcode.READ_COUNTERS:
            self._end()
        elif opcode in DRAWING and self._begin is None:
            self._begin = cycle
        if self._begin is not None:
            self._samples.append(activity)
            if response == ResponseKind.FRAME_DRAWN:
                self._end()

    def _end(self) -> None:
        if self._begin is not None:
            self.records.append(activity_record(self._begin, self._samples, self._elements))
        self._begin, self._samples = None, []
