"""When the scan reads the memory units of one port, and what share of a lane's time it takes.

A unit is read for the scan in one clock, as the first of a group of pixels is shown
(``Organisation.scan_group``); whose units these are differs from line to line, and where regions
of the screen are dealt out also along a line.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ...organisations.organisation import Organisation
from ...organisations.organisation_of import organisation_of
from ...specification.configuration import MachineConfiguration
from ...specification.queues import depth_lanes

Bool = NDArray[np.bool_]
Float64 = NDArray[np.float64]
Int64 = NDArray[np.int64]


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


def lane_slots(organisation: Organisation) -> Bool:
    """bool (rows, pixels of a row, elements, 2): a unit of that lane reads for the scan as that
    pixel begins.  The rows repeat; the pixels are those of the machine's resolution."""
    tile, group = organisation.scan_tile, organisation.scan_group
    rows, columns = tile.shape
    width = organisation.resolution.width
    slots = np.zeros((rows, width, len(organisation.domains) + 1, 2), bool)  # the last: orphans
    y, x = np.mgrid[:rows, :width]
    unit = tile[y, x % columns]
    begin = x - x % group  # all units of a group read at its beginning
    for node, owner in enumerate(organisation.owners):
        if organisation.is_scanned(node):
            slots[y, begin, owner[unit], lane_of(organisation.configuration, unit)] = True
    return slots[:, :, :-1]


def _scan_shares(organisation: Organisation, shown: float) -> Float64:
    # A unit reads for a group of pixels at once, at its beginning.
    group = organisation.scan_group
    clocks = organisation.configuration.clocks_per_pixel * group << organisation.resolution.x_shift
    return np.asarray(lane_slots(organisation)[:, ::group].mean(axis=1) * (shown / clocks))
