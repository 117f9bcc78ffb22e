"""A processing element card: draws into the memory units to its right."""

from amaranth.hdl import *
from amaranth.lib import fifo, wiring
from amaranth.lib.wiring import In, Out

from ..golden.configuration import MachineConfiguration
from .backplane import BroadcastLines, Connector
from .clear import Clear
from .depth_test import DepthTest
from .fragment_stepper import FragmentStepper
from .interlace import PixelAddress
from .layouts import broadcast_layout
from .processing_element_control import ProcessingElementControl
from .read_back import ReadBack
from .response_link import ResponseLink
from .span_start import SpanStart
from .span_walker import SpanWalker
from .survey import Survey

__all__ = ["ProcessingElement"]

COUNTER_BITS = 32


class ProcessingElement(wiring.Component):
    """Owns the memory units up to the next processing element (figure 12).

    ::

        broadcast ─▶ FIFO ─▶ control ─▶ SpanWalker ─▶ SpanStart ─▶ FragmentStepper ─▶ DepthTest
                               │                                                        │
                               ├─▶ Survey, Clear, ReadBack ────────────────────────────▶┤
                               ▼                                                        ▼
                         response link ◀── from the right                 lines to the right

    It drives the lines to its right and ignores those from its left; the ID and
    the responses pass through.

    Latency: from a triangle's strobe to the read of its first fragment,
    ``latency`` clocks more than the lattice stride's bits.  Throughput: a
    fragment a clock while rows are long and ports are free; each row and each
    triangle costs the span walker at least a clock.

    Members
    -------
    left: In(Connector), right: Out(Connector)
    total: In(id_bits)
        Number of memory units in the cage.
    broadcast: In(BroadcastLines)
    """

    #: FIFO 2, walker's load 1, span start 2, fragment stepper 2.
    latency = 2 + 1 + SpanStart.latency + FragmentStepper.latency

    def __init__(self, *, configuration: MachineConfiguration):
        self.configuration = configuration
        super().__init__({
            "left": In(Connector(configuration)),
            "right": Out(Connector(configuration)),
            "total": In(configuration.id_bits),
            "broadcast": In(BroadcastLines(configuration)),
        })

    def elaborate(self, platform):
        m = Module()
        configuration = self.configuration
        layout = broadcast_layout(configuration)
        m.submodules.fifo = queue = fifo.SyncFIFOBuffered(width=layout.size,
                                                          depth=configuration.fifo_depth)
        m.submodules.control = control = ProcessingElementControl(configuration=configuration)
        m.submodules.walker = walker = SpanWalker(configuration=configuration)
        m.submodules.start = start = SpanStart(configuration=configuration)
        m.submodules.stepper = stepper = FragmentStepper(configuration=configuration)
        m.submodules.depth_test = depth_test = DepthTest(configuration=configuration)
        m.submodules.survey = survey = Survey(configuration=configuration)
        m.submodules.clear = clear = Clear(configuration=configuration)
        m.submodules.read_back = read_back = ReadBack(configuration=configuration)
        m.submodules.link = link = ResponseLink()
        m.submodules.picture = picture = PixelAddress(configuration=configuration)

        # From the broadcast to the operations.
        m.d.comb += [
            queue.w_en.eq(self.broadcast.strobe),
            queue.w_data.eq(self.broadcast.packet),
            self.broadcast.ready.eq(queue.w_rdy),
            control.operations.valid.eq(queue.r_rdy),
            control.operations.payload.eq(queue.r_data),
            queue.r_en.eq(control.operations.ready),
        ]

        # The drawing pipeline.
        wiring.connect(m, control.triangles, walker.triangles)
        wiring.connect(m, walker.spans, start.spans)
        wiring.connect(m, start.started, stepper.started)
        wiring.connect(m, stepper.fragments, depth_test.fragments)
        m.d.comb += control.drawing.eq(start.busy | stepper.busy | depth_test.busy)

        # The domain: first unit from the lines, upper end from the survey.
        first = self.left.id
        body = control.operations.payload.body.clear
        m.d.comb += [
            self.right.id.eq(first),
            picture.total.eq(self.total),
            walker.total.eq(self.total), walker.first.eq(first), walker.end.eq(survey.end),
            stepper.total.eq(self.total),
            survey.total.eq(self.total), survey.first.eq(first),
            survey.start.eq(control.survey_start), control.survey_done.eq(survey.done),
            clear.words.eq(picture.words), clear.front.eq(body.front),
            clear.color.eq(Cat(body.red, body.green, body.blue)),
            clear.start.eq(control.clear_start), control.clear_done.eq(clear.done),
            read_back.words.eq(picture.words),
            read_back.first.eq(first), read_back.end.eq(survey.end),
            read_back.start.eq(control.read_back_start),
            control.read_back_done.eq(read_back.done),
            control.first.eq(first), control.end.eq(survey.end),
        ]
        wiring.connect(m, read_back.depths, control.depths)

        self._drive_lines(m, [(control.surveying, survey.memory),
                              (control.clearing, clear.memory),
                              (control.reading, read_back.memory),
                              (None, depth_test.memory)])
        self._count(m, control, depth_test)

        wiring.connect(m, control.responses, link.own)
        wiring.connect(m, wiring.flipped(self.right.response), link.right)
        wiring.connect(m, link.left, wiring.flipped(self.left.response))
        quiet = (queue.level == 0) & control.idle
        m.d.comb += [
            link.own_turn.eq(~quiet),
            self.broadcast.done.eq(quiet & ~link.left.valid),
        ]
        return m

    def _drive_lines(self, m, sources):
        """Connect the memory lines to whoever control gives them; the last has them otherwise."""
        lines = self.right.lines
        requests = [name for name in lines.signature.members
                    if lines.signature.members[name].flow == Out]
        for _, source in sources:
            m.d.comb += [
                source.read_busy.eq(lines.read_busy),
                source.read_data.eq(lines.read_data),
                source.write_busy.eq(lines.write_busy),
            ]
        chosen = m.If
        for select, source in sources:
            with m.Else() if select is None else chosen(select):
                m.d.comb += [getattr(lines, name).eq(getattr(source, name)) for name in requests]
            chosen = m.Elif

    def _count(self, m, control, depth_test):
        """Work since the frame start, whose clear also restarts the counts."""
        fragments, busy_cycles = Signal(COUNTER_BITS), Signal(COUNTER_BITS)
        taken = depth_test.fragments.valid & depth_test.fragments.ready
        m.d.sync += [
            fragments.eq(fragments + taken),
            busy_cycles.eq(busy_cycles + ~control.idle),
        ]
        with m.If(control.clear_start):
            m.d.sync += [fragments.eq(0), busy_cycles.eq(0)]
        m.d.comb += [control.fragments.eq(fragments), control.busy_cycles.eq(busy_cycles)]
