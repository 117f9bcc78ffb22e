"""Lines of a cage of nodes, beside those from slot to slot: connections only."""

from collections.abc import Sequence
from functools import reduce
from itertools import pairwise
from operator import or_
from typing import NamedTuple

from amaranth.hdl import *

from ...golden.specification.configuration import MachineConfiguration
from ..lines_to_all import connect_broadcast, connect_pictures, connect_scan
from ..wires import wires
from .merge_card import MergeCard
from .tree_lines import connect_tree

__all__ = ["Node", "connect_nodes"]


class Node(NamedTuple):
    """The boards of a node."""

    processing_elements: Sequence
    memory_units: Sequence
    merge_card: MergeCard


def connect_nodes(m: Module, configuration: MachineConfiguration, controller, generator,
                  nodes: Sequence[Node]) -> None:
    """Everything between controller, scan generator and ``nodes``, from left to right; where they
    merge on a bus, but for what merges and shows their pictures."""
    cards = [node.merge_card for node in nodes]
    fixed = wires(m, "total_wires")
    fixed.d.comb += [controller.total.eq(cards[0].left.id),
                     controller.nodes.eq(cards[-1].right.node)]
    connect_broadcast(wires(m, "broadcast_wires"), controller.broadcast,
                      [card.broadcast for card in cards])
    for number, node in enumerate(nodes):
        boards = [*node.processing_elements, *node.memory_units]
        fixed.d.comb += [board.total.eq(node.merge_card.left.id) for board in boards]
        connect_broadcast(wires(m, f"node_{number}_broadcast_wires"), node.merge_card.own,
                          [element.broadcast for element in node.processing_elements])
    if configuration.reports_full:
        fixed.d.comb += controller.lists_full.eq(reduce(or_, (card.lists_full for card in cards)))
    if configuration.sends_drawn:
        connect_tree(m, controller, generator, nodes)
    elif configuration.scans_rank:
        _connect_chain(m, controller, generator, nodes)


def _connect_chain(m, controller, generator, nodes):
    """Scan lines through all merge cards, and back to the generator."""
    cards = [node.merge_card for node in nodes]
    units = [unit for node in nodes for unit in node.memory_units]
    connect_pictures(wires(m, "picture_wires"), controller.pictures, units,
                     front=[node.merge_card.scan_left.front for node in nodes
                            for _ in node.memory_units])
    scan = wires(m, "scan_wires")
    first, last = cards[0].scan_left, cards[-1].scan_right
    scan.d.comb += [
        controller.scan_start.eq(generator.start),
        generator.background.eq(controller.background),
        first.fetch.eq(generator.scan.fetch),
        first.show.eq(generator.scan.show),
        first.front.eq(controller.pictures.front),
        first.pixel.eq(generator.first),
        generator.last.eq(last.pixel),
        generator.read_back.eq(controller.read_scan),
        controller.scan_read.eq(generator.read_back_done),
        controller.depths.valid.eq(generator.depths.valid),
        controller.depths.payload.eq(generator.depths.payload),
        generator.depths.ready.eq(controller.depths.ready),
        controller.shown.eq(last.front),
    ]
    for number, node in enumerate(nodes):
        connect_scan(wires(m, f"node_{number}_scan_wires"), node.merge_card.scan,
                     node.memory_units)
    for left, right in pairwise(cards):
        scan.d.comb += [getattr(right.scan_left, name).eq(getattr(left.scan_right, name))
                        for name in ("fetch", "show", "front", "pixel")]
