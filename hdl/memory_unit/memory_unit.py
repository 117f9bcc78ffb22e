"""A memory unit card: a share of the pixels, numbered by the backplane."""

from amaranth.hdl import *
from amaranth.lib import wiring
from amaranth.lib.wiring import In, Out

from ...golden.specification.configuration import MachineConfiguration
from ..backplane.connectors import Connector, PictureLines, ScanLines
from ..backplane.id_increment import IdIncrement
from ..mapping.interlace import ScanAddress
from ..wires import wires
from .memory_access import part_answer
from .one_port_memory import OnePortMemory
from .tag_sweep import TagSweep
from .two_port_memory import TwoPortMemory
from .word_parts import PARTS

__all__ = ["MemoryUnit"]

#: Address bits that tell whether a write may go to the word that is swept: a false alarm in 16.
COMPARED_BITS = 4


class MemoryUnit(wiring.Component):
    """Depth, front and back colour of the pixels that fall to its number (figures 6 to 11).

    Its number and the total come from the backplane alone.  With one port
    (``memory_ports``) each clock serves the scan generator, else a write of its
    processing element, else a read; whoever waits sees ``busy``.  With two nobody
    ever waits.  The scan's colour goes into an output register, so the processing
    element has the port in the meantime; while the scan shows a pixel of this unit it
    goes on to the registers that drive the video bus.

    Each part of a word (``PARTS``) has a tag beside it.  A part whose tag is not the current
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
    pictures: In(PictureLines)
    """

    def __init__(self, *, configuration: MachineConfiguration):
        self.configuration = configuration
        kind = {1: OnePortMemory, 2: TwoPortMemory}[configuration.memory_ports]
        self.memory: OnePortMemory | TwoPortMemory = kind(
            words=configuration.words, depth_bits=configuration.depth_bits,
            tag_bits=configuration.tag_bits)
        super().__init__({
            "left": In(Connector(configuration)),
            "right": Out(Connector(configuration)),
            "total": In(configuration.id_bits),
            "scan": In(ScanLines(configuration)),
            "pictures": In(PictureLines(configuration)),
        })

    def elaborate(self, platform):
        m = Module()
        m.submodules.memory = self.memory
        m.submodules.increment = increment = IdIncrement(bits=self.configuration.id_bits)
        number = self.left.id
        m.d.comb += [increment.left.eq(number), self.right.id.eq(increment.right)]

        # The parts of the word just read that are of this frame.
        current = Signal(len(PARTS))
        m.d.comb += current.eq(Cat(part_answer(self.memory.access, part).tag == self._tag(part)
                                   for part in PARTS))
        by_name = {part.name: current[place] for place, part in enumerate(PARTS)}
        self._scan(m, number, (by_name["color_0"], by_name["color_1"]))
        self._serve(m, number, by_name["depth"])
        self._sweep(m, current)

        wiring.connect(wires(m, "response_wires"), wiring.flipped(self.left.response),
                       wiring.flipped(self.right.response))
        return m

    def _tag(self, part):
        """The current tag of a part."""
        tag = getattr(self.pictures, f"{part.kind}_tag")
        return tag if part.picture is None else tag[part.picture]

    def _scan(self, m, number, current):
        """Fetch, read, capture, drive: one clock each; ``current`` of both colours."""
        m.submodules.fetch = fetch = ScanAddress(configuration=self.configuration)
        m.submodules.show = show = ScanAddress(configuration=self.configuration)
        access, pictures = self.memory.access, self.pictures
        captured = Signal()
        output = Signal.like(self.scan.video)
        drawn = Signal()
        scan = wires(m, "scan_wires")
        for address, asked in ((fetch, self.scan.fetch), (show, self.scan.show)):
            scan.d.comb += [
                address.total.eq(self.total), address.id.eq(number),
                address.x.eq(asked.x), address.y.eq(asked.y),
            ]
        shown = show.selected & drawn
        scan.d.sync += [self.scan.drawn.eq(shown), self.scan.video.eq(Mux(shown, output, 0))]
        scan_read = Signal()
        scan_address = Signal(self.configuration.address_bits)
        m.d.sync += [
            scan_read.eq(self.scan.fetch.valid & fetch.fetch),
            scan_address.eq(fetch.address),
            captured.eq(scan_read),
        ]
        m.d.comb += [access.scan.eq(scan_read), access.scan_address.eq(scan_address)]
        with m.If(captured):
            m.d.sync += [
                output.eq(Mux(pictures.front, access.color[1].value, access.color[0].value)),
                drawn.eq(Mux(pictures.front, current[1], current[0])),
            ]

    def _serve(self, m, number, current):
        """What the processing element asks for, and its answer; ``current`` of the depth."""
        bus, onward = self.left.lines, self.right.lines
        write, read = bus.write, bus.read
        access, pictures = self.memory.access, self.pictures
        scanned = access.scan if self.configuration.memory_ports == 1 else C(0)
        write_here = Signal()
        read_here = Signal()
        answered = Signal()
        answer = Signal(self.configuration.depth_bits)
        wires(m, "line_wires").d.comb += [onward.write.eq(write), onward.read.eq(read)]
        m.d.comb += [
            write_here.eq(write.valid & (write.unit == number)),
            access.write.eq(write_here),
            access.back.eq(~pictures.front),
            access.write_address.eq(write.address),
            access.depth_in.value.eq(write.depth),
            access.depth_in.tag.eq(pictures.depth_tag),
            access.color_in.value.eq(write.color),
            access.color_in.tag.eq(
                Mux(pictures.front, pictures.color_tag[0], pictures.color_tag[1])),
            bus.write_busy.eq(onward.write_busy | (write_here & access.write_busy)),
            bus.scanned.eq(onward.scanned | Mux(scanned, Mux(number[0], 2, 1), 0)),

            read_here.eq(read.valid & (read.unit == number)),
            access.read.eq(read_here),
            access.read_address.eq(read.address),
            bus.read_busy.eq(onward.read_busy | (read_here & access.read_busy)),
            answer.eq(Mux(current, access.depth.value, self.configuration.depth_background)),
            bus.read_data.eq(onward.read_data | Mux(answered, answer, 0)),
        ]
        m.d.sync += answered.eq(read_here & ~access.read_busy)

    def _sweep(self, m, current):
        """Take old tags out; ``current`` of all parts."""
        m.submodules.tag_sweep = sweep = TagSweep(words=self.configuration.words,
                                                  parts=len(PARTS))
        access, pictures = self.memory.access, self.pictures
        m.d.comb += [
            sweep.start.eq(pictures.sweep),
            sweep.initialise.eq(pictures.initialise),
            pictures.swept.eq(sweep.idle),
            access.sweep.eq(sweep.sweep),
            access.erase.eq(sweep.erase),
            access.sweep_address.eq(sweep.address),
            sweep.busy.eq(access.sweep_busy),
            sweep.scan.eq(access.scan),
            sweep.stale.eq(Cat(part_answer(access, part).tag.any() for part in PARTS)
                           & ~current),
        ]
        near = (access.write_address ^ sweep.address)[:COMPARED_BITS] == 0
        m.d.comb += sweep.overwritten.eq(access.write & ~access.write_busy & near)
