"""The whole machine: cards in slots, and nothing but wires between them."""

from functools import reduce
from operator import and_, or_

from amaranth.hdl import *
from amaranth.lib import stream, wiring
from amaranth.lib.wiring import In, Out

from ..golden.specification import commands
from ..golden.specification.card_order import CARD_NAMES, MEMORY_UNIT, PROCESSING_ELEMENT
from ..golden.specification.configuration import MachineConfiguration
from .backplane.words import response_layout
from .controller.central_broadcast_controller import CentralBroadcastController
from .memory_unit.memory_unit import MemoryUnit
from .observer import MachineActivity, activity_layout
from .processing_element.processing_element import ProcessingElement
from .video.video_scan_generator import VideoPins, VideoScanGenerator
from .wires import wires

__all__ = ["BOARDS", "CARDS", "Machine"]

#: Every kind of board, by the name of its Verilog module.
BOARDS: dict[str, type[wiring.Component]] = {
    "central_broadcast_controller": CentralBroadcastController,
    "processing_element": ProcessingElement,
    "memory_unit": MemoryUnit,
    "video_scan_generator": VideoScanGenerator,
}

#: The boards that slots can hold, by their letter in the card order.
CARDS = {letter: name.replace(" ", "_") for letter, name in CARD_NAMES.items()}


class Machine(wiring.Component):
    """The card cage of figures 12 and 15: controller left, cards in order, scan generator.

    Only connections: the slots' connectors from left to right, the total units
    back from the right end, broadcast, picture and scan lines to all, and the
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
        self.cards = [self.make_board(CARDS[letter]) for letter in configuration.cards]
        super().__init__({
            "commands": In(stream.Signature(commands.command_bits(configuration))),
            "responses": Out(stream.Signature(response_layout())),
            "pins": Out(VideoPins()),
            **({"activity": Out(activity_layout(configuration.processing_elements))}
               if configuration.observe else {}),
        })

    def make_board(self, name: str) -> wiring.Component:
        """A new board of the kind ``name``, a key of ``BOARDS``; called once for each that the
        machine has, the controller first, the scan generator next, then slot by slot.

        A subclass overrides it to put other boards in the same places.  They must have the
        signature that ``BOARDS[name]`` has with this machine's configuration.
        """
        return BOARDS[name](configuration=self.configuration)

    def _cards_of(self, letter):
        return [card for card, place in zip(self.cards, self.configuration.cards, strict=True)
                if place == letter]

    @property
    def processing_elements(self) -> list[ProcessingElement]:
        return self._cards_of(PROCESSING_ELEMENT)

    @property
    def memory_units(self) -> list[MemoryUnit]:
        return self._cards_of(MEMORY_UNIT)

    def elaborate(self, platform):
        m = Module()
        m.submodules.controller = controller = self.controller
        m.submodules.scan_generator = generator = self.scan_generator
        for slot, (card, letter) in enumerate(zip(self.cards, self.configuration.cards,
                                                  strict=True)):
            m.submodules[f"slot_{slot}_{CARDS[letter]}"] = card

        wiring.connect(m, controller.commands, wiring.flipped(self.commands))
        pins = wires(m, "pin_wires")
        wiring.connect(pins, controller.responses, wiring.flipped(self.responses))
        wiring.connect(pins, generator.pins, wiring.flipped(self.pins))
        left = controller
        for slot, card in enumerate(self.cards):
            wiring.connect(wires(m, f"slot_{slot}_wires"), left.right, card.left)
            left = card
        self._connect_lines_to_all(m, total=left.right.id)
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
        broadcast = wires(m, "broadcast_wires")
        scan = wires(m, "scan_wires")
        fixed.d.comb += controller.total.eq(total)
        fixed.d.comb += [card.total.eq(total) for card in self.cards
                         if "total" in card.signature.members]

        elements, units = self.processing_elements, self.memory_units
        broadcast.d.comb += [
            controller.broadcast.ready.eq(
                reduce(and_, (element.broadcast.ready for element in elements), C(1))),
            controller.broadcast.done.eq(
                reduce(and_, (element.broadcast.done for element in elements), C(1))),
        ]
        for element in elements:
            broadcast.d.comb += [
                element.broadcast.strobe.eq(controller.broadcast.strobe),
                element.broadcast.packet.eq(controller.broadcast.packet),
            ]

        pictures = wires(m, "picture_wires")
        pictures.d.comb += controller.pictures.swept.eq(
            reduce(and_, (unit.pictures.swept for unit in units), C(1)))
        for unit in units:
            pictures.d.comb += [
                getattr(unit.pictures, name).eq(getattr(controller.pictures, name))
                for name in ("front", "depth_tag", "initialise", "sweep")]
            pictures.d.comb += [tag.eq(source) for tag, source in zip(
                unit.pictures.color_tag, controller.pictures.color_tag, strict=True)]
        scan.d.comb += [
            controller.scan_start.eq(generator.start),
            generator.background.eq(controller.background),
            generator.scan.video.eq(reduce(or_, (unit.scan.video for unit in units), C(0))),
            generator.scan.drawn.eq(reduce(or_, (unit.scan.drawn for unit in units), C(0))),
        ]
        for unit in units:
            scan.d.comb += [unit.scan.fetch.eq(generator.scan.fetch),
                            unit.scan.show.eq(generator.scan.show)]
