"""Nodes that send what they have drawn to frame units, on a bus that all of them hear."""

from __future__ import annotations

from functools import cached_property
from typing import Any

import numpy as np

from ..specification.commands import Fault
from ..specification.interlace import Interlace
from .nodes import Nodes
from .organisation import Int64


class SnoopedNodes(Nodes):
    """When drawing is done the nodes have their turns, in ascending order: each sends what it has
    drawn and has not yet heard a nearer pixel for.  Frame units keep the last of each pixel and
    are all that is scanned (Cox and Hanrahan 1993, sections 7 and 8)."""

    name = "snooped bus of nodes"
    merges_after_drawing = True

    @property
    def merge_steps(self) -> int:
        return self.nodes

    @property
    def fault(self) -> Fault | None:
        fault, frame = super().fault, self.configuration.frame
        if frame.units.bit_count() != 1 or (
                fault is None and self._frame.words > frame.words):
            return Fault.UNITS_UNSUPPORTED
        return fault

    @cached_property
    def _frame(self) -> Interlace:
        """Of the frame units, at the resolution of the nodes."""
        width, height, x_shift, y_shift = self.resolution
        return Interlace(self.configuration.frame_units.bit_length() - 1, width, height, x_shift,
                         y_shift)

    def is_scanned(self, node: int) -> bool:
        """The frame units are, and no node."""
        return False

    @property
    def scan_tile(self) -> Int64:
        return self._frame.tile

    @property
    def scan_group(self) -> int:
        return 1 << self._frame.group_bits

    @property
    def scan_reads_per_line(self) -> int:
        return self._frame.scan_reads

    @property
    def depths_read_back(self) -> int:
        """Each node's own, one node after another."""
        return sum(node.depths_read_back for node in self.each)

    def depth_image(self, depths: Any) -> Int64:
        """The least of all nodes: what was merged has no depth."""
        ends = np.cumsum([node.depths_read_back for node in self.each])
        image = np.minimum.reduce([node.depth_image(own) for node, own in zip(
            self.each, np.split(np.asarray(depths, np.int64), ends[:-1]), strict=True)])
        return np.where(self.owned_pixels, image, -1)
