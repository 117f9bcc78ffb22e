"""Lines of a cage whose nodes merge on a bus: connections only."""

from collections.abc import Sequence
from functools import reduce
from operator import or_

from amaranth.hdl import *

from ..lines_to_all import connect_pictures, connect_scan, connect_senders
from ..wires import wires

__all__ = ["connect_snoop"]


def connect_snoop(m: Module, controller, generator, nodes: Sequence,
                  frame_units: Sequence) -> None:
    """Everything between controller, scan generator, ``nodes`` and ``frame_units`` that is for
    merging or showing the picture: which is that of the frame units."""
    cards = [node.merge_card for node in nodes]
    connect_pictures(wires(m, "picture_wires"), controller.pictures,
                     [unit for node in nodes for unit in node.memory_units])
    connect_pictures(wires(m, "frame_picture_wires"), controller.frame_pictures, frame_units)
    scan = wires(m, "scan_wires")
    scan.d.comb += [controller.scan_start.eq(generator.start),
                    generator.background.eq(controller.background)]
    connect_scan(scan, generator.scan, frame_units)

    fixed = wires(m, "frame_total_wires")
    frame_total = frame_units[-1].right.id
    fixed.d.comb += controller.frame_units.eq(frame_total)
    for unit in frame_units:
        fixed.d.comb += [unit.total.eq(frame_total), unit.node_total.eq(cards[0].left.id)]

    bus = wires(m, "bus_wires")
    said = Signal.like(Value.cast(cards[0].bus), name="said")
    bus.d.comb += [
        said.eq(reduce(or_, (Value.cast(card.said) for card in cards))),
        *(Value.cast(listener.bus).eq(said) for listener in (*cards, *frame_units)),
        *(card.snoop.start.eq(controller.snoop.start) for card in cards),
        controller.snoop.ended.eq(reduce(or_, (unit.ended for unit in frame_units))),
    ]
    for number, node in enumerate(nodes):
        part = wires(m, f"node_{number}_merge_wires")
        connect_senders(part, node.merge_card.units, node.memory_units)
        part.d.comb += [unit.heard.eq(node.merge_card.heard) for unit in node.memory_units]
