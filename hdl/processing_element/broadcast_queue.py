"""What a processing element was told and has not done yet."""

from amaranth.hdl import *
from amaranth.lib import fifo, stream, wiring
from amaranth.lib.wiring import In, Out

from ...golden.specification.configuration import MachineConfiguration
from ..backplane.words import (
    Operation,
    broadcast_layout,
    outline_layout,
    planes_layout,
    walked_outline_layout,
)
from ..regions.region_filter import RegionFilter
from .share_filter import ShareFilter

__all__ = ["BroadcastQueue"]


class BroadcastQueue(wiring.Component):
    """Takes what concerns this processing element, and gives it back in order.

    A triangle that ``ShareFilter`` drops, or ``RegionFilter``, is passed over as it is
    announced, and costs nothing.  Rows and edges wait apart from the interpolants: those are
    needed later, pixel by pixel, and stay at their output until a triangle's last one.

    Anything but a triangle waits in a place of its own.  Nothing is taken behind it
    until it is gone, so it comes after the triangles before it and before those
    after it; and what looks after such operations is not in the triangles' way.

    Latency: ``latency`` clocks; ``operation_latency`` for what finds the queue empty.
    Throughput: a triangle a clock.

    Members
    -------
    strobe: In(1), packet: In(broadcast_layout)
        A broadcast word, only while ``ready``.
    ready: Out(1)
        There is room.
    lattice: In(lattice_layout), whole: In(1)
        The pixels of the domain, where it is one block of units (``ShareFilter``).
    regions: In(RegionLines), element: In(element_bits)
        In the place of those where regions are dealt out (``RegionFilter``).
    triangles: Out(stream of walked_outline_layout)
    planes: Out(stream of planes_layout)
        The triangles' interpolants, each at least as early as its outline.
    operations: Out(stream of Operation)
        Whatever is no triangle; all triangles before it, and their interpolants, have been taken.
    empty: Out(1)
        Nothing waits.

    Fuchs & Johnson leave the processing elements waiting for one another with each
    polygon; these queues are what lets each of them go on.
    """

    latency = 3
    operation_latency = 2

    def __init__(self, *, configuration: MachineConfiguration):
        self.configuration = configuration
        kind = ShareFilter if configuration.regions is None else RegionFilter
        self._filter = kind(configuration=configuration)
        super().__init__({
            "strobe": In(1),
            "packet": In(broadcast_layout(configuration)),
            "ready": Out(1),
            **self._filter.members,
            "triangles": Out(stream.Signature(walked_outline_layout(configuration))),
            "planes": Out(stream.Signature(planes_layout(configuration))),
            "operations": Out(stream.Signature(Operation, payload_init=Operation.SURVEY)),
            "empty": Out(1),
        })

    def elaborate(self, platform):
        m = Module()
        configuration, packet = self.configuration, self.packet
        depth = configuration.fifo_depth
        # One place is the output register, into which a word moves a clock later: with two in all,
        # the second of two words in a row would find the other place taken.
        places = max(depth, 3)
        m.submodules.triangles = triangles = fifo.SyncFIFOBuffered(
            width=walked_outline_layout(configuration).size, depth=places)
        m.submodules.planes = planes = fifo.SyncFIFOBuffered(
            width=planes_layout(configuration).size, depth=places)

        triangle = packet.body.draw
        is_triangle = packet.operation == Operation.DRAW
        kept = Signal(outline_layout(configuration), reset_less=True)
        # The interpolants follow on the outline, and after them only the node, which is this one.
        outline = Value.cast(packet.body)[:outline_layout(configuration).size]
        assert (len(outline) + planes_layout(configuration).size + configuration.node_bits
                == triangle.shape().size)

        arrived = Signal()
        waits = Signal()
        drained = Signal()
        operation = self.operations
        # It is enough to look at the interpolants: they stay as long as the outline, and longer.
        m.d.sync += drained.eq((planes.level == 0) & ~self.strobe & ~arrived)
        m.d.sync += arrived.eq(self.strobe & is_triangle)
        share = self._filter.add_to(m, triangle, self)
        assert self._filter.latency == 1  # that of `arrived` and `kept`
        m.d.sync += kept.eq(outline)
        known = self._filter.known(m, share, kept, self)
        m.d.sync += planes.w_data.eq(triangle.planes)
        m.d.comb += triangles.w_data.eq(Cat(kept, known))
        with m.If(self.strobe & ~is_triangle):
            m.d.sync += [waits.eq(1), operation.payload.eq(packet.operation)]
        with m.Elif(operation.valid & operation.ready):
            m.d.sync += waits.eq(0)
        m.d.comb += [
            # There must be room for a word that comes now and for one that has just arrived.
            self.ready.eq((planes.level < depth - 1) & ~waits),
            triangles.w_en.eq(arrived & share.keep),
            planes.w_en.eq(triangles.w_en),
            operation.valid.eq(waits & drained),
            self.empty.eq(~waits & drained),
        ]
        for queue, out in ((triangles, self.triangles), (planes, self.planes)):
            m.d.comb += [
                out.valid.eq(queue.r_rdy),
                out.payload.eq(queue.r_data),
                queue.r_en.eq(out.ready),
            ]
        return m
