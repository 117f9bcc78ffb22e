"""Cages of nodes: each draws a share of the triangles into a picture of its own, which merge cards
end."""

from __future__ import annotations

from dataclasses import replace
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..specification.commands import Fault
from ..specification.fields.making import NO_OBJECTS
from .host_broadcast import HostBroadcast
from .organisation import Bool, Coordinate, Domain, ElementBlock, Int64, Organisation, Resolution


class Nodes(Organisation):
    """Nodes side by side, each a cage of 1979 by itself, that merge cards end (Blazek 1991,
    chapter V; Cox and Hanrahan 1993, sections 1 to 5)."""

    merges = True

    @cached_property
    def each(self) -> tuple[HostBroadcast, ...]:
        alone: dict[str, Any] = {"allow_orphans": True, "packet": 1, "order_bits": 0,
                                 "list_words": 0, "maximum_nodes": 0, **NO_OBJECTS}
        return tuple(HostBroadcast(replace(self.configuration, cards=cards, **alone))
                     for cards in self.configuration.node_cards)

    @property
    def resolution(self) -> Resolution:
        return self.each[0].resolution

    @property
    def fault(self) -> Fault | None:
        if self.shares_differ or any(node.refused for node in self.each):
            return Fault.UNITS_UNSUPPORTED
        if len(set(self.node_units)) > 1:
            return Fault.NODES_DIFFER
        return None

    @cached_property
    def domains(self) -> tuple[Domain, ...]:
        return tuple(domain._replace(node=number) for number, node in enumerate(self.each)
                     for domain in node.domains)

    @property
    def node_units(self) -> tuple[int, ...]:
        return tuple(node.units for node in self.each)

    @property
    def words(self) -> int:
        return self.each[0].words

    def unit(self, x: Coordinate, y: Coordinate) -> Coordinate:
        return self.each[0].unit(x, y)

    def word(self, x: Coordinate, y: Coordinate) -> Coordinate:
        return self.each[0].word(x, y)

    def pixel(self, unit: Coordinate, word: Coordinate) -> tuple[Coordinate, Coordinate]:
        return self.each[0].pixel(unit, word)

    @property
    def blocks(self) -> tuple[ElementBlock, ...]:
        found: list[ElementBlock] = []
        elements = 0
        for node in self.each:
            found += [block._replace(element=block.element + elements) for block in node.blocks]
            elements += len(node.domains)
        return tuple(found)

    @property
    def scan_tile(self) -> Int64:
        return self.each[0].scan_tile

    @property
    def scan_group(self) -> int:
        return self.each[0].scan_group

    @property
    def scan_reads_per_line(self) -> int:
        return self.each[0].scan_reads_per_line

    @property
    def owned_pixels(self) -> Bool:
        """Pixels that in every node some processing element draws."""
        return np.asarray(np.logical_and.reduce([node.owned_pixels for node in self.each]))


class ChainedNodes(Nodes):
    """While the screen is scanned each merge card passes on the nearer of its node's pixel and
    the one from its left (PixelFlow, in Cox and Hanrahan 1993, section 5)."""

    name = "chain of nodes"

    def is_scanned(self, node: int) -> bool:
        return True

    @property
    def depths_read_back(self) -> int:
        """One for each pixel of the video output, in the order of the scan."""
        return self.configuration.width * self.configuration.height

    def depth_image(self, depths: Any) -> Int64:
        width, height, x_shift, y_shift = self.resolution
        video = np.asarray(depths, np.int64).reshape(self.configuration.height,
                                                     self.configuration.width)
        image = video[::1 << y_shift, ::1 << x_shift].copy()
        assert image.shape == (height, width)
        image[~self.owned_pixels] = -1
        return image


class TreeOfNodes(Nodes):
    """When drawing is done node k receives what node k + 2**s has drawn, step by step, until node
    0 has the picture (Blazek 1991, chapter V, algorithm 4 and figure 10)."""

    name = "tree of nodes"
    merges_after_drawing = True

    @property
    def merge_steps(self) -> int:
        return (self.nodes - 1).bit_length()

    def is_scanned(self, node: int) -> bool:
        return node == 0

    @property
    def depths_read_back(self) -> int:
        return self.each[0].depths_read_back

    def depth_image(self, depths: Any) -> NDArray[np.int64]:
        image = self.each[0].depth_image(depths)
        image[~self.owned_pixels] = -1
        return image
