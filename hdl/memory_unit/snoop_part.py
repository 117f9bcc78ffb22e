"""What a memory unit has besides, where nodes merge on a bus."""

from amaranth.hdl import *
from amaranth.lib import data, memory, wiring
from amaranth.lib.wiring import In

from ...golden.specification.configuration import MachineConfiguration
from ..backplane.connectors import memory_bus_bits
from ..merging.picture_sender import PictureSender
from ..merging.send_lines import SendLines
from ..merging.snoop_words import heard_pixel_layout
from .word_parts import pixel_layout

__all__ = ["SnoopPart"]


class SnoopPart:
    """Notes what is written into the back picture; of the front one it deletes what its node hears
    a pixel for that is as near or nearer, and sends what is left when its node's turn comes.

    The nodes that are heard have lower numbers, so theirs stays of two that are as near.  A word
    that is not of the front picture's frame was marked by a frame that nobody ended: it is not
    sent, whether it is deleted or not.

    The front picture is nobody else's: both read it as the scan reads where nodes are scanned.
    Where the unit has one port drawing waits for them.

    This is no component, but adds its signals to the module of the ``MemoryUnit``.

    Latency: ``latency`` clocks from a pixel heard to its deletion; until then, and until the map of
    what was drawn knows of it, the unit is not ``settled``.  Throughput: a pixel a clock, heard or
    sent.

    Members
    -------
    merge: In(SendLines)
    heard: In(heard_pixel_layout)
        What the node hears; not while it sends.

    Cox & Hanrahan 1993, sections 7 and 8.
    """

    latency = 2

    def __init__(self, *, configuration: MachineConfiguration):
        self.configuration = configuration
        self.sender = PictureSender(words=configuration.words, depth_bits=configuration.rank_bits,
                                    two_pictures=True)

    @property
    def members(self) -> dict[str, wiring.Member]:
        """What the unit has to be told, and tells."""
        bits = memory_bus_bits(self.configuration)
        return {"merge": In(SendLines(**bits)), "heard": In(heard_pixel_layout(**bits))}

    @property
    def storages(self) -> list[memory.Memory]:
        return self.sender.map.storages

    def add_to(self, m: Module, unit: wiring.PureInterface, current: Value):
        """Put it into ``m``, the module of ``unit``; ``current`` of both pictures: what was just
        read is of its frame."""
        m.submodules.sender = sender = self.sender
        access, front, lines = unit.memory.access, unit.pictures.front, unit.merge
        number, heard = unit.left.id, unit.heard
        pixel = data.View(pixel_layout(self.configuration.rank_bits),
                          Mux(front, access.pixel[1].value, access.pixel[0].value))

        here, compares = Signal(), Signal()
        depth, address = Signal.like(heard.depth), Signal.like(heard.address)
        m.d.comb += [
            here.eq(heard.valid & (heard.unit == number)),
            access.scan.eq(here | sender.reads.valid),
            access.scan_address.eq(Mux(here, heard.address, sender.reads.payload)),
            sender.reads.ready.eq(~here),
        ]
        m.d.sync += [
            compares.eq(here),
            depth.eq(heard.depth),
            address.eq(heard.address),
            sender.hidden.eq(compares & (depth <= pixel.depth)),
            sender.hidden_address.eq(address),
        ]

        m.d.comb += [
            sender.front.eq(front),
            sender.write.eq(access.write & ~access.write_busy),
            sender.write_address.eq(access.write_address),
            sender.current.eq(Mux(front, current[1], current[0])),
            sender.depth.eq(pixel.depth),
            sender.color.eq(pixel.color),

            lines.settled.eq(sender.settled & ~compares & ~sender.hidden),
            *sender.answers(lines, number),
        ]
