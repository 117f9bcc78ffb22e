"""A frame unit card: a share of the merged picture, numbered by the backplane."""

from amaranth.hdl import *
from amaranth.lib import memory, wiring
from amaranth.lib.wiring import In, Out

from ...golden.specification.configuration import MachineConfiguration
from ..arithmetic.delay import delayed
from ..backplane.connectors import Connector, PictureLines, memory_bus_bits
from ..backplane.id_increment import IdIncrement
from ..mapping.interlace import PixelAddress
from ..mapping.unit_pixel import UnitPixel
from ..memory_unit.memory_access import part_answer
from ..memory_unit.scan_part import ScanPart
from ..memory_unit.sweep_part import add_sweep
from ..memory_unit.two_port_memory import TwoPortMemory
from ..memory_unit.word_parts import FRAME_PARTS
from ..merging.snoop_words import bus_word_layout
from ..wires import wires

__all__ = ["FrameUnit"]


class FrameUnit(wiring.Component):
    """Front and back colour of the pixels that fall to its number among the frame units, which are
    scanned as memory units are where all is one node.

    It hears every pixel that a node sends, and where that is its own, writes it into the back
    colour, over whatever is there: of two pixels that are sent the later one is nearer, so no depth
    is kept.  The pixel comes as unit and address in its node; from these follow x and y, and from
    these the frame unit and its address.

    Where the nodes have memory for less than the highest resolution theirs is the picture's.

    Latency: ``latency`` clocks from a word on the bus until it is written; those of ``ScanPart``.
    Throughput: a pixel and a scan's read a clock.

    Members
    -------
    left: In(Connector), right: Out(Connector)
        The neighbouring slots; the node lines pass through, the ID lines count frame units here.
    total: In(id_bits)
        Number of frame units in the cage.
    node_total: In(id_bits)
        Number of memory units in a node.
    scan: In(ScanLines)
    pictures: In(PictureLines)
        Those for frame units.
    bus: In(bus_word_layout)
        What any node says.
    ended: Out(1)
        In the clock in which whatever a node sent is written at last.

    Cox & Hanrahan 1993, section 8.
    """

    #: The bus is taken into a register, and so is the address here.
    latency = 1 + UnitPixel.latency + 1

    def __init__(self, *, configuration: MachineConfiguration):
        frame = configuration.frame
        self.configuration = configuration
        self.memory = TwoPortMemory(words=frame.words, depth_bits=configuration.rank_bits,
                                    tag_bits=configuration.tag_bits, parts=FRAME_PARTS)
        self._scan = ScanPart(configuration=frame)
        super().__init__({
            "left": In(Connector(configuration)),
            "right": Out(Connector(configuration)),
            "total": In(configuration.id_bits),
            "node_total": In(configuration.id_bits),
            **self._scan.members,
            "pictures": In(PictureLines(configuration)),
            "bus": In(bus_word_layout(**memory_bus_bits(configuration))),
            "ended": Out(1),
        })

    @property
    def storages(self) -> list[memory.Memory]:
        return self.memory.storages

    def elaborate(self, platform):
        m = Module()
        m.submodules.memory = self.memory
        m.submodules.increment = increment = IdIncrement(bits=self.configuration.id_bits)
        number = self.left.id
        m.d.comb += [increment.left.eq(number), self.right.id.eq(increment.right),
                     self.right.node.eq(self.left.node)]
        wiring.connect(wires(m, "response_wires"), wiring.flipped(self.left.response),
                       wiring.flipped(self.right.response))
        access, pictures = self.memory.access, self.pictures
        current = Signal(len(FRAME_PARTS))
        m.d.comb += current.eq(Cat(
            part_answer(access, part).tag == pictures.color_tag[part.picture]
            for part in FRAME_PARTS))
        self._scan.add_to(m, self, number, list(current), fetch=self._at_nodes(m, self.scan.fetch),
                          show=self._at_nodes(m, self.scan.show))
        self._write(m, number)
        add_sweep(m, self, words=self.configuration.frame.words, parts=FRAME_PARTS,
                  current=current)
        return m

    def _at_nodes(self, m, address):
        """A scan address whose low bits are left out that the nodes' picture does not have."""
        found = Signal.like(address)
        m.d.comb += found.valid.eq(address.valid)
        with m.Switch(self.node_total):
            for interlace in self.configuration.interlaces():
                with m.Case(interlace.units):
                    m.d.comb += [found.x.eq(address.x >> interlace.x_shift),
                                 found.y.eq(address.y >> interlace.y_shift)]
        return found

    def _write(self, m, number):
        m.submodules.pixel = pixel = UnitPixel(configuration=self.configuration)
        m.submodules.place = place = PixelAddress(configuration=self.configuration.frame)
        access, pictures = self.memory.access, self.pictures
        heard = Signal.like(self.bus)
        found = heard.word.pixel

        def with_place(signal, name):
            """The signal when the address of its pixel is known."""
            return delayed(m, signal, self.latency - 1, name, reset_less=False)

        here, address = Signal(), Signal.like(access.write_address)
        m.d.sync += [
            heard.eq(self.bus),
            here.eq(place.unit == number),
            address.eq(place.address),
        ]
        m.d.comb += [
            pixel.total.eq(self.node_total),
            pixel.unit.eq(found.unit),
            pixel.address.eq(found.address),
            place.total.eq(self.total),
            place.x.eq(pixel.x),
            place.y.eq(pixel.y),
            access.write.eq(here & with_place(heard.valid & ~heard.word.last, "pixel_heard")),
            self.ended.eq(with_place(heard.valid & heard.word.last, "end_heard")),
            access.write_address.eq(address),
            access.back.eq(~pictures.front),
            access.color_in.value.eq(with_place(found.color, "color")),
            access.color_in.tag.eq(
                Mux(pictures.front, pictures.color_tag[0], pictures.color_tag[1])),
        ]
