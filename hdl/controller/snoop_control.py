"""What the controller does where nodes merge on a bus, while they draw the next frame."""

from amaranth.hdl import *
from amaranth.lib.wiring import In, Out

from ...golden.specification import commands
from ...golden.specification.commands import Fault, Opcode, ResponseKind
from ...golden.specification.configuration import MachineConfiguration
from ...golden.specification.ranges import COLOR_BITS
from ..backplane.connectors import PictureLines
from ..backplane.words import Operation
from ..merging.snoop_words import SnoopLines
from .node_control import FAULT_BITS, NodeControl

__all__ = ["SnoopControl"]


class SnoopControl(NodeControl):
    """Hands a drawn frame over when the one before is shown: the nodes' pictures change places, and
    the frame units' back colour gets the frame's tag and background.  Then the nodes merge, and
    draw the next frame meanwhile; only read-backs wait.

    A picture is merged when the frame units have written what the last node sent.
    """

    opcodes = (Opcode.READ_DEPTH,)
    after_nodes = "REPORT_FRAME_UNITS"

    def __init__(self, *, configuration: MachineConfiguration):
        super().__init__(configuration=configuration)
        cycles = Signal(commands.RESPONSE_VALUE_BITS)
        #: Which of the nodes' pictures is merged; the other one is drawn into.
        self._merging = Signal(name="merging_picture")
        #: A frame is drawn, and not yet handed over.
        self._waiting = Signal(name="frame_waiting")
        #: Since the last frame was handed over another one has begun.
        self._drawing = Signal(name="frame_begun")
        self._reading = Signal(name="reading_depths")
        self._background = Signal(COLOR_BITS, name="drawn_background")
        #: Of the frame handed over, since its start: clocks until it was merged, and scans.
        self._cycles = Signal.like(cycles, name="merging_cycles")
        self._scans = Signal.like(cycles, name="presented_scans")
        self._all_ended = Signal(init=1, name="all_ended")
        self._frame_supported = Signal(name="frame_supported")

    @property
    def members(self):
        lines = Out(PictureLines(self.configuration))
        return {**super().members, "snoop": Out(SnoopLines()), "frame_pictures": lines,
                "frame_units": In(self.configuration.id_bits)}

    def add_to(self, m, controller):
        super().add_to(m, controller)
        self._check_frame(m, controller)
        self._connect_pictures(m, controller)
        self._hand_over(m, controller)
        self._merge(m, controller)

    def _connect_pictures(self, m, controller):
        pictures, frame, tags = controller.pictures, controller.frame_pictures, controller.tags
        m.d.comb += [
            # Depths are those of the picture that was drawn last, wherever it is now.
            pictures.front.eq(self._merging ^ (self._reading & ~self._drawing)),
            frame.initialise.eq(pictures.initialise),
            frame.sweep.eq(pictures.sweep),
            *(line.eq(tag) for line, tag in zip(frame.color_tag, tags.frame_color, strict=True)),
            tags.frame_back.eq(~frame.front),
        ]

    def _hand_over(self, m, controller):
        """A frame that was drawn to the presenter, as soon as that is idle."""
        presenter = self.presenter
        m.d.comb += [presenter.start.eq(self._waiting & presenter.idle),
                     controller.tags.hand_over.eq(presenter.start)]
        m.d.sync += [self._cycles.eq(self._cycles + ~self._all_ended),
                     self._scans.eq(self._scans + controller.scan_start)]
        with m.If(presenter.start):
            m.d.sync += [
                self._waiting.eq(0),
                self._drawing.eq(0),
                self._merging.eq(~self._merging),
                self._cycles.eq(controller.frame_cycles + 1),
                self._scans.eq(controller.scans + controller.scan_start),
            ]
            for place, background in enumerate(controller.backgrounds):
                with m.If(controller.frame_pictures.front != place):
                    m.d.sync += background.eq(self._background)

    def _merge(self, m, controller):
        """Begins when the pictures have changed places, ends when all nodes have."""
        snoop, left = controller.snoop, Signal.like(controller.nodes, name="nodes_left")
        m.d.sync += snoop.start.eq(self.presenter.start)
        with m.If(self.presenter.start):
            m.d.sync += [left.eq(controller.nodes), self._all_ended.eq(0)]
        with m.Elif(snoop.ended):
            m.d.sync += [left.eq(left - 1), self._all_ended.eq(left == 1)]

    def merged(self, controller):
        return self._all_ended & ~self.presenter.start

    def merge_cycles(self, controller):
        return self._cycles

    def scans(self, controller):
        return self._scans

    def front(self, controller):
        return controller.frame_pictures.front

    def swept(self, controller):
        return controller.pictures.swept & controller.frame_pictures.swept

    def start(self, m, controller):
        m.d.sync += [self._background.eq(controller.body), self._drawing.eq(1)]

    def in_turn(self, controller, ready):
        """There is memory for a frame while another one is presented, but for none while one more
        waits for that; what is read back is of a frame that is shown."""
        waits = self._waiting
        for opcode in (Opcode.READ_DEPTH, Opcode.READ_COUNTERS):
            waits |= (controller.opcode == opcode) & ~self.presenter.idle
        return ready & (~waits | self.is_for_lists(controller))

    def after_drawn(self, m, controller):
        with m.If(controller.answers.ready):
            m.d.sync += self._waiting.eq(1)
        return "COMMAND"

    def _check_frame(self, m, controller):
        """The number of frame units is one that can be interlaced, and they hold the picture."""
        frames = self.configuration.frame.interlaces()
        with m.Switch(controller.total):
            for nodes in self.configuration.interlaces():
                numbers = [frame.units for frame in frames
                           if frame.width >= nodes.width and frame.height >= nodes.height]
                with m.Case(nodes.units), m.Switch(controller.frame_units), m.Case(*numbers):
                    m.d.comb += self._frame_supported.eq(1)

    def refused(self, controller):
        return super().refused(controller) | ~self._frame_supported

    def fault(self, controller):
        return Mux(self._frame_supported, super().fault(controller),
                   C(Fault.UNITS_UNSUPPORTED, FAULT_BITS))

    def commands(self, m, controller):
        super().commands(m, controller)
        with m.Case(Opcode.READ_DEPTH):
            controller.announce(m, Operation.READ_DEPTH, "READING_DEPTHS", when=controller.quiet)
            m.d.comb += controller.commands.ready.eq(controller.broadcast.strobe)

    def states(self, m, controller):
        super().states(m, controller)
        with m.State("REPORT_FRAME_UNITS"):
            controller.respond(m, ResponseKind.FRAME_UNITS, controller.frame_units, "CHECK_UNITS")
        with m.State("READING_DEPTHS"):
            m.d.comb += self._reading.eq(1)
            with m.If(controller.quiet):
                m.next = "COMMAND"
