"""Lines of a cage that merges directly, beside those from slot to slot: connections only."""

from collections.abc import Sequence
from functools import reduce
from operator import or_

from amaranth.hdl import *
from amaranth.lib import wiring

from ...golden.specification.configuration import MachineConfiguration
from ..lines_to_all import connect_broadcast, connect_pictures, connect_scan
from ..memory_unit.memory_unit import MemoryUnit
from ..wires import wires
from .direct_element import DirectElement
from .direct_merge import DirectMerge

__all__ = ["connect_direct"]


def connect_direct(m: Module, configuration: MachineConfiguration, controller, generator,
                   elements: Sequence[DirectElement], merge: DirectMerge,
                   units: Sequence[MemoryUnit]) -> None:
    """Everything between controller, scan generator and the cards, from left to right."""
    fixed = wires(m, "total_wires")
    fixed.d.comb += [board.total.eq(units[-1].right.id)
                     for board in (controller, *elements, merge, *units)]
    fixed.d.comb += controller.nodes.eq(merge.left.node)
    connect_broadcast(wires(m, "broadcast_wires"), controller.broadcast,
                      [board.broadcast for board in (*elements, merge)])
    connect_pictures(wires(m, "picture_wires"), controller.pictures, units)
    scan = wires(m, "scan_wires")
    scan.d.comb += [controller.scan_start.eq(generator.start),
                    generator.background.eq(controller.background)]
    connect_scan(scan, generator.scan, units)
    if configuration.list_words:
        fixed.d.comb += controller.lists_full.eq(
            reduce(or_, (element.lists_full for element in elements)))
    for number, element in enumerate(elements):
        wiring.connect(wires(m, f"element_{number}_wires"), element.fragments,
                       merge.elements[number])
    for number, unit in enumerate(units):
        wiring.connect(wires(m, f"unit_{number}_wires"), merge.units[number], unit.direct)
