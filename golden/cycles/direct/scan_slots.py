"""When the scan has the one port of memory units behind a direct merge."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import cycle, islice
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ...organisations.organisation_of import organisation_of
from ...specification.configuration import MachineConfiguration
from ..one_port.scan_reads import scan_share

#: Clocks by which what the cycle model of units does in a clock is later in the machine than the
#: announcement of a fetch from which the scan's read is one clock.
PORT_LATENCY = 1


def scan_slots(configuration: MachineConfiguration) -> NDArray[np.bool_]:
    """bool (clocks of a scan,): all units are read; from the clock on in which a scan fetches the
    first pixel of its first line.

    Units that interlace diagonally all lie side by side in every row, so each of them reads for the
    scan where as many pixels as there are units begin.
    """
    timing, shifts = configuration.timing, organisation_of(configuration).resolution
    pixel, clock = np.divmod(np.arange(configuration.cycles_per_scan),
                             configuration.clocks_per_pixel)
    line, column = np.divmod(pixel, timing.horizontal_total)
    group = configuration.units << shifts.x_shift
    return np.asarray((clock == 0) & (column % group == 0) & (column < timing.horizontal_active)
                      & (line < timing.vertical_active))


def slots_from(configuration: MachineConfiguration, begin: int | None) -> Iterator[Any]:
    """Clock by clock whether the scan has the ports, from ``begin`` clocks after a scan began to
    fetch on; None: nobody knows when, and slots come at even distances."""
    if begin is None:
        return _even_slots(scan_share(configuration))
    slots = scan_slots(configuration)
    begin = (begin + PORT_LATENCY) % len(slots)
    return islice(cycle(slots.tolist()), begin, None)


def _even_slots(share: float) -> Iterator[bool]:
    due = 0.0
    while True:
        due += share
        slot = due >= 1
        due -= slot
        yield slot
