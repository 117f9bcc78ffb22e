"""How often spans access memory units of one port.

With two ports a fragment takes one clock, seen or not.  One port is shared by reads,
writes and the scan's slots, in lanes side by side: see ``one_port_lanes``.
"""

from __future__ import annotations

from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from ...organisations.organisation import Organisation
from ...reference.coverage import Triangles
from ...reference.exact import draw, fragments
from ...specification.display_list import DisplayList
from .scan_reads import lane_of, scan_share

Float64 = NDArray[np.float64]
Int64 = NDArray[np.int64]


class DrawnSpans(Protocol):
    """Spans of some triangles, all that these cover; n of them.

    ``begin`` ``end``  the triangles
    ``units``          int64 (n,): memory units that each is drawn into, half of them in each lane
    """

    @property
    def begin(self) -> int: ...

    @property
    def end(self) -> int: ...

    @property
    def units(self) -> Int64: ...

    def counted(self, x: Int64, lane: Int64, weights: NDArray[np.bool_] | None) -> Int64:
        """int64 (n, 2): how many fragments of each span are in each lane, or the sum of their
        weights; ``x`` and ``lane`` of all fragments, triangles ascending, rows ascending, columns
        ascending."""

    def __len__(self) -> int: ...


class PortAccesses:
    """The accesses of all spans of a node's list to its one-port units, asked for in drawing order;
    the node has drawn the list ``after`` before it."""

    def __init__(self, organisation: Organisation, display_list: DisplayList,
                 triangles: Triangles, after: DisplayList | None = None, node: int = 0) -> None:
        self._configuration = organisation.configuration
        self._node = node
        self._display_list = display_list
        self._triangles = triangles
        self._organisation = organisation
        width, height, *_ = organisation.resolution
        self._nearest = np.full(width * height, self._configuration.depth_background)
        self._accesses = np.zeros(organisation.units)
        if after is not None:
            picture = draw(after, shading="flat", **organisation.resolution.shifts)
            self._nearest = picture.depth.astype(np.int64).reshape(-1)

    def of(self, spans: DrawnSpans) -> Float64:
        """float64 (n, 3, 2), by lane: fragments of each span, visible ones, and the clocks that
        their units need for both; the next call must go on where this one ends."""
        if not len(spans):
            return np.zeros((0, 3, 2))
        reads, writes = self._accesses_of(spans)
        ways = np.maximum(spans.units // 2, 1)
        work = np.maximum(reads, (reads + writes) / ways[:, np.newaxis])
        return np.stack([reads, writes, work], axis=1)

    @property
    def bound(self) -> float:
        """Clocks that the busiest unit's one port is taken by the spans asked for and by the
        scan."""
        return float(self._accesses.max()) / (1 - scan_share(self._configuration, self._node))

    def _accesses_of(self, spans: DrawnSpans) -> tuple[Int64, Int64]:
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
        return spans.counted(x, lane, None), spans.counted(x, lane, visible)

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
