"""The central broadcast controller: boots the cage, announces triangles, swaps pictures."""

from amaranth.hdl import *
from amaranth.lib import stream, wiring
from amaranth.lib.wiring import In, Out

from ...golden.specification import commands
from ...golden.specification.commands import Fault, Opcode, ResponseKind
from ...golden.specification.configuration import MachineConfiguration
from ...golden.specification.ranges import CHANNEL_BITS
from ..backplane.connectors import BroadcastLines, Connector, PictureLines
from ..backplane.words import Operation, broadcast_layout, response_layout
from ..triangle_setup.triangle_setup import TriangleSetup
from .frame_tags import FrameTags

__all__ = ["CentralBroadcastController"]

#: Clocks until a strobe shows in ``done``: into the FIFO, and out of it.
SETTLE_CLOCKS = 3


class CentralBroadcastController(wiring.Component):
    """Takes commands from the host and tells all processing elements at once (figure 12).

    After reset it has the processing elements survey their domains and the memory
    units initialise both pictures, and reports: each domain, owned and total
    units, the resolution, the cycles it took.  Then it takes commands in order;
    every opcode and response is described in ``golden.specification.commands``.  A frame starts
    with a new tag, by which every word is background, in the clock after its
    command where nothing is drawn any more; it waits only for a tag that no word
    has (``FrameTags``).  A finished picture is shown from the start of the next
    scan on; until then the old one stays, whole.

    Prepared triangles pass straight from the command to the broadcast.  With set-up
    in hardware the others go through ``TriangleSetup``, which works on the next ones
    while the processing elements draw; every other command waits until it is empty.

    Latency: a prepared triangle is broadcast in the clock in which it is taken, another
    one as late as ``TriangleSetup`` says.  Throughput: a prepared triangle a clock while
    every FIFO has room, another one as ``TriangleSetup`` says.

    Members
    -------
    commands: In(stream of command words)
    responses: Out(stream of response_layout)
    right: Out(Connector)
        The first slot; here the ID lines start at 0.
    total: In(id_bits)
        Number of memory units, from the right end of the ID lines.
    broadcast: Out(BroadcastLines)
    scan_start: In(1)
        A scan begins.
    pictures: Out(PictureLines)
    background: Out(24)
        Of the picture shown: red in the low byte, then green, blue.
    more: Out(1)
        Triangles are offered or set up; only where the configuration says ``observe``.
    """

    def __init__(self, *, configuration: MachineConfiguration):
        self.configuration = configuration
        self.tags = FrameTags(configuration=configuration)
        super().__init__({
            "commands": In(stream.Signature(commands.command_bits(configuration))),
            "responses": Out(stream.Signature(response_layout())),
            "right": Out(Connector(configuration)),
            "total": In(configuration.id_bits),
            "broadcast": Out(BroadcastLines(configuration)),
            "scan_start": In(1),
            "pictures": Out(PictureLines(configuration)),
            "background": Out(3 * CHANNEL_BITS),
            **({"more": Out(1)} if configuration.observe else {}),
        })

    def elaborate(self, platform):
        m = Module()
        opcode = self.commands.payload[:commands.OPCODE_BITS]
        body = self.commands.payload[commands.BODY_OFFSET:]
        packet = Signal(broadcast_layout(self.configuration))
        m.d.comb += self.broadcast.packet.eq(packet)

        cycles = Signal(32)
        frame_cycles = Signal(32)
        scans = Signal(32)
        owned = Signal(32)
        settle = Signal(range(SETTLE_CLOCKS + 1))
        quiet = self.broadcast.done & (settle == 0)
        m.d.sync += [cycles.eq(cycles + 1), frame_cycles.eq(frame_cycles + 1)]
        with m.If(self.broadcast.strobe):
            m.d.sync += settle.eq(SETTLE_CLOCKS)
        with m.Elif(settle != 0):
            m.d.sync += settle.eq(settle - 1)
        with m.If(self.scan_start):
            m.d.sync += scans.eq(scans + 1)
        supported, picture = self._picture(m)
        unequal = Signal()
        self._count_owned(m, owned, unequal)
        pictures = self.pictures
        backgrounds = [Signal.like(self.background, name=f"background_{place}")
                       for place in range(2)]
        self._tags(m)
        m.d.comb += self.background.eq(Mux(pictures.front, *reversed(backgrounds)))

        def announce(operation, then=None, *, when=1):
            """Strobe the packet as soon as all are ready."""
            m.d.comb += packet.operation.eq(operation)
            with m.If(self.broadcast.ready & when):
                m.d.comb += self.broadcast.strobe.eq(1)
                if then is not None:
                    m.next = then

        def respond(kind, value, then):
            """The controller's own response; the chain waits meanwhile."""
            m.d.comb += [
                self.responses.valid.eq(1),
                self.responses.payload.kind.eq(kind),
                self.responses.payload.value.eq(value),
                self.right.response.ready.eq(0),
            ]
            with m.If(self.responses.ready):
                m.next = then

        in_turn = C(1)
        if self.configuration.setup == "hardware":
            m.submodules.setup = setup = TriangleSetup(configuration=self.configuration)
            in_turn = (opcode == Opcode.TRIANGLE) | ~setup.busy
            m.d.comb += [setup.total.eq(self.total), setup.vertices.payload.eq(body)]
            with m.If(setup.triangles.valid):
                m.d.comb += [packet.body.draw.eq(setup.triangles.payload),
                             setup.triangles.ready.eq(self.broadcast.ready)]
                announce(Operation.DRAW)
        if self.configuration.observe:
            offered = self.commands.valid & ((opcode == Opcode.TRIANGLE)
                                             | (opcode == Opcode.PREPARED_TRIANGLE))
            m.d.comb += self.more.eq(
                offered | (setup.busy if self.configuration.setup == "hardware" else 0))

        # Unless the controller itself speaks, the processing elements do.
        m.d.comb += [
            self.responses.valid.eq(self.right.response.valid),
            self.responses.payload.eq(self.right.response.payload),
            self.right.response.ready.eq(self.responses.ready),
        ]

        with m.FSM():
            with m.State("SURVEY"):
                announce(Operation.SURVEY, "SURVEYING")
            with m.State("SURVEYING"), m.If(quiet):
                m.next = "REPORT_UNITS"
            with m.State("REPORT_UNITS"):
                respond(ResponseKind.UNITS, Cat(self.total | C(0, 16), owned[:16]),
                        "CHECK_UNITS")
            with m.State("CHECK_UNITS"):
                m.next = "INITIALISE"
                with m.If(~supported | unequal):
                    m.next = "REFUSE"
            with m.State("INITIALISE"):
                m.d.comb += pictures.initialise.eq(1)
                m.next = "INITIALISING"
            with m.State("INITIALISING"), m.If(pictures.swept):
                booted = Signal.like(cycles)
                m.d.sync += booted.eq(cycles)
                m.next = "REPORT_PICTURE"
            with m.State("REPORT_PICTURE"):
                respond(ResponseKind.PICTURE, picture, "REPORT_BOOTED")
            with m.State("REPORT_BOOTED"):
                respond(ResponseKind.BOOTED, booted, "COMMAND")

            with m.State("COMMAND"), m.If(self.commands.valid & in_turn):
                m.d.comb += self.commands.ready.eq(self.broadcast.ready)
                with m.Switch(opcode):
                    if self.configuration.setup == "hardware":
                        with m.Case(Opcode.TRIANGLE):
                            m.d.comb += [setup.vertices.valid.eq(1),
                                         self.commands.ready.eq(setup.vertices.ready)]
                    with m.Case(Opcode.PREPARED_TRIANGLE):
                        m.d.comb += packet.body.draw.eq(body)
                        announce(Operation.DRAW)
                    with m.Case(Opcode.FRAME_START):
                        m.d.comb += self.commands.ready.eq(1)
                        m.d.sync += [frame_cycles.eq(0), scans.eq(self.scan_start)]
                        for place, background in enumerate(backgrounds):
                            with m.If(pictures.front != place):
                                m.d.sync += background.eq(body)
                        m.next = "START_FRAME"
                    with m.Case(Opcode.FRAME_END):
                        m.d.comb += self.commands.ready.eq(1)
                        m.next = "DRAWING"
                    with m.Case(Opcode.READ_DEPTH):
                        announce(Operation.READ_DEPTH, "ANSWERING", when=quiet)
                        m.d.comb += self.commands.ready.eq(self.broadcast.strobe)
                    with m.Case(Opcode.READ_COUNTERS):
                        announce(Operation.READ_COUNTERS, "ANSWERING", when=quiet)
                        m.d.comb += self.commands.ready.eq(self.broadcast.strobe)
                    with m.Default():
                        m.d.comb += self.commands.ready.eq(1)
                        m.next = "UNKNOWN"
            with m.State("START_FRAME"):
                # What is still drawn belongs to the old tag, and so waits for the new one.
                announce(Operation.FRAME_START, "COMMAND", when=quiet & self.tags.ready)
                m.d.comb += self.tags.start.eq(self.broadcast.strobe)
            with m.State("UNKNOWN"):
                respond(ResponseKind.ERROR, Fault.UNKNOWN_COMMAND, "COMMAND")
            with m.State("ANSWERING"), m.If(quiet):
                m.next = "COMMAND"
            with m.State("DRAWING"), m.If(quiet):
                drawn = Signal.like(frame_cycles)
                m.d.sync += drawn.eq(frame_cycles)
                m.next = "REPORT_DRAWN"
            with m.State("REPORT_DRAWN"):
                respond(ResponseKind.FRAME_DRAWN, drawn, "SWAP")
            with m.State("SWAP"), m.If(self.scan_start):
                # Every pixel of the scan that begins here is fetched after this edge.
                shown = Signal.like(scans)
                m.d.sync += [pictures.front.eq(~pictures.front), shown.eq(scans)]
                m.next = "REPORT_SHOWN"
            with m.State("REPORT_SHOWN"):
                respond(ResponseKind.FRAME_SHOWN, shown, "COMMAND")

            with m.State("REFUSE"):
                respond(ResponseKind.ERROR, Fault.UNITS_UNSUPPORTED, "REFUSED")
            with m.State("REFUSED"):
                m.d.comb += self.commands.ready.eq(1)
                with m.If(self.commands.valid):
                    m.next = "REFUSE"
        return m

    def _tags(self, m):
        """What the memory units are told of the frames' tags."""
        m.submodules.tags = tags = self.tags
        pictures = self.pictures
        m.d.comb += [
            tags.back.eq(~pictures.front),
            tags.swept.eq(pictures.swept),
            pictures.sweep.eq(tags.sweep),
            pictures.depth_tag.eq(tags.depth),
            *(line.eq(tag) for line, tag in zip(pictures.color_tag, tags.color, strict=True)),
        ]

    def _picture(self, m):
        """Whether the number of units is one the cards can interlace, and the resolution."""
        supported = Signal()
        picture = Signal(32)
        with m.Switch(self.total):
            for interlace in self.configuration.interlaces():
                with m.Case(interlace.units):
                    m.d.comb += [supported.eq(1),
                                 picture.eq(interlace.height << 16 | interlace.width)]
        return supported, picture

    def _count_owned(self, m, owned, unequal):
        """Add up the domains as their reports pass; what is missing from the total is nobody's.

        Squares are interlaced by equal shares only.
        """
        configuration = self.configuration
        response = self.right.response
        units = response.payload.value[:16]
        with m.If(response.valid & response.ready
                  & (response.payload.kind == ResponseKind.DOMAIN)):
            m.d.sync += owned.eq(owned + units)
            if configuration.square_bits:
                with m.If(units != 1 << configuration.share_bits):
                    m.d.sync += unequal.eq(1)
