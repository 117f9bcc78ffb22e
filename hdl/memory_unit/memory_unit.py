"""A memory unit card: a share of the pixels, numbered by the backplane."""

from amaranth.hdl import *
from amaranth.lib import data, memory, wiring
from amaranth.lib.wiring import In, Out

from ...golden.specification.configuration import MachineConfiguration
from ..backplane.connectors import Connector, PictureLines
from ..backplane.id_increment import IdIncrement
from ..wires import wires
from .memory_access import part_answer
from .one_port_memory import OnePortMemory
from .own_depth_test import OwnDepthTest
from .scan_part import ScanPart
from .send_part import SendPart
from .snoop_part import SnoopPart
from .sweep_part import add_sweep
from .two_port_memory import TwoPortMemory
from .word_parts import pixel_layout, word_parts

__all__ = ["MemoryUnit"]


class MemoryUnit(wiring.Component):
    """Depth, front and back colour of the pixels that fall to its number (figures 6 to 11).

    Its number and the total come from the backplane alone.  With one port
    (``memory_ports``) each clock serves the scan generator, else a write of its
    processing element, else a read; whoever waits sees ``busy``.  With two nobody
    ever waits.  The scan's colour goes into an output register, so the processing
    element has the port in the meantime; while the scan shows a pixel of this unit it
    goes on to the registers that drive the video bus (``ScanPart``).

    Each part of a word (``word_parts``) has a tag beside it.  A part whose tag is not the current
    one reads as background: depth 2^d - 1, and the video bus is told that nothing has
    been drawn there.  A new frame is a new tag, so no word is written for it; clocks in which
    nobody asks for anything are used to take old tags out (``TagSweep``).

    Latency: a scan fetch is on the video bus four clocks later; read data come
    one clock after the read.  Throughput: one access a clock, of whichever kind;
    with two ports a scan fetch, a read and a write.  Scan reads per line: at most
    ``Interlace.scan_reads``.

    Members
    -------
    left: In(Connector), right: Out(Connector)
        The neighbouring slots; memory bus and responses pass through.
    total: In(id_bits)
        Number of memory units in the cage.
    scan: In(ScanLines)
        Not where frame units are scanned.
    pictures: In(PictureLines)
    merge: In(SendLines)
        Only where nodes merge in a tree (``SendPart``) or on a bus (``SnoopPart``).
    heard: In(heard_pixel_layout)
        Only where nodes merge on a bus.
    direct: In(FragmentLines)
        Only where processing elements keep no pixels (``OwnDepthTest``).
    """

    def __init__(self, *, configuration: MachineConfiguration):
        self.configuration = configuration
        self._parts = word_parts(configuration)
        kind = {1: OnePortMemory, 2: TwoPortMemory}[configuration.memory_ports]
        self.memory: OnePortMemory | TwoPortMemory = kind(
            words=configuration.words, depth_bits=configuration.rank_bits,
            tag_bits=configuration.tag_bits, parts=self._parts)
        self._scan = None if configuration.snoops else ScanPart(configuration=configuration)
        #: What the unit does besides in a cage of that kind, if anything.
        self._besides: SendPart | SnoopPart | OwnDepthTest | None = None
        if configuration.sends_drawn:
            self._besides = SendPart(configuration=configuration)
        elif configuration.snoops:
            self._besides = SnoopPart(configuration=configuration)
        elif configuration.merges_directly:
            self._besides = OwnDepthTest(configuration=configuration)
        super().__init__({
            "left": In(Connector(configuration)),
            "right": Out(Connector(configuration)),
            "total": In(configuration.id_bits),
            **({} if self._scan is None else self._scan.members),
            "pictures": In(PictureLines(configuration)),
            **({} if self._besides is None else self._besides.members),
        })

    @property
    def storages(self) -> list[memory.Memory]:
        """The RAM of the words, and that which says which of them were drawn."""
        drawn = [] if self._besides is None else self._besides.storages
        return [*self.memory.storages, *drawn]

    def elaborate(self, platform):
        m = Module()
        m.submodules.memory = self.memory
        m.submodules.increment = increment = IdIncrement(bits=self.configuration.id_bits)
        number = self.left.id
        m.d.comb += [increment.left.eq(number), self.right.id.eq(increment.right)]
        if self.configuration.node_bits:
            m.d.comb += self.right.node.eq(self.left.node)

        # The parts of the word just read that are of this frame.
        current = Signal(len(self._parts))
        m.d.comb += current.eq(Cat(part_answer(self.memory.access, part).tag == self._tag(part)
                                   for part in self._parts))
        of_pictures = [current[place] for place, part in enumerate(self._parts)
                       if part.picture is not None]
        if self._scan is not None:
            self._scan.add_to(m, self, number, of_pictures, fetch=self.scan.fetch,
                              show=self.scan.show)
        self._serve(m, number, current)
        add_sweep(m, self, words=self.configuration.words, parts=self._parts, current=current)
        if isinstance(self._besides, SnoopPart):
            self._besides.add_to(m, self, of_pictures)
        elif self._besides is not None:
            self._besides.add_to(m, self, *self._depth_read(current))

        wiring.connect(wires(m, "response_wires"), wiring.flipped(self.left.response),
                       wiring.flipped(self.right.response))
        return m

    def _tag(self, part):
        """The current tag of a part."""
        if part.picture is None:
            return self.pictures.depth_tag
        return self.pictures.color_tag[part.picture]

    def _serve(self, m, number, current):
        """What the processing element asks for, and its answer; ``current`` of all parts."""
        bus, onward = self.left.lines, self.right.lines
        write, read = bus.write, bus.read
        access, pictures = self.memory.access, self.pictures
        scanned = access.scan if self.configuration.memory_ports == 1 else C(0)
        two_depths = self.configuration.keeps_two_depths
        written = self._pixel_in(write) if two_depths else self._parts_in(write)
        valid, value = self._depth_read(current)
        write_here = Signal()
        read_here = Signal()
        answered = Signal()
        answer = Signal(self.configuration.rank_bits)
        wires(m, "line_wires").d.comb += [onward.write.eq(write), onward.read.eq(read)]
        m.d.comb += [
            write_here.eq(write.valid & (write.unit == number)),
            access.write.eq(write_here),
            access.back.eq(~pictures.front),
            access.write_address.eq(write.address),
            *written,
            bus.write_busy.eq(onward.write_busy | (write_here & access.write_busy)),
            bus.scanned.eq(onward.scanned | Mux(scanned, Mux(number[0], 2, 1), 0)),

            read_here.eq(read.valid & (read.unit == number)),
            access.read.eq(read_here),
            access.read_address.eq(read.address),
            bus.read_busy.eq(onward.read_busy | (read_here & access.read_busy)),
            answer.eq(Mux(valid, value, self.configuration.rank_background)),
            bus.read_data.eq(onward.read_data | Mux(answered, answer, 0)),
        ]
        m.d.sync += answered.eq(read_here & ~access.read_busy)

    def _parts_in(self, write):
        """What is written: depth and back colour."""
        access, pictures = self.memory.access, self.pictures
        return [
            access.depth_in.value.eq(write.depth),
            access.depth_in.tag.eq(pictures.depth_tag),
            access.color_in.value.eq(write.color),
            access.color_in.tag.eq(
                Mux(pictures.front, pictures.color_tag[0], pictures.color_tag[1])),
        ]

    def _pixel_in(self, write):
        """What is written where both are one part."""
        access = self.memory.access
        return [
            access.pixel_in.value.eq(Cat(write.depth, write.color)),  # as in ``pixel_layout``
            access.pixel_in.tag.eq(self.pictures.depth_tag),
        ]

    def _depth_read(self, current):
        """Whether the depth that was read is of this frame, and the depth."""
        access, front = self.memory.access, self.pictures.front
        if not self.configuration.keeps_two_depths:
            [place] = [place for place, part in enumerate(self._parts) if part.kind == "depth"]
            return current[place], access.depth.value
        back = Mux(front, access.pixel[0].value, access.pixel[1].value)
        return (Mux(front, current[0], current[1]),
                data.View(pixel_layout(self.configuration.rank_bits), back).depth)
