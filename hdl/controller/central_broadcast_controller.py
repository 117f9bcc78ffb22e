"""The central broadcast controller: boots the cage, announces triangles, swaps pictures."""

from amaranth.hdl import *
from amaranth.lib import data, stream, wiring
from amaranth.lib.wiring import In, Out

from ...golden.specification import commands
from ...golden.specification.commands import Fault, Opcode, ResponseKind
from ...golden.specification.configuration import MachineConfiguration
from ...golden.specification.ranges import COLOR_BITS
from ..backplane.connectors import BroadcastLines, Connector, PictureLines
from ..backplane.words import (
    Operation,
    broadcast_layout,
    prepared_triangle_layout,
    response_fields,
    response_layout,
    response_value,
)
from ..triangle_setup.triangle_setup import TriangleSetup
from .frame_tags import FrameTags
from .merge_control import merge_control

__all__ = ["CentralBroadcastController"]


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

    Prepared triangles pass straight from the command to the broadcast, but for ``top`` and
    ``bottom``: past the picture's last row they become its height.  So, whatever the host sends,
    no processing element sees a row that is not there.  With set-up in hardware, which holds
    rows to the picture itself, the others go through ``TriangleSetup``, which works on the next
    ones while the processing elements draw; every other command waits until it is empty.

    Latency: a prepared triangle is broadcast in the clock in which it is taken, another
    one as late as ``TriangleSetup`` says.  Throughput: a prepared triangle a clock while
    every FIFO has room, another one as ``TriangleSetup`` says.

    What is for nodes is only in machines that have them: ``nodes`` where merge cards end nodes,
    ``lists_full`` with list memories, the next four in chains, ``tree`` in trees, the next three
    where nodes send to frame units.  The last two are where regions are dealt out.

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
    background: Out(COLOR_BITS)
        The background of the picture shown: red in the low byte, then green, blue.
    more: Out(1)
        Triangles are offered or set up; only where the configuration says ``observe``.
    nodes: In(node_bits)
        How many there are, from the right end of the node lines.
    lists_full: In(1)
        A triangle found no room in its node's list (wired or).
    shown: In(1)
        ``front`` at the right end of the scan chain.
    read_scan: Out(1), scan_read: In(1), depths: In(stream of depth words)
        Begin to read the depths of the next scan; the last one has been taken; these depths.
    tree: Out(TreeLines)
        To the tree merge cards.
    snoop: Out(SnoopLines)
        To the snoop merge cards, and from the frame units.
    frame_pictures: Out(PictureLines)
        Those to the frame units; then ``pictures`` are to the nodes, whose front picture is merged.
    frame_units: In(id_bits)
        Number of frame units, from the right end of the ID lines.
    regions: Out(RegionLines), shown_table: Out(1)
        To the processing elements; for the scan generator, in place of ``regions.table``.
    """

    def __init__(self, *, configuration: MachineConfiguration):
        self.configuration = configuration
        self.tags = FrameTags(tag_bits=configuration.tag_bits, frame_units=configuration.snoops)
        self._setup = (TriangleSetup(configuration=configuration)
                       if configuration.controller_sets_up else None)
        self._nodes = merge_control(configuration)
        self.storages = self._nodes.storages  # RAMs whose contents outlast a frame
        self.packet = Signal(broadcast_layout(configuration), name="packet")
        # Clocks since reset and since the frame start, scans since the frame start.
        self._cycles = Signal(commands.RESPONSE_VALUE_BITS, name="cycles")
        self.frame_cycles = Signal(commands.RESPONSE_VALUE_BITS, name="frame_cycles")
        self.scans = Signal(commands.RESPONSE_VALUE_BITS, name="scans")
        # Of the frame whose commands ended last, clocks from its start until all was drawn.
        self.drawn_cycles = Signal(commands.RESPONSE_VALUE_BITS, name="drawn")
        # What the cage is: units that are somebody's, shares that are not as large as they must be,
        # whether the cards can interlace so many units, and the resolution as it is reported.
        self._owned = Signal(commands.RESPONSE_VALUE_BITS, name="owned")
        self._unequal = Signal(name="unequal")
        self._supported = Signal(name="supported")
        self._resolution = Signal(commands.RESPONSE_VALUE_BITS, name="picture")
        self._loading = Signal(name="loading")  # the last command was LOAD
        # Clocks until ``done`` counts the last strobe.
        self._settle = Signal(range(BroadcastLines.settle_clocks + 1), name="settle")
        #: Of the two pictures that can be shown.
        self.backgrounds = [Signal(COLOR_BITS, name=f"background_{place}")
                            for place in range(2)]
        super().__init__({
            "commands": In(stream.Signature(commands.command_bits(configuration))),
            "responses": Out(stream.Signature(response_layout())),
            "right": Out(Connector(configuration)),
            "total": In(configuration.id_bits),
            "broadcast": Out(BroadcastLines(configuration)),
            "scan_start": In(1),
            "pictures": Out(PictureLines(configuration)),
            "background": Out(COLOR_BITS),
            **({"more": Out(1)} if configuration.observe else {}),
            **self._nodes.members,
        })

    def elaborate(self, platform):
        m = Module()
        if self.configuration.node_bits:
            m.d.comb += self.right.node.eq(0)
        m.d.comb += self.broadcast.packet.eq(self.packet)
        self._count(m)
        self._picture(m)
        self._count_owned(m)
        self._nodes.add_to(m, self)
        self._tags(m)
        m.d.comb += self.background.eq(Mux(self._nodes.front(self), *reversed(self.backgrounds)))
        if self._setup is not None:
            self._set_up(m, self._setup)
        if self.configuration.observe:
            self._observe(m)
        # Unless the controller itself speaks, the processing elements do.
        m.d.comb += [
            self.answers.valid.eq(self.right.response.valid),
            self.answers.payload.eq(self.right.response.payload),
            self.right.response.ready.eq(self.answers.ready),
        ]
        with m.FSM():
            self._boot(m)
            with m.State("COMMAND"), m.If(self.commands.valid & self._in_turn):
                self._command(m)
            self._end_commands(m)
            self._show(m)
            self._refuse(m)
        return m

    # What is used in many places.

    @property
    def opcode(self):
        return self.commands.payload[:commands.OPCODE_BITS]

    @property
    def body(self):
        return self.commands.payload[commands.BODY_OFFSET:]

    @property
    def answers(self):
        """Where responses go from here and from the chain."""
        return self._nodes.answers(self)

    @property
    def quiet(self):
        """All that was announced is done."""
        return self.broadcast.done & (self._settle == 0)

    @property
    def _in_turn(self):
        """The command need not wait for triangles that are still being set up, nor for a picture
        on its way to the screen."""
        return self._nodes.in_turn(self, self._set_up_in_turn)

    @property
    def _set_up_in_turn(self):
        if self._setup is None:
            return C(1)
        vertices = Opcode.TRIANGLE
        if self.configuration.list_words:  # what is set up is all to be loaded, or all to be drawn
            vertices = Mux(self._loading, Opcode.LOAD, Opcode.TRIANGLE)
        return (self.opcode == vertices) | ~self._setup.busy

    @property
    def _vertices(self):
        """Commands of vertices that the machine sets up."""
        return [Opcode.TRIANGLE] + [Opcode.LOAD] * bool(self.configuration.list_words)

    @property
    def unsupported_units(self):
        """The cage draws nothing: so many memory units, or such shares, cannot be interlaced."""
        return ~self._supported | self._unequal

    def announce(self, m, operation, then=None, *, when=1):
        """Strobe the packet as soon as all are ready."""
        m.d.comb += self.packet.operation.eq(operation)
        with m.If(self.broadcast.ready & when):
            m.d.comb += self.broadcast.strobe.eq(1)
            if then is not None:
                m.next = then

    def respond(self, m, kind, value, then):
        """The controller's own response; the chain waits meanwhile."""
        m.d.comb += [
            self.answers.valid.eq(1),
            self.answers.payload.kind.eq(kind),
            self.answers.payload.value.eq(value),
            self.right.response.ready.eq(0),
        ]
        with m.If(self.answers.ready):
            m.next = then

    # What goes on beside the commands.

    def _count(self, m):
        """Clocks, scans, and clocks until ``done`` counts a strobe."""
        m.d.sync += [self._cycles.eq(self._cycles + 1),
                     self.frame_cycles.eq(self.frame_cycles + 1)]
        with m.If(self.broadcast.strobe):
            m.d.sync += self._settle.eq(BroadcastLines.settle_clocks)
        with m.Elif(self._settle != 0):
            m.d.sync += self._settle.eq(self._settle - 1)
        with m.If(self.scan_start):
            m.d.sync += self.scans.eq(self.scans + 1)

    def _set_up(self, m, setup):
        """Triangles are announced as soon as they are set up."""
        m.submodules.setup = setup
        m.d.comb += [setup.total.eq(self.total), setup.vertices.payload.eq(self.body)]
        with m.If(setup.triangles.valid):
            m.d.comb += [self.packet.body.draw.eq(setup.triangles.payload),
                         setup.triangles.ready.eq(self.broadcast.ready)]
            operation = Operation.DRAW
            if self.configuration.list_words:
                operation = Mux(self._loading, Operation.LOAD, Operation.DRAW)
            self.announce(m, operation)
        if self.configuration.list_words:
            with m.If(self.commands.valid & self.commands.ready):
                m.d.sync += self._loading.eq(self.opcode == Opcode.LOAD)

    def _observe(self, m):
        offered = self.commands.valid & ((self.opcode == Opcode.TRIANGLE)
                                         | (self.opcode == Opcode.PREPARED_TRIANGLE))
        m.d.comb += self.more.eq(offered | self._nodes.setting_up(self, self._setup))

    # The states.

    def _boot(self, m):
        """From reset to the first command."""
        with m.State("SURVEY"):
            self.announce(m, Operation.SURVEY, "SURVEYING")
        with m.State("SURVEYING"), m.If(self.quiet):
            m.next = "REPORT_UNITS"
        with m.State("REPORT_UNITS"):
            self.respond(m, ResponseKind.UNITS, response_value(
                ResponseKind.UNITS, total=self._nodes.all_units(self), owned=self._owned),
                          self._nodes.after_units)
        with m.State("CHECK_UNITS"):
            m.next = "INITIALISE"
            with m.If(self._nodes.refused(self)):
                m.next = "REFUSE"
        with m.State("INITIALISE"):
            m.d.comb += self.pictures.initialise.eq(1)
            m.next = "INITIALISING"
        with m.State("INITIALISING"), m.If(self._nodes.swept(self)):
            booted = Signal.like(self._cycles, name="booted")
            m.d.sync += booted.eq(self._cycles)
            m.next = "REPORT_PICTURE"
        with m.State("REPORT_PICTURE"):
            self.respond(m, ResponseKind.PICTURE, self._resolution, "REPORT_BOOTED")
        with m.State("REPORT_BOOTED"):
            self.respond(m, ResponseKind.BOOTED, booted, "COMMAND")

    def _command(self, m):
        """A command is offered, and may be taken."""
        m.d.comb += self.commands.ready.eq(self.broadcast.ready)
        with m.Switch(self.opcode):
            if self._setup is not None:
                with m.Case(*self._vertices):
                    m.d.comb += [self._setup.vertices.valid.eq(1),
                                 self.commands.ready.eq(self._setup.vertices.ready)]
            elif self.configuration.list_words:
                with m.Case(Opcode.LOAD):
                    self._hold_to_picture(m)
                    self.announce(m, Operation.LOAD)
            with m.Case(Opcode.PREPARED_TRIANGLE):
                self._hold_to_picture(m)
                self.announce(m, Operation.DRAW)
            with m.Case(Opcode.FRAME_START):
                m.d.comb += self.commands.ready.eq(1)
                m.d.sync += [self.frame_cycles.eq(0), self.scans.eq(self.scan_start)]
                m.next = "START_FRAME"
                self._nodes.start(m, self)
            with m.Case(Opcode.FRAME_END):
                m.d.comb += self.commands.ready.eq(1)
                m.next = "DRAWING"
            self._nodes.commands(m, self)
            for opcode, operation in ((Opcode.READ_DEPTH, Operation.READ_DEPTH),
                                      (Opcode.READ_COUNTERS, Operation.READ_COUNTERS)):
                if opcode in self._nodes.opcodes:
                    continue
                with m.Case(opcode):
                    self.announce(m, operation, "ANSWERING", when=self.quiet)
                    m.d.comb += self.commands.ready.eq(self.broadcast.strobe)
            with m.Default():
                m.d.comb += self.commands.ready.eq(1)
                m.next = "UNKNOWN"

    def _hold_to_picture(self, m):
        """The packet is the offered prepared triangle, without rows past the picture."""
        layout = prepared_triangle_layout(self.configuration)
        offered, draw = data.View(layout, self.body[:layout.size]), self.packet.body.draw
        heights = {picture.height for picture in self.configuration.pictures()}
        m.d.comb += draw.eq(offered)
        if min(heights) == (1 << self.configuration.y_bits) - 1:
            return  # no number of a row's bits lies past the picture
        height = (Const(heights.pop()) if len(heights) == 1
                  else response_fields(ResponseKind.PICTURE, self._resolution).height)
        for row in ("top", "bottom"):
            with m.If(offered[row] > height[:len(offered[row])]):
                m.d.comb += draw[row].eq(height)

    def _end_commands(self, m):
        """The states after a command that is not done when it is taken."""
        with m.State("START_FRAME"):
            # What is still drawn belongs to the old tag, and so waits for the new one.
            self.announce(m, Operation.FRAME_START, "COMMAND",
                           when=self.quiet & self.tags.ready)
            m.d.comb += self.tags.start.eq(self.broadcast.strobe)
        with m.State("UNKNOWN"):
            self.respond(m, ResponseKind.ERROR, Fault.UNKNOWN_COMMAND, "COMMAND")
        with m.State("ANSWERING"), m.If(self.quiet):
            m.next = "COMMAND"
        self._nodes.states(m, self)

    def _show(self, m):
        """From the end of a frame's commands until its picture is shown."""
        with m.State("DRAWING"), m.If(self.quiet):
            m.d.sync += self.drawn_cycles.eq(self.frame_cycles)
            self._nodes.drawn(m)
            m.next = "REPORT_DRAWN"
        with m.State("REPORT_DRAWN"):
            self.respond(m, ResponseKind.FRAME_DRAWN, self.drawn_cycles,
                         self._nodes.after_drawn(m, self))
        self._nodes.show(m, self)

    def _refuse(self, m):
        """The machine does not draw: an error at boot and in answer to every command."""
        with m.State("REFUSE"):
            self.respond(m, ResponseKind.ERROR, self._nodes.fault(self), "REFUSED")
        with m.State("REFUSED"):
            m.d.comb += self.commands.ready.eq(1)
            with m.If(self.commands.valid):
                m.next = "REFUSE"

    # The lines to the memory units, and what is known of them.

    def _tags(self, m):
        """What the memory units are told of the frames' tags."""
        m.submodules.tags = tags = self.tags
        pictures = self.pictures
        m.d.comb += [
            tags.back.eq(~pictures.front),
            tags.swept.eq(self._nodes.swept(self)),
            pictures.sweep.eq(tags.sweep),
            pictures.depth_tag.eq(tags.depth),
            *(line.eq(tag) for line, tag in zip(pictures.color_tag, tags.color, strict=True)),
        ]

    def _picture(self, m):
        """Whether the number of units is one the cards can interlace, and the resolution."""
        with m.Switch(self.total):
            for picture in self.configuration.pictures():
                with m.Case(picture.units):
                    m.d.comb += [self._supported.eq(1),
                                 self._resolution.eq(commands.response_value(
                                     ResponseKind.PICTURE, width=picture.width,
                                     height=picture.height))]

    def _count_owned(self, m):
        """Add up the domains as their reports pass; what is missing from the total is nobody's.
        Squares, lines and regions are interlaced by equal shares only."""
        configuration = self.configuration
        response = self.right.response
        units = response_fields(ResponseKind.DOMAIN, response.payload.value).units
        with m.If(response.valid & response.ready
                  & (response.payload.kind == ResponseKind.DOMAIN)):
            m.d.sync += self._owned.eq(self._owned + units)
            if configuration.equal_shares:
                with m.If(units != 1 << configuration.share_bits):
                    m.d.sync += self._unequal.eq(1)
