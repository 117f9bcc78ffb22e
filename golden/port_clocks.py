"""Clocks that the spans of a processing element take at the ports of its memory units.

With two ports a fragment takes one clock, seen or not.  With one port the read, the
write of a visible fragment and the scan's slots share it:

* all in one unit, a fragment takes a clock for the read and one for the write;
* units in turn along a row, the writes to one fall into the reads from the other;
* units in turn from row to row, a row's reads wait for its own writes and for those of
  the rows just before that lie in the same unit: see ``RowClocks``.

A slot of the scan delays whatever the unit would have done.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from .configuration import MachineConfiguration
from .coverage import Triangles
from .display_list import DisplayList
from .exact import draw, fragments
from .lattice_spans import LatticeSpans

Float64 = NDArray[np.float64]
Int64 = NDArray[np.int64]

#: From a fragment's read to its write.
WRITE_LATENCY = 3

_PERIOD = 2 * WRITE_LATENCY
#: For each pattern of writes in a run's first clocks: whether it reads in a clock of its period,
#: and the clocks in which it does.
_READ = np.array([[bool(mask >> clock % WRITE_LATENCY & 1) == (clock >= WRITE_LATENCY)
                   for clock in range(_PERIOD)] for mask in range(1 << WRITE_LATENCY)])
_READS = np.array([np.flatnonzero(reads) for reads in _READ])


class RowClocks:
    """Reads and writes of runs of visible fragments, each run in one unit of one port.

    The runs of an element follow one another without a gap.  A write comes
    ``WRITE_LATENCY`` clocks after its read and has the port first, so in a run the
    clocks with a read and those with a write change places every ``WRITE_LATENCY``
    clocks; where the writes lie at its start, the runs before have left behind.
    """

    def __init__(self, elements: int, units: int) -> None:
        #: Writes that each unit still has to take: bit j is j clocks from now.
        self._pending = np.zeros((elements, units), np.int64)

    def of(self, element: Int64, unit: Int64, length: Int64) -> Int64:
        """int64 (n,): clocks from a run's first one to its last read, in drawing order.

        Element by element; the next call goes on where this one ends.
        """
        order = np.argsort(element, kind="stable")
        counts = np.bincount(element, minlength=len(self._pending))
        starts = np.cumsum(counts) - counts
        clocks = np.zeros(len(order), np.int64)
        bits = np.arange(WRITE_LATENCY)
        for turn in range(int(counts.max(initial=0))):
            elements = np.flatnonzero(counts > turn)
            run = order[starts[elements] + turn]
            mask = self._pending[elements, unit[run]]
            more = length[run] - 1
            taken = (_PERIOD * (more // WRITE_LATENCY) + _READS[mask, more % WRITE_LATENCY] + 1)
            clocks[run] = taken
            # Those of its reads whose writes come after its end.
            clock = taken[:, np.newaxis] - WRITE_LATENCY + bits
            late = (clock >= 0) & _READ[mask[:, np.newaxis], clock % _PERIOD]
            self._pending[elements] >>= np.minimum(taken, WRITE_LATENCY)[:, np.newaxis]
            self._pending[elements, unit[run]] |= (late << bits).sum(axis=1)
        return clocks


def scan_share(configuration: MachineConfiguration) -> float:
    """Of a unit's clocks, those in which the scan reads it; the mean over a scan."""
    interlace, timing = configuration.interlace, configuration.timing
    shown = timing.horizontal_active * timing.vertical_active / timing.pixels
    groups = configuration.clocks_per_pixel << (interlace.x_unit_bits + interlace.x_shift)
    return shown / (groups << interlace.y_unit_bits)


class PortClocks:
    """The clocks of all spans of a list, asked for in drawing order; ``after`` was drawn before.

    Exact with two ports.  With one, within half a percent of the simulated cases where an element
    has one unit; lists that take less than a few lines of the scan depend on where it is.  Where
    it has several units, rows of many pixels are as near, short ones are not: the end of a row and
    the begin of the next may meet in a unit in turn along the rows, and in turn from row to row
    slots of the scan may throw reads and writes into a worse pattern for long, so that thin slivers
    and small triangles take up to a third more than said.
    """

    def __init__(self, configuration: MachineConfiguration, display_list: DisplayList,
                 triangles: Triangles, after: DisplayList | None = None) -> None:
        self._configuration = configuration
        self._display_list = display_list
        self._triangles = triangles
        self._two_ports = configuration.memory_ports == 2
        self._rows = RowClocks(configuration.processing_elements, configuration.units)
        interlace = configuration.interlace
        self._nearest = np.full(interlace.width * interlace.height, configuration.depth_background)
        self._accesses = np.zeros(interlace.units)
        if after is not None and not self._two_ports:
            self._nearest = draw(after, shading="flat", x_shift=interlace.x_shift,
                                 y_shift=interlace.y_shift).depth.astype(np.int64).reshape(-1)

    def of(self, spans: LatticeSpans) -> Float64:
        """float64 (n,): clocks of each span; the next call must go on where this one ends."""
        length = spans.length.astype(np.float64)
        if self._two_ports or not len(length):
            return length
        interlace, units = self._configuration.interlace, self._configuration.units
        written = self._written(spans)
        clocks = length.copy()
        in_turn = interlace.x_unit_bits > spans.x_bits
        if units == self._configuration.processing_elements:
            clocks += written
        else:
            unit = interlace.unit(spans.x_offset << self._configuration.square_bits, spans.row)
            waits = self._rows.of(spans.element, unit, spans.length) - spans.length
            # Spread over the runs of the element, as they are where there are gaps between them.
            order = np.argsort(spans.element, kind="stable")
            spread = np.convolve((waits * (written / spans.length))[order],
                                 np.full(_PERIOD, 1 / _PERIOD))[:len(order)]
            clocks[order] += np.where(in_turn[order], 0, spread)
        return clocks * self._scan_factor(spans)

    @property
    def bound(self) -> float:
        """Clocks that the busiest unit's one port is taken by the spans asked for and by the scan;
        0 with two ports, which never wait."""
        return float(self._accesses.max()) / (1 - scan_share(self._configuration))

    def _scan_factor(self, spans: LatticeSpans) -> Float64:
        """How much longer it takes at a port that the scan uses too, blanking included.

        A unit has slots in the lines that it has pixels of.  In those a processing element is
        slower in its rows on that unit, in the others not at all.
        """
        interlace, timing = self._configuration.interlace, self._configuration.timing
        group = interlace.x_unit_bits + interlace.x_shift
        shown = timing.horizontal_active * timing.vertical_active / timing.pixels
        slots = shown / (self._configuration.clocks_per_pixel << group)
        lines = 1 << interlace.y_unit_bits
        own = 1 << (interlace.y_unit_bits - spans.y_bits)
        slower = (1 / (1 - slots) + own - 1) / own
        return np.asarray(lines / (own / slower + lines - own))

    def _written(self, spans: LatticeSpans) -> Int64:
        """int64 (n,): visible fragments of each span, as the pixels are drawn one after another."""
        interlace = self._configuration.interlace
        kept = self._triangles.primitive[spans.begin:spans.end]
        part = replace(self._display_list, **{
            name: getattr(self._display_list, name)[kept]
            for name in ("position", "depth", "color")})
        drawn = fragments(part, shading="flat", x_shift=interlace.x_shift,
                          y_shift=interlace.y_shift)
        pixel = drawn.y.astype(np.int64) * interlace.width + drawn.x
        visible = self._visible(pixel, drawn.depth)
        unit = interlace.unit(drawn.x.astype(np.int64), drawn.y.astype(np.int64))
        self._accesses += np.bincount(unit, 1 + visible, interlace.units)
        # Fragments come in the order of the whole spans and of the columns in each.
        whole = np.repeat(np.arange(len(spans.whole)), spans.whole.length)
        written = np.zeros(len(spans.source), np.int64)
        for bits in np.unique(spans.x_bits).tolist():
            column = drawn.x.astype(np.int64) >> self._configuration.square_bits
            key = (whole << bits) | (column & ((1 << bits) - 1))
            counts = np.bincount(key, visible, len(spans.whole) << bits).astype(np.int64)
            here = np.flatnonzero(spans.x_bits == bits)
            written[here] = counts[(spans.source[here] << bits) | spans.x_offset[here]]
        return written

    def _visible(self, pixel: Int64, depth: Int64) -> NDArray[np.bool_]:
        """Which fragments are nearer than all before them on their pixel; keeps the nearest."""
        order = np.argsort(pixel, kind="stable")
        sorted_pixel, sorted_depth = pixel[order], depth[order]
        first = np.ones(len(order), bool)
        first[1:] = sorted_pixel[1:] != sorted_pixel[:-1]
        # Lower by more than any depth from pixel to pixel: the running minimum begins anew there.
        base = np.cumsum(first) << 33
        running = np.minimum.accumulate(sorted_depth - base) + base
        before = self._nearest[sorted_pixel]
        before[1:] = np.where(first[1:], before[1:], np.minimum(before[1:], running[:-1]))
        last = np.roll(first, -1)
        self._nearest[sorted_pixel[last]] = np.minimum(before, sorted_depth)[last]
        visible = np.empty(len(order), bool)
        visible[order] = sorted_depth < before
        return visible
