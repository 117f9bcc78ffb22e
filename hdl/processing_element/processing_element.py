"""A processing element card: draws into the memory units to its right."""

from amaranth.hdl import *
from amaranth.lib import fifo, wiring
from amaranth.lib.wiring import In, Out

from ...golden.specification.activity import ACTIVITY_BITS
from ...golden.specification.configuration import MachineConfiguration
from ..backplane.connectors import BroadcastLines, Connector
from ..backplane.response_link import ResponseLink
from ..backplane.words import span_layout
from ..depth_test.one_port import OnePortDepthTest
from ..depth_test.two_ports import TwoPortDepthTest
from ..mapping.interlace import PixelAddress
from ..observer import ElementActivity
from ..rasteriser.fragment_stepper import FragmentStepper
from ..rasteriser.interpolator import Interpolator
from ..rasteriser.triangle_spans import TriangleSpans
from ..wires import wires
from .broadcast_queue import BroadcastQueue
from .control import ProcessingElementControl
from .depth_read_back import DepthReadBack
from .memory_bus_selector import MemoryBusSelector
from .survey import Survey

__all__ = ["ProcessingElement"]

COUNTER_BITS = 32

#: Spans found ahead, so that rows of few pixels hide behind longer ones.
SPANS_WAITING = 16
SPANS_LATENCY = 1


class ProcessingElement(wiring.Component):
    """Owns the memory units up to the next processing element (figure 12).

    ::

        broadcast ─▶ queue ─▶ control ─▶ TriangleSpans ─▶ FIFO ─▶ FragmentStepper ─▶ Interpolator
                                │                                                        │
                                │                                                   depth test
                                ├─▶ Survey, DepthReadBack ─────────────────────────────▶ ┤
                                ▼                                                        ▼
                          response link ◀── from the right       memory bus to the right

    It drives the lines to its right and ignores those from its left; the ID and
    the responses pass through.

    Latency: from a triangle's strobe to the read of its first fragment ``latency``
    clocks.  Throughput: a fragment a clock while ports are free: rows are found
    ahead, at one a clock, triangle after triangle.  Units of two ports take a
    fragment a clock.  Of one port, a visible fragment takes two accesses, so two
    clocks on one unit; on two it takes one where fragments alternate between them,
    within the few that wait; these also bridge rows without pixels (``OnePortDepthTest``).

    Members
    -------
    left: In(Connector), right: Out(Connector)
    total: In(id_bits)
        Number of memory units in the cage.
    broadcast: In(BroadcastLines)
    activity: Out(4)
        What it does in this clock; only where the configuration says ``observe``.
    """

    def __init__(self, *, configuration: MachineConfiguration):
        self.configuration = configuration
        kind = {1: OnePortDepthTest, 2: TwoPortDepthTest}[configuration.memory_ports]
        self.depth_test = kind(configuration=configuration)
        super().__init__({
            "left": In(Connector(configuration)),
            "right": Out(Connector(configuration)),
            "total": In(configuration.id_bits),
            "broadcast": In(BroadcastLines(configuration)),
            **({"activity": Out(ACTIVITY_BITS)} if configuration.observe else {}),
        })

    @property
    def latency(self) -> int:
        return (BroadcastQueue.latency + TriangleSpans.latency + SPANS_LATENCY
                + FragmentStepper.latency + Interpolator.latency + self.depth_test.waiting)

    def elaborate(self, platform):
        m = Module()
        configuration = self.configuration
        m.submodules.queue = queue = BroadcastQueue(configuration=configuration)
        m.submodules.control = control = ProcessingElementControl(configuration=configuration)
        m.submodules.walker = walker = TriangleSpans(configuration=configuration)
        m.submodules.spans = spans = fifo.SyncFIFO(
            width=span_layout(configuration).size, depth=SPANS_WAITING)
        m.submodules.stepper = stepper = FragmentStepper(configuration=configuration)
        m.submodules.interpolator = interpolator = Interpolator(configuration=configuration)
        m.submodules.depth_test = depth_test = self.depth_test
        m.submodules.survey = survey = Survey(configuration=configuration)
        m.submodules.read_back = read_back = DepthReadBack(configuration=configuration)
        m.submodules.link = link = ResponseLink()
        m.submodules.picture = picture = PixelAddress(configuration=configuration)

        # From the broadcast to the operations.
        operations = wires(m, "operation_wires")
        operations.d.comb += [
            queue.strobe.eq(self.broadcast.strobe),
            queue.packet.eq(self.broadcast.packet),
            self.broadcast.ready.eq(queue.ready),
            queue.lattice.eq(walker.lattice),
            queue.whole.eq(walker.whole),
        ]
        wiring.connect(operations, queue.operations, control.operations)

        # The drawing pipeline.
        pipeline = wires(m, "drawing_wires")
        # Said a clock ahead, with a place for the span of this clock: many wait for it.
        room = Signal()
        m.d.sync += room.eq(spans.level < SPANS_WAITING - 1)
        pipeline.d.comb += [
            spans.w_en.eq(walker.spans.valid & room),
            spans.w_data.eq(walker.spans.payload),
            walker.spans.ready.eq(room),
            stepper.spans.valid.eq(spans.r_rdy),
            stepper.spans.payload.eq(spans.r_data),
            spans.r_en.eq(stepper.spans.ready),
        ]
        # A clock late, and from the first clock on in which a triangle comes.
        drawing = Signal()
        m.d.sync += drawing.eq(queue.triangles.valid | walker.busy | (spans.level != 0)
                               | stepper.busy | interpolator.busy | depth_test.busy)
        m.d.comb += control.drawing.eq(drawing)
        wiring.connect(pipeline, queue.triangles, walker.triangles)
        wiring.connect(pipeline, queue.planes, interpolator.planes)
        wiring.connect(pipeline, stepper.pixels, interpolator.pixels)
        wiring.connect(pipeline, interpolator.fragments, depth_test.fragments)

        # The domain: first unit from the lines, upper end from the survey.
        first, end = self.left.id, survey.end
        domain = wires(m, "domain_wires")
        domain.d.comb += [self.right.id.eq(first), picture.total.eq(self.total),
                          walker.width.eq(picture.width)]
        for part in (walker, interpolator, survey):
            domain.d.comb += part.total.eq(self.total)
        for part in (walker, survey, read_back, control):
            domain.d.comb += part.first.eq(first)
        for part in (walker, read_back, control):
            domain.d.comb += part.end.eq(end)
        domain.d.comb += read_back.last_word.eq(picture.last_word)

        # The services, and who has the memory lines.
        service = wires(m, "service_wires")
        for name, part in (("survey", survey), ("read_back", read_back)):
            service.d.comb += [
                part.start.eq(getattr(control, f"{name}_start")),
                getattr(control, f"{name}_done").eq(part.done),
            ]
        wiring.connect(service, read_back.depths, control.depths)
        m.submodules.selector = selector = MemoryBusSelector(configuration=configuration)
        service.d.comb += [selector.surveying.eq(control.surveying),
                           selector.reading.eq(control.reading)]
        lines = wires(m, "line_wires")
        for name, part in (("survey", survey), ("read_back", read_back),
                           ("depth_test", depth_test)):
            wiring.connect(lines, part.memory, getattr(selector, name))
        wiring.connect(lines, selector.lines, wiring.flipped(self.right.lines))
        self._count(m, control, depth_test)
        if configuration.observe:
            self._observe(m, control, walker, depth_test)

        responses = wires(m, "response_wires")
        wiring.connect(responses, control.responses, link.own)
        wiring.connect(responses, wiring.flipped(self.right.response), link.right)
        wiring.connect(responses, link.left, wiring.flipped(self.left.response))
        quiet = queue.empty & control.idle
        responses.d.comb += [
            link.own_turn.eq(~quiet),
            self.broadcast.done.eq(quiet & ~link.left.valid),
        ]
        return m

    def _count(self, m, control, depth_test):
        """Work since the frame start."""
        fragments = Signal(COUNTER_BITS)
        busy_cycles = Signal(COUNTER_BITS)
        taken = depth_test.fragments.valid & depth_test.fragments.ready
        m.d.sync += [
            fragments.eq(fragments + taken),
            busy_cycles.eq(busy_cycles + control.drawing),
        ]
        with m.If(control.frame_start):
            m.d.sync += [fragments.eq(0), busy_cycles.eq(0)]
        m.d.comb += [control.fragments.eq(fragments), control.busy_cycles.eq(busy_cycles)]

    def _observe(self, m, control, walker, depth_test):
        """Listens to the walker and the depth test, some clocks further on."""
        m.submodules.observer = observer = ElementActivity(
            delay=SPANS_LATENCY + FragmentStepper.latency + Interpolator.latency)
        fragments, lines = depth_test.fragments, self.right.lines
        m.d.comb += [
            observer.offered.eq(fragments.valid),
            observer.taken.eq(fragments.valid & fragments.ready),
            observer.scanned.eq(lines.scanned.bit_select(fragments.payload.unit[0], 1)),
            observer.preparing.eq(walker.preparing),
            observer.empty_row.eq(walker.empty_row),
            observer.walking.eq(walker.busy),
            observer.service.eq(~control.idle & ~control.drawing),
            self.activity.eq(observer.activity),
        ]
