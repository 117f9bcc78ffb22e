"""Clocks that the spans of a processing element take at the ports of its memory units.

With two ports a fragment takes one clock, seen or not.  With one port the read, the
write of a visible fragment and the scan's slots share it, in two lanes side by side:
see ``lanes``.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from .configuration import MachineConfiguration
from .coverage import Triangles
from .display_list import DisplayList
from .exact import draw, fragments
from .lanes import LaneClocks, depth_lanes
from .lattice_spans import LatticeSpans

Float64 = NDArray[np.float64]
Int64 = NDArray[np.int64]

def scan_share(configuration: MachineConfiguration) -> float:
    """Of a unit's clocks, those in which the scan reads it; the mean over a scan."""
    interlace, timing = configuration.interlace, configuration.timing
    shown = timing.horizontal_active * timing.vertical_active / timing.pixels
    groups = configuration.clocks_per_pixel << (interlace.x_unit_bits + interlace.x_shift)
    return shown / (groups << interlace.y_unit_bits)


class PortClocks:
    """The clocks of all spans of a list, asked for in drawing order; ``after`` was drawn before.

    Exact with two ports.  With one within two percent of the simulated cases, mostly; where
    the scan is as a list begins is not known, so one that takes less than a few of its lines may be
    five percent off, and so may one whose units alternate from row to row only.
    """

    def __init__(self, configuration: MachineConfiguration, display_list: DisplayList,
                 triangles: Triangles, after: DisplayList | None = None) -> None:
        self._configuration = configuration
        self._display_list = display_list
        self._triangles = triangles
        self._two_ports = configuration.memory_ports == 2
        self._lanes = LaneClocks(configuration)
        interlace = configuration.interlace
        self._nearest = np.full(interlace.width * interlace.height, configuration.depth_background)
        self._accesses = np.zeros(interlace.units)
        if after is not None and not self._two_ports:
            self._nearest = draw(after, shading="flat", x_shift=interlace.x_shift,
                                 y_shift=interlace.y_shift).depth.astype(np.int64).reshape(-1)

    def of(self, spans: LatticeSpans, found: Float64) -> tuple[Float64, Float64]:
        """float64 (n,) each: clocks of each span, and those that its last accesses take after it;
        the next call must go on where this one ends.

        ``found``: when the walker has found it at the soonest, in clocks from the first one.
        """
        length = spans.length.astype(np.float64)
        if self._two_ports or not len(length):
            return length, np.zeros(len(length))
        reads, writes = self._accesses_of(spans)
        # Units of a block, half of them in each lane.
        block_bits = self._configuration.interlace.unit_bits - spans.x_bits - spans.y_bits
        ways = 1 << np.maximum(block_bits - 1, 0)
        by_element = np.argsort(spans.element, kind="stable")
        clocks, left = np.empty(len(length)), np.empty(len(length))
        element, begin = spans.element[by_element], found[by_element]
        clocks[by_element], left[by_element] = self._lanes.of(
            element, begin, *(facts[by_element] for facts in (reads, writes, ways)))
        return clocks, left

    @property
    def bound(self) -> float:
        """Clocks that the busiest unit's one port is taken by the spans asked for and by the scan;
        0 with two ports, which never wait."""
        return float(self._accesses.max()) / (1 - scan_share(self._configuration))

    def _accesses_of(self, spans: LatticeSpans) -> tuple[Int64, Int64]:
        """int64 (n, 2), by lane: fragments of each span, and visible ones, as the pixels are drawn
        one after another."""
        interlace = self._configuration.interlace
        kept = self._triangles.primitive[spans.begin:spans.end]
        part = replace(self._display_list, **{
            name: getattr(self._display_list, name)[kept]
            for name in ("position", "depth", "color")})
        drawn = fragments(part, shading="flat", x_shift=interlace.x_shift,
                          y_shift=interlace.y_shift)
        x, y = drawn.x.astype(np.int64), drawn.y.astype(np.int64)
        visible = self._visible(y * interlace.width + x, drawn.depth)
        unit = interlace.unit(x, y)
        self._accesses += np.bincount(unit, 1 + visible, interlace.units)
        lane = unit & 1 if depth_lanes(self._configuration) == 2 else unit * 0
        # Fragments come in the order of the whole spans and of the columns in each.
        whole = np.repeat(np.arange(len(spans.whole)), spans.whole.length)
        counts = np.zeros((2, len(spans.source), 2), np.int64)
        for bits in np.unique(spans.x_bits).tolist():
            column = x >> self._configuration.square_bits
            key = ((whole << bits) | (column & ((1 << bits) - 1))) * 2 + lane
            here = np.flatnonzero(spans.x_bits == bits)
            place = (spans.source[here] << bits) | spans.x_offset[here]
            for number, weights in enumerate((None, visible)):
                found = np.bincount(key, weights, len(spans.whole) << bits + 1)
                counts[number, here] = found.reshape(-1, 2)[place]
        return counts[0], counts[1]

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
