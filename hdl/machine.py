"""The whole machine: cards in slots, and nothing but wires between them."""

from functools import reduce
from operator import and_, or_

from amaranth.hdl import *
from amaranth.lib import stream, wiring
from amaranth.lib.wiring import In, Out

from ..golden import commands
from ..golden.cards import PROCESSING_ELEMENT
from ..golden.configuration import MachineConfiguration
from .central_broadcast_controller import CentralBroadcastController
from .layouts import response_layout
from .memory_unit import MemoryUnit
from .processing_element import ProcessingElement
from .video_scan_generator import VideoPins, VideoScanGenerator

__all__ = ["Machine"]


class Machine(wiring.Component):
    """The card cage of figures 12 and 15: controller left, cards in order, scan generator.

    Only connections: the slots' connectors from left to right, the total units
    back from the right end, broadcast and scan lines to all, and the wired
    answers (ready and done: and; video: or).

    Members
    -------
    commands: In(stream of command words)
    responses: Out(stream of response_layout)
    pins: Out(VideoPins)
    """

    def __init__(self, *, configuration: MachineConfiguration):
        self.configuration = configuration
        self.controller = CentralBroadcastController(configuration=configuration)
        self.scan_generator = VideoScanGenerator(configuration=configuration)
        self.cards = [
            ProcessingElement(configuration=configuration) if card == PROCESSING_ELEMENT
            else MemoryUnit(configuration=configuration)
            for card in configuration.cards
        ]
        super().__init__({
            "commands": In(stream.Signature(commands.command_bits(configuration))),
            "responses": Out(stream.Signature(response_layout())),
            "pins": Out(VideoPins()),
        })

    @property
    def processing_elements(self) -> list[ProcessingElement]:
        return [card for card in self.cards if isinstance(card, ProcessingElement)]

    @property
    def memory_units(self) -> list[MemoryUnit]:
        return [card for card in self.cards if isinstance(card, MemoryUnit)]

    def elaborate(self, platform):
        m = Module()
        m.submodules.controller = controller = self.controller
        m.submodules.scan_generator = generator = self.scan_generator
        for slot, card in enumerate(self.cards):
            kind = "processing_element" if isinstance(card, ProcessingElement) else "memory_unit"
            m.submodules[f"slot_{slot}_{kind}"] = card

        wiring.connect(m, controller.commands, wiring.flipped(self.commands))
        wiring.connect(m, controller.responses, wiring.flipped(self.responses))
        wiring.connect(m, generator.pins, wiring.flipped(self.pins))
        left = controller
        for card in self.cards:
            wiring.connect(m, left.right, card.left)
            left = card
        total = left.right.id
        m.d.comb += [
            controller.total.eq(total),
            controller.scan_start.eq(generator.start),
            controller.broadcast.ready.eq(
                reduce(and_, (pe.broadcast.ready for pe in self.processing_elements), C(1))),
            controller.broadcast.done.eq(
                reduce(and_, (pe.broadcast.done for pe in self.processing_elements), C(1))),
            generator.scan.video.eq(
                reduce(or_, (unit.scan.video for unit in self.memory_units), C(0))),
        ]
        for pe in self.processing_elements:
            m.d.comb += [
                pe.total.eq(total),
                pe.broadcast.strobe.eq(controller.broadcast.strobe),
                pe.broadcast.packet.eq(controller.broadcast.packet),
            ]
        for unit in self.memory_units:
            m.d.comb += [unit.total.eq(total), unit.front.eq(controller.front)]
            m.d.comb += [getattr(unit.scan, name).eq(getattr(generator.scan, name))
                         for name in ("fetch", "fetch_x", "fetch_y", "show_x", "show_y")]
        return m
