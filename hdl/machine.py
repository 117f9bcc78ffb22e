"""The whole machine: cards in slots, and nothing but wires between them."""

from amaranth.hdl import *
from amaranth.lib import stream, wiring
from amaranth.lib.wiring import In, Out

from ..golden.specification import commands
from ..golden.specification.card_order import (
    CARD_MODULES,
    FRAME_UNIT,
    MEMORY_UNIT,
    MERGING_CARDS,
    PROCESSING_ELEMENT,
)
from ..golden.specification.configuration import MachineConfiguration
from .backplane.words import response_layout
from .controller.central_broadcast_controller import CentralBroadcastController
from .direct.direct_element import DirectElement
from .direct.direct_lines import connect_direct
from .direct.direct_merge import DirectMerge
from .forwarding.forwarding_element import ForwardingElement, connect_forwarding
from .lines_to_all import connect_broadcast, connect_pictures, connect_regions, connect_scan
from .memory_unit.memory_unit import MemoryUnit
from .nodes.chain_merge import ChainMerge
from .nodes.merge_card import MergeCard
from .nodes.node_lines import Node, connect_nodes
from .nodes.tree_merge import TreeMerge
from .observer import MachineActivity, activity_layout
from .processing_element.processing_element import ProcessingElement
from .snooping.frame_unit import FrameUnit
from .snooping.snoop_lines import connect_snoop
from .snooping.snoop_merge import SnoopMerge
from .video.video_scan_generator import VideoPins, VideoScanGenerator
from .wires import wires

__all__ = ["BOARDS", "Machine", "boards_of"]

#: Every kind of board, by the name of its Verilog module.
BOARDS: dict[str, type[wiring.Component]] = {
    "central_broadcast_controller": CentralBroadcastController,
    "processing_element": ProcessingElement,
    "memory_unit": MemoryUnit,
    "video_scan_generator": VideoScanGenerator,
    "chain_merge": ChainMerge,
    "tree_merge": TreeMerge,
    "snoop_merge": SnoopMerge,
    "direct_merge": DirectMerge,
    "frame_unit": FrameUnit,
}


def boards_of(configuration: MachineConfiguration) -> dict[str, type[wiring.Component]]:
    """The kinds of boards that a machine has."""
    others = {CARD_MODULES[letter] for letter in MERGING_CARDS if letter not in configuration.cards}
    boards = {name: board for name, board in BOARDS.items() if name not in others}
    if configuration.merges_directly:
        boards["processing_element"] = DirectElement
    if configuration.forwards_objects:
        boards["processing_element"] = ForwardingElement
    return boards


class Machine(wiring.Component):
    """The card cage of figures 12 and 15: controller left, cards in order, scan generator.

    Only connections: the slots' connectors from left to right, the total units
    back from the right end, broadcast, picture, region and scan lines to all, and the
    wired answers (ready, done and swept: and; video: or).

    Members
    -------
    commands: In(stream of command words)
    responses: Out(stream of response_layout)
    pins: Out(VideoPins)
    activity: Out(activity_layout)
        What each processing element does in this clock; only where the configuration says
        ``observe``.

    >>> import amaranth.sim, cardcage
    >>> configuration = cardcage.MachineConfiguration(cards="PMM", width=16, height=16)
    >>> machine = cardcage.Machine(configuration=configuration)
    >>> len(machine.processing_elements), len(machine.memory_units)
    (1, 2)
    >>> simulator = amaranth.sim.Simulator(machine)
    """

    def __init__(self, *, configuration: MachineConfiguration):
        self.configuration = configuration
        self.controller = self.make_board("central_broadcast_controller")
        self.scan_generator = self.make_board("video_scan_generator")
        self.cards = [self.make_board(CARD_MODULES[letter]) for letter in configuration.cards]
        super().__init__({
            "commands": In(stream.Signature(commands.command_bits(configuration))),
            "responses": Out(stream.Signature(response_layout())),
            "pins": Out(VideoPins()),
            **({"activity": Out(activity_layout(configuration.processing_elements))}
               if configuration.observe else {}),
        })

    def make_board(self, name: str) -> wiring.Component:
        """A new board of the kind ``name``, a key of ``boards_of``; called once for each that the
        machine has, the controller first, the scan generator next, then slot by slot.

        A subclass overrides it to put other boards in the same places.  They must have the
        signature that the board of that name has with this machine's configuration.
        """
        return boards_of(self.configuration)[name](configuration=self.configuration)

    def _cards_of(self, letter):
        return [card for card, place in zip(self.cards, self.configuration.cards, strict=True)
                if place == letter]

    @property
    def processing_elements(self) -> list[ProcessingElement]:
        return self._cards_of(PROCESSING_ELEMENT)

    @property
    def memory_units(self) -> list[MemoryUnit]:
        return self._cards_of(MEMORY_UNIT)

    @property
    def frame_units(self) -> list[FrameUnit]:
        return self._cards_of(FRAME_UNIT)

    @property
    def merge_cards(self) -> list[MergeCard]:
        return self._cards_of(self.configuration.merge)

    @property
    def nodes(self) -> list[Node]:
        """The cards of each node that a merge card ends."""
        found, elements, units = [], [], []
        for card, letter in zip(self.cards, self.configuration.cards, strict=True):
            if letter == self.configuration.merge:
                found.append(Node(elements, units, card))
                elements, units = [], []
            else:
                (elements if letter == PROCESSING_ELEMENT else units).append(card)
        return found

    @property
    def storages(self):
        """Every RAM whose contents outlast a frame: of memory and frame units, of lists and
        meshes."""
        in_elements = self.configuration.merges_directly or self.configuration.forwards_objects
        lists = self.processing_elements if in_elements else self.merge_cards
        boards = [*self.memory_units, *self.frame_units, *lists, self.controller]
        return [storage for board in boards for storage in board.storages]

    def elaborate(self, platform):
        m = Module()
        m.submodules.controller = controller = self.controller
        m.submodules.scan_generator = generator = self.scan_generator
        for slot, (card, letter) in enumerate(zip(self.cards, self.configuration.cards,
                                                  strict=True)):
            m.submodules[f"slot_{slot}_{CARD_MODULES[letter]}"] = card

        wiring.connect(m, controller.commands, wiring.flipped(self.commands))
        pins = wires(m, "pin_wires")
        wiring.connect(pins, controller.responses, wiring.flipped(self.responses))
        wiring.connect(pins, generator.pins, wiring.flipped(self.pins))
        left = controller
        for slot, card in enumerate(self.cards):
            wiring.connect(wires(m, f"slot_{slot}_wires"), left.right, card.left)
            left = card
        if self.configuration.merge is None:
            self._connect_lines_to_all(m, total=left.right.id)
        elif self.configuration.merges_directly:
            connect_direct(m, self.configuration, controller, generator, self.processing_elements,
                           self.merge_cards[0], self.memory_units)
        else:
            connect_nodes(m, self.configuration, controller, generator, self.nodes)
            if self.configuration.snoops:
                connect_snoop(m, controller, generator, self.nodes, self.frame_units)
        if self.configuration.observe:
            self._observe(m)
        return m

    def _observe(self, m):
        elements = self.processing_elements
        m.submodules.observer = observer = MachineActivity(elements=len(elements))
        m.d.comb += [
            observer.blocked.eq(~self.controller.broadcast.ready),
            observer.more.eq(self.controller.more),
            self.activity.eq(observer.activity),
        ]
        m.d.comb += [said.eq(element.activity)
                     for said, element in zip(observer.elements, elements, strict=True)]

    def _connect_lines_to_all(self, m, total):
        controller, generator = self.controller, self.scan_generator
        fixed = wires(m, "total_wires")
        fixed.d.comb += controller.total.eq(total)
        fixed.d.comb += [card.total.eq(total) for card in self.cards
                         if "total" in card.signature.members]

        broadcast = wires(m, "broadcast_wires")
        scan = wires(m, "scan_wires")
        connect_broadcast(broadcast, controller.broadcast,
                          [element.broadcast for element in self.processing_elements])
        connect_pictures(wires(m, "picture_wires"), controller.pictures, self.memory_units)
        scan.d.comb += controller.scan_start.eq(generator.start)
        scan.d.comb += generator.background.eq(controller.background)
        connect_scan(scan, generator.scan, self.memory_units)
        if self.configuration.regions is not None:
            regions = wires(m, "region_wires")
            connect_regions(regions, controller.regions,
                            [element.regions for element in self.processing_elements])
            connect_regions(regions, controller.regions, [generator.regions],
                            table=controller.shown_table)
        if self.configuration.forwards_objects:
            connect_forwarding(m, self.processing_elements)
            fixed.d.comb += controller.lists_full.eq(
                Cat(element.lists_full for element in self.processing_elements).any())
