"""Lines of a cage whose nodes merge in a tree: connections only."""

from collections.abc import Sequence
from functools import reduce
from itertools import pairwise
from operator import and_, or_

from amaranth.hdl import *
from amaranth.lib import wiring

from ..lines_to_all import connect_pictures, connect_scan, connect_senders
from ..wires import wires

__all__ = ["connect_tree"]


def connect_tree(m: Module, controller, generator, nodes: Sequence) -> None:
    """Everything between controller, scan generator and ``nodes`` that is for merging or showing
    the picture: which is that of node 0."""
    cards = [node.merge_card for node in nodes]
    connect_pictures(wires(m, "picture_wires"), controller.pictures,
                     [unit for node in nodes for unit in node.memory_units])
    scan = wires(m, "scan_wires")
    scan.d.comb += [controller.scan_start.eq(generator.start),
                    generator.background.eq(controller.background)]
    connect_scan(scan, generator.scan, nodes[0].memory_units)

    steps = wires(m, "step_wires")
    steps.d.comb += controller.tree.busy.eq(reduce(or_, (card.tree.busy for card in cards)))
    for card in cards:
        steps.d.comb += [card.nodes.eq(controller.nodes), card.tree.start.eq(controller.tree.start),
                         card.tree.step.eq(controller.tree.step)]
    for number, (left, right) in enumerate(pairwise(cards)):
        wiring.connect(wires(m, f"piece_{number}_wires"), right.to_left, left.from_right)
    for number, node in enumerate(nodes):
        part = wires(m, f"node_{number}_merge_wires")
        connect_senders(part, node.merge_card.units, node.memory_units)
        _connect_elements(part, node.merge_card.received, node.processing_elements)


def _connect_elements(part, received, elements):
    """The stream of what a node receives; ready: wired and."""
    part.d.comb += received.ready.eq(
        reduce(and_, (element.merge.ready for element in elements), C(1)))
    for element in elements:
        part.d.comb += [element.merge.valid.eq(received.valid),
                        element.merge.payload.eq(received.payload)]
