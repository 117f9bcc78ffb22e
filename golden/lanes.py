"""Clocks of a processing element's depth test at the ports of one-port memory units.

A fragment reads, and where it is visible writes, at the one port of its unit, which the
scan has now and then.  Units with even and with odd numbers are served side by side,
in two *lanes*: in a clock one lane reads while the other writes, and a few fragments
wait before each.  So a span goes on while a lane is still at work for the one before,
and is held up only where more would wait than there is room for.

Each lane is followed as one server with so much work, span by span; which line the
scan is at decides how much of its time it has.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from .cards import domains
from .configuration import MachineConfiguration

Float64 = NDArray[np.float64]
Int64 = NDArray[np.int64]

#: Fragments that can wait before each of two lanes, so that short runs in one unit even out.
FRAGMENTS_WAITING = 16


def depth_lanes(configuration: MachineConfiguration) -> int:
    """1 where no processing element has more than one memory unit, or 2."""
    return 1 + any(units > 1 for _, units in domains(configuration.cards))


def scan_shares(configuration: MachineConfiguration) -> Float64:
    """float64 (rows, elements, 2): of a clock in such a row of the picture, how much the scan
    has of each lane; blanking of both kinds is spread over all.  The rows repeat."""
    interlace, timing = configuration.interlace, configuration.timing
    columns = 1 << max((interlace.skew_bit or 0) + 1, interlace.unit_mask("x").bit_length())
    rows = 1 << interlace.unit_mask("y").bit_length()
    y, x = np.mgrid[:rows, :columns]
    owner = np.full(interlace.units, configuration.processing_elements)  # orphans' own
    for element, (first, count) in enumerate(domains(configuration.cards)):
        owner[first:first + count] = element
    unit = interlace.unit(x, y)
    lane = unit & 1 if depth_lanes(configuration) == 2 else unit * 0
    # A unit reads for a group of pixels at once, at its beginning.
    groups = columns >> interlace.group_bits
    read = np.zeros((rows, groups, configuration.processing_elements + 1, 2))
    read[y, x >> interlace.group_bits, owner[unit], lane] = 1
    shown = timing.horizontal_active * timing.vertical_active / timing.pixels
    clocks = configuration.clocks_per_pixel << interlace.group_bits + interlace.x_shift
    return np.asarray(read[:, :, :-1].mean(axis=1) * (shown / clocks))


class LaneClocks:
    """The lanes of every processing element, asked span by span in drawing order.

    The scan begins with the first span.
    """

    def __init__(self, configuration: MachineConfiguration) -> None:
        timing, elements = configuration.timing, configuration.processing_elements
        self._waiting = FRAGMENTS_WAITING if depth_lanes(configuration) == 2 else 0
        clocks_per_line = timing.horizontal_total * configuration.clocks_per_pixel
        self._clocks_per_row = clocks_per_line << configuration.interlace.y_shift
        self._shares: list[list[list[float]]] = scan_shares(configuration).tolist()
        self._now = [0.0] * elements
        #: When each lane has done all it has.
        self._done = [[0.0, 0.0] for _ in range(elements)]

    def of(self, element: Int64, begin: Float64, reads: Int64, writes: Int64,
           ways: Int64) -> tuple[Float64, Float64]:
        """float64 (n,) each: clocks from a span's first fragment until the next one's may come, and
        from then on until the lanes have done all.

        ``begin``: no sooner does it begin; ``reads``, ``writes``: int64 (n, 2), by lane; ``ways``:
        units of a lane that they are spread over.  The next call goes on where this one ends.
        """
        work = np.maximum(reads, (reads + writes) / ways[:, np.newaxis])
        clocks, left = np.empty(len(element)), np.empty(len(element))
        rows, waiting = len(self._shares), self._waiting
        for place, (which, earliest, (even, odd), written, worked) in enumerate(zip(
                element.tolist(), begin.tolist(), reads.tolist(), writes.tolist(), work.tolist(),
                strict=True)):
            now, done = max(self._now[which], earliest), self._done[which]
            share = self._shares[int(now / self._clocks_per_row) % rows][which]
            # A read is lost where one lane writes while the scan has the other.
            end = now + even + odd + written[0] * share[1] + written[1] * share[0]
            for lane, count in enumerate((even, odd)):
                if count:
                    pace = 1 - share[lane]
                    done[lane] = max(done[lane], now) + worked[lane] / pace
                    end = max(end, done[lane] - waiting * worked[lane] / (count * pace))
            clocks[place] = end - now
            left[place] = max(*done, end) - end
            self._now[which] = end
        return clocks, left
