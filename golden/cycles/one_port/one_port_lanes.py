"""Clocks of a processing element's depth test at the ports of one-port memory units.

A fragment reads, and where it is visible writes, at the one port of its unit, which the
scan has now and then.  Units with even and with odd numbers are served side by side,
in two *lanes*: in a clock one lane reads while the other writes.  Where no processing
element has more than one unit there is one lane.  A few fragments wait before each, so
a span goes on while a lane is still at work for the one before, and is held up only
where more would wait than there is room for.

Each lane is followed as one server with so much work, span by span; which line the
scan is at decides how much of its time it has.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ...organisations.organisation import Organisation
from ...organisations.organisation_of import organisation_of
from ...specification.configuration import MachineConfiguration
from ...specification.queues import FRAGMENTS_WAITING, depth_lanes

Float64 = NDArray[np.float64]
Int64 = NDArray[np.int64]

#: Three rows for a span, each by lane: its fragments, its visible fragments, and the clocks that
#: its units need for both.
SpanAccesses = list[list[float]]

#: Clocks that a lane loses where nothing waited: two to its first read, and one until the first
#: write has come down its pipeline and the two take turns.
LANE_START = 3


def clocks_per_row(configuration: MachineConfiguration) -> int:
    """How long the scan shows a row of the picture: its lines, with the blanking beside them."""
    line = configuration.timing.horizontal_total * configuration.clocks_per_pixel
    return line << organisation_of(configuration).resolution.y_shift


def _shown(configuration: MachineConfiguration) -> float:
    """The share of a scan that is not blanking."""
    timing = configuration.timing
    return timing.horizontal_active * timing.vertical_active / timing.pixels


def lane_of(configuration: MachineConfiguration, unit: Int64) -> Int64:
    """The lane that serves each memory unit."""
    return unit & 1 if depth_lanes(configuration) == 2 else unit * 0


def scan_share(configuration: MachineConfiguration, node: int = 0) -> float:
    """The share of a unit's clocks in which the scan reads it; the mean over a scan."""
    # Every unit of a node reads as often as the others.
    organisation = organisation_of(configuration)
    if not organisation.is_scanned(node):
        return 0.0
    clocks = configuration.clocks_per_pixel << organisation.resolution.x_shift
    return _shown(configuration) / (clocks * organisation.units)


def scan_shares(organisation: Organisation) -> Float64:
    """float64 (rows, elements, 2): the share of each lane's time that the scan takes while it
    shows that row of the picture; blanking of both kinds is spread over all rows.  The rows
    repeat.  Nodes that the scan does not read lose nothing."""
    return _scan_shares(organisation, _shown(organisation.configuration))


def shown_scan_shares(organisation: Organisation) -> Float64:
    """As ``scan_shares``, of the time in which pixels are shown: blanking has none of it."""
    return _scan_shares(organisation, 1.0)


def _scan_shares(organisation: Organisation, shown: float) -> Float64:
    configuration = organisation.configuration
    elements = len(organisation.domains)
    unit, group = organisation.scan_tile, organisation.scan_group
    rows, columns = unit.shape
    y, x = np.mgrid[:rows, :columns]
    lane = lane_of(configuration, unit)
    # A unit reads for a group of pixels at once, at its beginning.
    clocks = configuration.clocks_per_pixel * group << organisation.resolution.x_shift
    read = np.zeros((rows, columns // group, elements + 1, 2), bool)  # the last: orphans
    for node, owner in enumerate(organisation.owners):
        if organisation.is_scanned(node):
            read[y, x // group, owner[unit], lane] = True
    return np.asarray(read[:, :, :-1].mean(axis=1) * (shown / clocks))


class ElementLanes:
    """The lanes of one processing element, which are told its spans in drawing order.

    ``shares``: float64 (rows, 2), its own of ``scan_shares``.  The scan begins at clock 0.
    ``done`` is when the lanes have done all that they were told.
    """

    def __init__(self, configuration: MachineConfiguration, shares: Float64) -> None:
        self._clocks_per_row = clocks_per_row(configuration)
        self._shares: list[list[float]] = shares.tolist()
        self._done = [0.0, 0.0]

    @property
    def done(self) -> float:
        return max(self._done)

    def take(self, begin: float, accesses: SpanAccesses) -> float:
        """A span with these accesses begins at ``begin``; the clock in which the next one's first
        fragment may come."""
        (reads, written, worked), done = accesses, self._done
        share = self._shares[int(begin / self._clocks_per_row) % len(self._shares)]
        # A read is lost where one lane writes while the scan has the other.
        end = begin + reads[0] + reads[1] + written[0] * share[1] + written[1] * share[0]
        for lane in range(2):
            count = reads[lane]
            if count:
                pace = 1 - share[lane]
                done[lane] = max(done[lane], begin + LANE_START) + worked[lane] / pace
                end = max(end, done[lane] - FRAGMENTS_WAITING * worked[lane] / (count * pace))
        return end
