"""How often spans access memory units of one port.

With two ports a fragment takes one clock, seen or not.  One port is shared by reads,
writes and the scan's slots, in lanes side by side: see ``one_port_lanes``.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ..organisations.organisation_of import organisation_of
from ..reference.coverage import Triangles
from ..reference.exact import draw, fragments
from ..specification.configuration import MachineConfiguration
from ..specification.display_list import DisplayList
from .element_spans import LatticeSpans
from .one_port_lanes import lane_of, scan_share

Float64 = NDArray[np.float64]
Int64 = NDArray[np.int64]


class PortAccesses:
    """The accesses of all spans of a node's list to its one-port units, asked for in drawing order;
    the node has drawn the list ``after`` before it."""

    def __init__(self, configuration: MachineConfiguration, display_list: DisplayList,
                 triangles: Triangles, after: DisplayList | None = None, node: int = 0) -> None:
        self._configuration = configuration
        self._node = node
        self._display_list = display_list
        self._triangles = triangles
        organisation = self._organisation = organisation_of(configuration)
        width, height, *_ = organisation.resolution
        self._nearest = np.full(width * height, configuration.depth_background)
        self._accesses = np.zeros(organisation.units)
        self._block_units = np.array([block.units for block in organisation.each[node].blocks])
        if after is not None:
            picture = draw(after, shading="flat", **organisation.resolution.shifts)
            self._nearest = picture.depth.astype(np.int64).reshape(-1)

    def of(self, spans: LatticeSpans) -> Float64:
        """float64 (n, 3, 2), by lane: fragments of each span, visible ones, and the clocks that
        their units need for both; the next call must go on where this one ends."""
        if not len(spans.length):
            return np.zeros((0, 3, 2))
        reads, writes = self._accesses_of(spans)
        # Half of a block's units are in each lane.
        ways = np.maximum(self._block_units[spans.block] // 2, 1)
        work = np.maximum(reads, (reads + writes) / ways[:, np.newaxis])
        return np.stack([reads, writes, work], axis=1)

    @property
    def bound(self) -> float:
        """Clocks that the busiest unit's one port is taken by the spans asked for and by the
        scan."""
        return float(self._accesses.max()) / (1 - scan_share(self._configuration, self._node))

    def _accesses_of(self, spans: LatticeSpans) -> tuple[Int64, Int64]:
        """int64 (n, 2), by lane: fragments of each span, and visible ones, as the pixels are drawn
        one after another."""
        organisation = self._organisation
        kept = self._triangles.primitive[spans.begin:spans.end]
        drawn = fragments(self._display_list.chosen(kept), shading="flat",
                          **organisation.resolution.shifts)
        x, y = drawn.x.astype(np.int64), drawn.y.astype(np.int64)
        visible = self._visible(y * organisation.resolution.width + x, drawn.depth)
        unit = organisation.unit(x, y)
        self._accesses += np.bincount(unit, 1 + visible, organisation.units)
        lane = lane_of(self._configuration, unit)
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
