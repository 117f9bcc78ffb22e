"""What every processing element card is: from the broadcast to fragments, and its counts."""

from amaranth.hdl import *
from amaranth.lib import fifo, wiring

from ...golden.specification.activity import ACTIVITY_BITS
from ...golden.specification.commands import RESPONSE_VALUE_BITS
from ...golden.specification.configuration import MachineConfiguration
from ...golden.specification.queues import SPANS_WAITING
from ..backplane.response_link import ResponseLink
from ..backplane.words import span_layout
from ..mapping.interlace import PixelAddress
from ..observer import ElementActivity
from ..rasteriser.fragment_stepper import FragmentStepper
from ..rasteriser.interpolator import Interpolator
from ..rasteriser.triangle_spans import TriangleSpans
from ..regions.region_spans import RegionSpans
from .broadcast_queue import BroadcastQueue

__all__ = ["DrawingElement"]

SPANS_LATENCY = 1


class DrawingElement(wiring.Component):
    """The pipeline that draws, whatever becomes of its fragments.

    ::

        broadcast ─▶ queue ─▶ TriangleSpans ─▶ FIFO ─▶ FragmentStepper ─▶ Interpolator ─▶

    Where regions are dealt out ``RegionSpans`` are in the place of ``TriangleSpans``.

    A subclass adds what takes them, and a ``_control`` that does the operations: it has the members
    ``drawing``, ``frame_start``, ``fragments``, ``busy_cycles``, ``responses`` and ``idle`` of
    ``ProcessingElementControl``.

    Latency: from a triangle's strobe to the clock in which its first fragment is offered
    ``drawing_latency`` clocks.  Throughput: a fragment a clock: rows are found ahead, at one a
    clock, triangle after triangle.
    """

    drawing_latency = (BroadcastQueue.latency + TriangleSpans.latency + SPANS_LATENCY
                       + FragmentStepper.latency + Interpolator.latency)

    def __init__(self, signature: dict[str, wiring.Member], *,
                 configuration: MachineConfiguration):
        self.configuration = configuration
        self._queue = BroadcastQueue(configuration=configuration)
        dealt = configuration.regions is not None
        self._rasteriser = (RegionSpans if dealt else TriangleSpans)(configuration=configuration)
        self._spans = fifo.SyncFIFO(width=span_layout(configuration).size, depth=SPANS_WAITING)
        self._stepper = FragmentStepper(configuration=configuration)
        self._interpolator = Interpolator(configuration=configuration)
        self._link = ResponseLink()
        self._picture = None if dealt else PixelAddress(configuration=configuration)
        super().__init__({
            **signature,
            **({"activity": wiring.Out(ACTIVITY_BITS)} if configuration.observe else {}),
        })

    def _add_pipeline(self, m):
        m.submodules.queue = self._queue
        m.submodules.control = self._control
        m.submodules.walker = self._rasteriser
        m.submodules.spans = self._spans
        m.submodules.stepper = self._stepper
        m.submodules.interpolator = self._interpolator

    def _connect_broadcast(self, m, broadcast):
        """From the broadcast to the operations."""
        queue, rasteriser = self._queue, self._rasteriser
        m.d.comb += [
            queue.strobe.eq(broadcast.strobe),
            queue.packet.eq(broadcast.packet),
            broadcast.ready.eq(queue.ready),
        ]
        if self.configuration.regions is None:
            m.d.comb += [queue.lattice.eq(rasteriser.lattice), queue.whole.eq(rasteriser.whole)]
        wiring.connect(m, queue.operations, self._control.operations)

    def _connect_drawing(self, m, pipeline, *further_on):
        """The pipeline from the queue to the fragments; connections in ``pipeline``.
        ``further_on``: whoever takes the fragments is busy."""
        queue, rasteriser, spans = self._queue, self._rasteriser, self._spans
        stepper, interpolator = self._stepper, self._interpolator
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
        busy = (queue.triangles.valid | rasteriser.busy | (spans.level != 0)
                | stepper.busy | interpolator.busy)
        for each in further_on:
            busy |= each
        m.d.sync += drawing.eq(busy)
        m.d.comb += self._control.drawing.eq(drawing)
        wiring.connect(pipeline, queue.triangles, rasteriser.triangles)
        wiring.connect(pipeline, queue.planes, interpolator.planes)
        wiring.connect(pipeline, stepper.pixels, interpolator.pixels)

    def _connect_responses(self, m, broadcast):
        """The chain of responses; nothing from the right passes while this card has work."""
        queue, control, link = self._queue, self._control, self._link
        wiring.connect(m, control.responses, link.own)
        wiring.connect(m, wiring.flipped(self.right.response), link.right)
        wiring.connect(m, link.left, wiring.flipped(self.left.response))
        quiet = queue.empty & control.idle
        m.d.comb += [
            link.own_turn.eq(~quiet),
            broadcast.done.eq(quiet & ~link.left.valid),
        ]

    def _count(self, m, arriving, drawing):
        """Work since the frame start: fragments of the stream ``arriving``, clocks ``drawing``."""
        control = self._control
        fragments = Signal(RESPONSE_VALUE_BITS)
        busy_cycles = Signal(RESPONSE_VALUE_BITS)
        m.d.sync += [
            fragments.eq(fragments + (arriving.valid & arriving.ready)),
            busy_cycles.eq(busy_cycles + drawing),
        ]
        with m.If(control.frame_start):
            m.d.sync += [fragments.eq(0), busy_cycles.eq(0)]
        m.d.comb += [control.fragments.eq(fragments), control.busy_cycles.eq(busy_cycles)]

    def _observe(self, m, fragments, scanned):
        """Listens to the rasteriser and, some clocks further on, to who takes the ``fragments``;
        ``scanned``: the scan has the port that the fragment waits for."""
        rasteriser, control = self._rasteriser, self._control
        m.submodules.observer = observer = ElementActivity(
            delay=SPANS_LATENCY + FragmentStepper.latency + Interpolator.latency)
        m.d.comb += [
            observer.offered.eq(fragments.valid),
            observer.taken.eq(fragments.valid & fragments.ready),
            observer.scanned.eq(scanned),
            observer.preparing.eq(rasteriser.preparing),
            observer.empty_row.eq(rasteriser.empty_row),
            observer.walking.eq(rasteriser.busy),
            observer.service.eq(~control.idle & ~control.drawing),
            self.activity.eq(observer.activity),
        ]
