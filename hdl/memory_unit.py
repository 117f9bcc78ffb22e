"""A memory unit card: a share of the pixels, numbered by the backplane."""

from amaranth.hdl import *
from amaranth.lib import wiring
from amaranth.lib.wiring import In, Out

from ..golden.configuration import MachineConfiguration
from .backplane import Connector, Lane, ScanLines
from .id_increment import IdIncrement
from .interlace import ScanAddress
from .one_port_memory import OnePortMemory
from .wires import wires

__all__ = ["MemoryUnit"]


class MemoryUnit(wiring.Component):
    """Depth, front and back colour of the pixels that fall to its number (figures 6 to 11).

    Its number and the total come from the lines alone.  In each clock its one
    port serves the scan generator, else a write of its processing element, else
    a read; whoever waits sees ``busy``.  The scan's colour goes into an output
    register, which drives the video bus while the scan shows a pixel of this
    unit, so the processing element has the port in the meantime.

    Latency: a scan fetch is on the video bus three clocks later; read data come
    one clock after the read.  Throughput: one access a clock, of whichever kind.
    Scan reads per line: at most ``Interlace.pitch``.

    Members
    -------
    left: In(Connector), right: Out(Connector)
        The neighbouring slots; lines and responses pass through.
    total: In(id_bits)
        Number of memory units in the cage.
    scan: In(ScanLines)
    front: In(1)
        Which of the two colours is shown; the other is the back picture.
    """

    def __init__(self, *, configuration: MachineConfiguration):
        self.configuration = configuration
        self.memory = OnePortMemory(words=configuration.words, depth_bits=configuration.depth_bits)
        super().__init__({
            "left": In(Connector(configuration)),
            "right": Out(Connector(configuration)),
            "total": In(configuration.id_bits),
            "scan": In(ScanLines(configuration)),
            "front": In(1),
        })

    def elaborate(self, platform):
        m = Module()
        m.submodules.memory = memory = self.memory
        m.submodules.increment = increment = IdIncrement(bits=self.configuration.id_bits)
        number = self.left.id
        m.d.comb += [increment.left.eq(number), self.right.id.eq(increment.right)]

        scan_read, scan_address = self._scan(m, memory, number)
        self._serve(m, memory, number, scan_read, scan_address)

        wiring.connect(wires(m, "response_wires"), wiring.flipped(self.left.response),
                       wiring.flipped(self.right.response))
        return m

    def _scan(self, m, memory, number):
        """Fetch, capture, drive: one clock each."""
        m.submodules.fetch = fetch = ScanAddress(configuration=self.configuration)
        m.submodules.show = show = ScanAddress(configuration=self.configuration)
        scan_read = Signal()
        captured = Signal()
        scan_address = Signal(self.configuration.address_bits)
        output = Signal.like(self.scan.video)
        scan = wires(m, "scan_wires")
        for address, line in ((fetch, self.scan.fetch), (show, self.scan.show)):
            scan.d.comb += [
                address.total.eq(self.total), address.id.eq(number),
                address.x.eq(line.x), address.y.eq(line.y),
            ]
        scan.d.comb += self.scan.video.eq(Mux(show.selected, output, 0))
        m.d.sync += [
            scan_read.eq(self.scan.fetch.valid & fetch.fetch),
            scan_address.eq(fetch.address),
            captured.eq(scan_read),
        ]
        with m.If(captured):
            m.d.sync += output.eq(Mux(self.front, memory.color[1], memory.color[0]))
        return scan_read, scan_address

    def _serve(self, m, memory, number, scan_read, scan_address):
        """Scan first, then the processing element's write, then its read."""
        lines, onward = self.left.lines, self.right.lines
        write, read = lines.write, lines.read
        write_here = Signal()
        read_here = Signal()
        answered = Signal()
        wires(m, "line_wires").d.comb += [onward.write.eq(write), onward.read.eq(read)]
        m.d.comb += [
            write_here.eq(write.valid & (write.every | (write.unit == number))),
            read_here.eq(read.valid & (read.unit == number)),
            lines.write_busy.eq(onward.write_busy | (write_here & scan_read)),
            lines.read_busy.eq(onward.read_busy | (read_here & (scan_read | write_here))),
            lines.read_data.eq(onward.read_data | Mux(answered, memory.depth, 0)),
            memory.depth_in.eq(write.depth),
            memory.color_in.eq(write.color),
        ]
        with m.If(scan_read):
            m.d.comb += [memory.address.eq(scan_address), memory.read.eq(1)]
        with m.Elif(write_here):
            back = write.lanes & Lane.BACK != 0
            front = write.lanes & Lane.FRONT != 0
            m.d.comb += [
                memory.address.eq(write.address),
                memory.write.eq(Cat(write.lanes & Lane.DEPTH != 0,
                                    Mux(self.front, back, front),
                                    Mux(self.front, front, back))),
            ]
        with m.Else():
            m.d.comb += [memory.address.eq(read.address), memory.read.eq(read_here)]
        m.d.sync += answered.eq(read_here & ~scan_read & ~write_here)
