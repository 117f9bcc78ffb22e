"""What a memory unit has besides, where nodes merge in a tree."""

from amaranth.hdl import *
from amaranth.lib import memory, wiring
from amaranth.lib.wiring import In

from ...golden.specification.configuration import MachineConfiguration
from ..backplane.connectors import memory_bus_bits
from ..merging.picture_sender import PictureSender
from ..merging.send_lines import SendLines

__all__ = ["SendPart"]


class SendPart:
    """Notes what is written into the unit, and sends it when its node's turn comes.

    A word is read as the processing element reads it.  That gives all of it where the unit has
    one port; where each part has its own, the back colour is read as the scan reads colours:
    only node 0 is shown, and it sends nothing.

    This is no component, but adds its signals to the module of the ``MemoryUnit``: the last ones,
    since it takes the RAM from others.

    Members
    -------
    merge: In(SendLines)
    """

    def __init__(self, *, configuration: MachineConfiguration):
        self.configuration = configuration
        self.sender = PictureSender(words=configuration.words, depth_bits=configuration.rank_bits)

    @property
    def members(self) -> dict[str, wiring.Member]:
        """What the unit has to be told, and tells."""
        return {"merge": In(SendLines(**memory_bus_bits(self.configuration)))}

    @property
    def storages(self) -> list[memory.Memory]:
        return self.sender.map.storages

    def add_to(self, m: Module, unit: wiring.PureInterface, current: Value, depth: Value):
        """Put it into ``m``, the module of ``unit``; ``depth``: what was just read, ``current``:
        it is of this frame."""
        m.submodules.sender = sender = self.sender
        access, pictures, lines = unit.memory.access, unit.pictures, unit.merge
        with m.If(sender.reads.valid):
            m.d.comb += [access.read.eq(1), access.read_address.eq(sender.reads.payload)]
            if self.configuration.memory_ports == 2:
                m.d.comb += [access.scan.eq(1), access.scan_address.eq(sender.reads.payload)]
        m.d.comb += [
            sender.write.eq(access.write & ~access.write_busy),
            sender.write_address.eq(access.write_address),
            sender.reads.ready.eq(~access.read_busy),
            sender.current.eq(current),
            sender.depth.eq(depth),
            sender.color.eq(Mux(pictures.front, access.color[0].value, access.color[1].value)),

            lines.settled.eq(sender.settled),
            *sender.answers(lines, unit.left.id),
        ]
