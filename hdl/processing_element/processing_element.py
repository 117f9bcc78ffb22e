"""A processing element card: draws into the memory units to its right."""

from amaranth.hdl import *
from amaranth.lib import fifo, stream, wiring
from amaranth.lib.wiring import In, Out

from ...golden.specification.activity import ACTIVITY_BITS
from ...golden.specification.commands import RESPONSE_VALUE_BITS
from ...golden.specification.configuration import MachineConfiguration
from ...golden.specification.queues import SPANS_WAITING, depth_lanes
from ..backplane.connectors import BroadcastLines, Connector, memory_bus_bits
from ..backplane.response_link import ResponseLink
from ..backplane.words import span_layout
from ..depth_test.one_port import OnePortDepthTest
from ..depth_test.two_ports import TwoPortDepthTest
from ..mapping.interlace import PixelAddress
from ..observer import ElementActivity
from ..rasteriser.fragment_stepper import FragmentStepper
from ..rasteriser.interpolator import Interpolator, fragment_layout
from ..rasteriser.triangle_spans import TriangleSpans
from ..wires import wires
from .broadcast_queue import BroadcastQueue
from .control import ProcessingElementControl
from .depth_read_back import DepthReadBack
from .memory_bus_selector import MemoryBusSelector
from .merge_input import MergeInput
from .survey import Survey

__all__ = ["ProcessingElement"]

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

    It drives the memory bus to its right and ignores the one from its left; the ID and
    the responses pass through.

    Latency: from a triangle's strobe to the read of its first fragment ``latency``
    clocks.  Throughput: a fragment a clock while ports are free: rows are found
    ahead, at one a clock, triangle after triangle.  Units with two ports take a
    fragment a clock.  In units with one port a visible fragment takes two accesses, so
    two clocks on one unit; on two it takes one where fragments alternate between them,
    within the few that wait; these also bridge rows without pixels (``OnePortDepthTest``).

    Members
    -------
    left: In(Connector), right: Out(Connector)
    total: In(id_bits)
        Number of memory units in the cage.
    broadcast: In(BroadcastLines)
    merge: In(stream of fragment_layout)
        What its node receives, only where nodes merge in a tree; nothing is drawn then
        (``MergeInput``).
    activity: Out(4)
        What it does in this clock; only where the configuration says ``observe``.
    """

    def __init__(self, *, configuration: MachineConfiguration):
        self.configuration = configuration
        bits = memory_bus_bits(configuration)
        self.depth_test = (OnePortDepthTest(**bits, lanes=depth_lanes(configuration))
                           if configuration.memory_ports == 1 else TwoPortDepthTest(**bits))
        self._queue = BroadcastQueue(configuration=configuration)
        self._control = ProcessingElementControl(id_bits=configuration.id_bits,
                                                 depth_bits=configuration.rank_bits,
                                                 order_bits=configuration.order_bits)
        self._rasteriser = TriangleSpans(configuration=configuration)
        self._spans = fifo.SyncFIFO(width=span_layout(configuration).size, depth=SPANS_WAITING)
        self._stepper = FragmentStepper(configuration=configuration)
        self._interpolator = Interpolator(configuration=configuration)
        self._survey = Survey(**bits)
        self._read_back = DepthReadBack(**bits)
        self._link = ResponseLink()
        self._picture = PixelAddress(configuration=configuration)
        self._selector = MemoryBusSelector(**bits)
        self._merge = MergeInput(**bits) if configuration.sends_drawn else None
        super().__init__({
            "left": In(Connector(configuration)),
            "right": Out(Connector(configuration)),
            "total": In(configuration.id_bits),
            "broadcast": In(BroadcastLines(configuration)),
            **({"merge": In(stream.Signature(fragment_layout(**bits)))}
               if self._merge is not None else {}),
            **({"activity": Out(ACTIVITY_BITS)} if configuration.observe else {}),
        })

    @property
    def latency(self) -> int:
        return (BroadcastQueue.latency + TriangleSpans.latency + SPANS_LATENCY
                + FragmentStepper.latency + Interpolator.latency + self.depth_test.waiting)

    def elaborate(self, platform):
        m = Module()
        m.submodules.queue = self._queue
        m.submodules.control = self._control
        m.submodules.walker = self._rasteriser
        m.submodules.spans = self._spans
        m.submodules.stepper = self._stepper
        m.submodules.interpolator = self._interpolator
        m.submodules.depth_test = self.depth_test
        m.submodules.survey = self._survey
        m.submodules.read_back = self._read_back
        m.submodules.link = self._link
        m.submodules.picture = self._picture
        self._connect_broadcast(wires(m, "operation_wires"))
        self._connect_drawing(m, wires(m, "drawing_wires"))
        self._connect_domain(wires(m, "domain_wires"))
        self._connect_services(wires(m, "service_wires"))
        m.submodules.selector = self._selector
        self._connect_memory_bus(wires(m, "line_wires"))
        self._count(m)
        if self.configuration.observe:
            self._observe(m)
        self._connect_responses(wires(m, "response_wires"))
        return m

    def _connect_broadcast(self, m):
        """From the broadcast to the operations."""
        queue, rasteriser = self._queue, self._rasteriser
        m.d.comb += [
            queue.strobe.eq(self.broadcast.strobe),
            queue.packet.eq(self.broadcast.packet),
            self.broadcast.ready.eq(queue.ready),
            queue.lattice.eq(rasteriser.lattice),
            queue.whole.eq(rasteriser.whole),
        ]
        wiring.connect(m, queue.operations, self._control.operations)

    def _connect_drawing(self, m, pipeline):
        """The pipeline from the queue to the depth test; connections in ``pipeline``."""
        queue, rasteriser, spans = self._queue, self._rasteriser, self._spans
        stepper, interpolator, depth_test = self._stepper, self._interpolator, self.depth_test
        # `room` is registered because it fans out widely, so one place stays free for the span
        # arriving now.
        room = Signal()
        m.d.sync += room.eq(spans.level < SPANS_WAITING - 1)
        pipeline.d.comb += [
            spans.w_en.eq(rasteriser.spans.valid & room),
            spans.w_data.eq(rasteriser.spans.payload),
            rasteriser.spans.ready.eq(room),
            stepper.spans.valid.eq(spans.r_rdy),
            stepper.spans.payload.eq(spans.r_data),
            spans.r_en.eq(stepper.spans.ready),
        ]
        # `drawing` is a clock late; the queue says that a triangle comes as early as it can, so
        # that it is high from the clock after that on.
        drawing = Signal()
        m.d.sync += drawing.eq(queue.triangles.valid | rasteriser.busy | (spans.level != 0)
                               | stepper.busy | interpolator.busy | depth_test.busy)
        m.d.comb += self._control.drawing.eq(drawing)
        wiring.connect(pipeline, queue.triangles, rasteriser.triangles)
        wiring.connect(pipeline, queue.planes, interpolator.planes)
        wiring.connect(pipeline, stepper.pixels, interpolator.pixels)
        if self._merge is None:
            wiring.connect(pipeline, interpolator.fragments, depth_test.fragments)
        else:
            self._connect_merge(m, pipeline, self._merge)

    def _connect_merge(self, m, pipeline, merge):
        """What the node receives goes to the depth test when nothing is drawn."""
        m.submodules.merge_input = merge
        wiring.connect(pipeline, self._interpolator.fragments, merge.drawn)
        wiring.connect(pipeline, merge.fragments, self.depth_test.fragments)
        wiring.connect(pipeline, wiring.flipped(self.merge), merge.received)
        pipeline.d.comb += [
            merge.first.eq(self.left.id),
            merge.end.eq(self._survey.end),
            merge.frame_start.eq(self._control.frame_start),
        ]

    @property
    def _drawn(self):
        """The fragments that the element draws itself."""
        return self.depth_test.fragments if self._merge is None else self._merge.drawn

    def _connect_domain(self, m):
        """First unit from the ID lines, upper end from the survey."""
        if self.configuration.node_bits:
            m.d.comb += self.right.node.eq(self.left.node)
        rasteriser, interpolator, picture = self._rasteriser, self._interpolator, self._picture
        survey, read_back, control = self._survey, self._read_back, self._control
        first, end = self.left.id, survey.end
        m.d.comb += [self.right.id.eq(first), picture.total.eq(self.total),
                     rasteriser.width.eq(picture.width)]
        m.d.comb += [part.total.eq(self.total) for part in (rasteriser, interpolator, survey)]
        m.d.comb += [part.first.eq(first) for part in (rasteriser, survey, read_back, control)]
        m.d.comb += [part.end.eq(end) for part in (rasteriser, read_back, control)]
        m.d.comb += read_back.last_word.eq(picture.last_word)

    def _connect_services(self, m):
        """Survey and read-back, and whether one of them has the memory bus."""
        control, selector = self._control, self._selector
        for name, part in (("survey", self._survey), ("read_back", self._read_back)):
            m.d.comb += [
                part.start.eq(getattr(control, f"{name}_start")),
                getattr(control, f"{name}_done").eq(part.done),
            ]
        wiring.connect(m, self._read_back.depths, control.depths)
        m.d.comb += [selector.surveying.eq(control.surveying),
                     selector.reading.eq(control.reading)]

    def _connect_memory_bus(self, m):
        selector = self._selector
        wiring.connect(m, self._survey.memory, selector.survey)
        wiring.connect(m, self._read_back.memory, selector.read_back)
        wiring.connect(m, self.depth_test.memory, selector.depth_test)
        wiring.connect(m, selector.lines, wiring.flipped(self.right.lines))

    def _connect_responses(self, m):
        """The chain of responses; nothing from the right passes while this card has work."""
        queue, control, link = self._queue, self._control, self._link
        wiring.connect(m, control.responses, link.own)
        wiring.connect(m, wiring.flipped(self.right.response), link.right)
        wiring.connect(m, link.left, wiring.flipped(self.left.response))
        quiet = queue.empty & control.idle
        m.d.comb += [
            link.own_turn.eq(~quiet),
            self.broadcast.done.eq(quiet & ~link.left.valid),
        ]

    def _count(self, m):
        """Work since the frame start."""
        control, arriving, drawing = self._control, self._drawn, self._control.drawing
        if self._merge is not None:
            drawing &= ~self._merge.merging
        fragments = Signal(RESPONSE_VALUE_BITS)
        busy_cycles = Signal(RESPONSE_VALUE_BITS)
        m.d.sync += [
            fragments.eq(fragments + (arriving.valid & arriving.ready)),
            busy_cycles.eq(busy_cycles + drawing),
        ]
        with m.If(control.frame_start):
            m.d.sync += [fragments.eq(0), busy_cycles.eq(0)]
        m.d.comb += [control.fragments.eq(fragments), control.busy_cycles.eq(busy_cycles)]

    def _observe(self, m):
        """Listens to the rasteriser and, some clocks further on, to the depth test."""
        rasteriser, control = self._rasteriser, self._control
        m.submodules.observer = observer = ElementActivity(
            delay=SPANS_LATENCY + FragmentStepper.latency + Interpolator.latency)
        fragments, scanned = self._drawn, self.right.lines.scanned
        m.d.comb += [
            observer.offered.eq(fragments.valid),
            observer.taken.eq(fragments.valid & fragments.ready),
            observer.scanned.eq(scanned.bit_select(fragments.payload.unit[0], 1)),
            observer.preparing.eq(rasteriser.preparing),
            observer.empty_row.eq(rasteriser.empty_row),
            observer.walking.eq(rasteriser.busy),
            observer.service.eq(~control.idle & ~control.drawing),
            self.activity.eq(observer.activity),
        ]
