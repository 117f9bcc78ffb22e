"""The boards and parts whose area and clock rate are measured, each as one component."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import Any

from amaranth.lib import wiring

from ...golden.planning.on_screen_widths import on_screen_widths
from ...golden.specification.card_order import (
    CHAIN_MERGE,
    FRAME_UNIT,
    SNOOP_MERGE,
    TREE_MERGE,
)
from ...golden.specification.configuration import MachineConfiguration
from ...hdl.memory_unit.memory_unit import MemoryUnit
from ...hdl.snooping.frame_unit import FrameUnit
from ..machine_options import SETUPS
from ..speed.cases import DEPTH_BITS, SUB_BITS
from .domain import Domain
from .outside_ram import OutsideRam
from .place_and_route import LogicMapping, Part


def domain(configuration: MachineConfiguration) -> wiring.Component:
    """A processing element and its memory units, their RAM outside."""
    boards = Domain(configuration=configuration)
    storages = [storage for unit in boards.units for storage in unit.memory.storages]
    return OutsideRam(component=boards, storages=storages)


def memory_unit(configuration: MachineConfiguration) -> wiring.Component:
    """A memory unit, its RAM outside."""
    unit = MemoryUnit(configuration=configuration)
    return OutsideRam(component=unit, storages=unit.memory.storages)


def frame_unit(configuration: MachineConfiguration) -> wiring.Component:
    """A frame unit, its RAM outside."""
    unit = FrameUnit(configuration=configuration)
    return OutsideRam(component=unit, storages=unit.storages)


@dataclass(frozen=True)
class Board:
    """A row of the table.

    ``title``    what the table calls it
    ``name``     of its Verilog module
    ``build``    as of ``Part``
    ``changes``  fields of the configuration in which it differs from the rest
    ``mapping``  as of ``Part``
    ``merge``    the card that ends nodes of the cards, which there are two of; none where empty
    ``cage``     of a board that is of no node of the cards: all cards of the machine
    """

    title: str
    name: str
    build: Callable[[MachineConfiguration], wiring.Component] | None = None
    changes: Mapping[str, Any] = field(default_factory=dict)
    mapping: LogicMapping = "area"
    merge: str = ""
    cage: str = ""

    def part(self, cards: str, width: int, height: int) -> Part:
        """The board in a machine that is exact for any triangle on the screen.  Raises
        ``InputError``."""
        machine: dict[str, Any] = {"sub_bits": SUB_BITS, "depth_bits": DEPTH_BITS,
                                   "shading": "flat", "memory_ports": 2} | dict(self.changes)
        if self.merge or self.cage:
            machine["packet"] = "contiguous"  # no rounds beside the depths
        frame_units = 2 * FRAME_UNIT if self.merge == SNOOP_MERGE else ""
        configuration = MachineConfiguration(
            cards=self.cage or (f"2x({cards}{self.merge}){frame_units}" if self.merge else cards),
            width=width, height=height, **machine, **on_screen_widths(width, height, SUB_BITS))
        return Part(configuration, self.name, self.build, self.mapping)


#: Direct merges grow with the product of elements and units; of this one the parts are measured.
DIRECT = "4x(P)D4x(M)"

#: Of 128 regions, dealt out to sixteen elements.
REGIONS = "16x(PMM)"

#: The rows, by the names that ``--boards`` takes.
BOARDS = {
    "element": Board("processing element, flat", "processing_element"),
    "domain": Board("processing element, memory units, flat", "domain", domain),
    "domain-gouraud": Board("processing element, memory units, Gouraud", "domain", domain,
                            {"shading": "gouraud"}),
    "unit-1-port": Board("memory unit, 1 port", "memory_unit", memory_unit, {"memory_ports": 1}),
    "unit-2-ports": Board("memory unit, 2 ports", "memory_unit", memory_unit),
    "unit-of-chain": Board("memory unit, 2 ports, two depths", "memory_unit", memory_unit,
                           merge=CHAIN_MERGE),
    "unit-of-tree": Board("memory unit, 2 ports, sends", "memory_unit", memory_unit,
                          merge=TREE_MERGE),
    "unit-of-snoop": Board("memory unit, 2 ports, two pictures, sends", "memory_unit", memory_unit,
                           merge=SNOOP_MERGE),
    "chain-merge": Board("chain merge", "chain_merge", merge=CHAIN_MERGE),
    "tree-merge": Board("tree merge", "tree_merge", merge=TREE_MERGE),
    "snoop-merge": Board("snoop merge", "snoop_merge", merge=SNOOP_MERGE),
    "frame-unit": Board("frame unit", "frame_unit", frame_unit, merge=SNOOP_MERGE),
    "element-of-direct": Board("direct element, flat, 4x4", "direct_element", cage=DIRECT),
    "unit-of-direct": Board("memory unit, 2 ports, own depth test, 4x4", "memory_unit",
                            memory_unit, cage=DIRECT),
    "direct-merge": Board("direct merge 4x4, 4 for each unit", "direct_merge", mapping="plain",
                          cage=DIRECT),
    "direct-merge-2": Board("direct merge 4x4, 2 for each unit", "direct_merge",
                            changes={"queue": 2}, mapping="plain", cage=DIRECT),
    "direct-merge-element": Board("direct merge 4x4, a queue an element", "direct_merge",
                                  changes={"queue": "element"}, mapping="plain", cage=DIRECT),
    "setup-fast": Board("triangle set-up, fast", "triangle_setup", changes=SETUPS["fast"],
                        mapping="plain"),
    "setup-small": Board("triangle set-up, small", "triangle_setup", changes=SETUPS["small"]),
    "element-of-regions": Board("processing element, flat, 128 regions, 16 elements",
                                "processing_element", changes={"regions": (16, 8)},
                                mapping="plain", cage=REGIONS),
    "balancer": Board("balancer, 128 regions, 16 elements", "balancer",
                      changes={"regions": (16, 8), "balancer": "hardware"}, cage=REGIONS),
}
