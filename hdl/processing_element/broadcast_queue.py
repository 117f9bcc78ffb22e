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
    row_shape,
    walked_outline_layout,
)
from ..mapping.lattice import first_owned, lattice_layout, next_owned, rows_mask

__all__ = ["BroadcastQueue"]


class BroadcastQueue(wiring.Component):
    """Takes what concerns this processing element, and gives it back in order.

    A triangle whose bounding box holds no pixel of the lattice is passed over as
    it is announced, and costs nothing; where the domain is no single lattice all
    are kept.  Of a lattice with shifted rows, one whose box holds their columns is
    kept, in whichever row.  Rows and edges wait apart from the interpolants: those
    are needed later, pixel by pixel, and stay at their output until a triangle's
    last one.

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
        The pixels of the domain, where it is one block of units.
    triangles: Out(stream of walked_outline_layout)
    planes: Out(stream of planes_layout)
        Of the triangles, each at least as early as its outline.
    operations: Out(stream of Operation)
        What is no triangle; all triangles before it, and their interpolants, have been taken.
    empty: Out(1)
        Nothing waits.

    Fuchs & Johnson leave the processing elements waiting for one another with each
    polygon; these queues are what lets each of them go on.
    """

    latency = 3
    operation_latency = 2

    def __init__(self, *, configuration: MachineConfiguration):
        self.configuration = configuration
        super().__init__({
            "strobe": In(1),
            "packet": In(broadcast_layout(configuration)),
            "ready": Out(1),
            "lattice": In(lattice_layout(configuration)),
            "whole": In(1),
            "triangles": Out(stream.Signature(walked_outline_layout(configuration))),
            "planes": Out(stream.Signature(planes_layout(configuration))),
            "operations": Out(stream.Signature(Operation, payload_init=Operation.SURVEY)),
            "empty": Out(1),
        })

    def elaborate(self, platform):
        m = Module()
        configuration, packet = self.configuration, self.packet
        depth, square_bits = configuration.fifo_depth, configuration.square_bits
        # One place is the output register, into which a word moves a clock later: with two in all,
        # the second of two words in a row would find the other place taken.
        places = max(depth, 3)
        m.submodules.triangles = triangles = fifo.SyncFIFOBuffered(
            width=walked_outline_layout(configuration).size, depth=places)
        m.submodules.planes = planes = fifo.SyncFIFOBuffered(
            width=planes_layout(configuration).size, depth=places)

        triangle, lattice = packet.body.draw, self.lattice
        is_triangle = packet.operation == Operation.DRAW
        first_row = first_owned(triangle.top, lattice.y_offset, lattice.y_mask, square_bits)
        first_column = first_owned(triangle.left, lattice.x_offset,
                                   rows_mask(lattice, configuration), square_bits)
        kept = Signal(outline_layout(configuration), reset_less=True)
        kept_row = Signal(row_shape(configuration), reset_less=True)
        second_row = Signal(row_shape(configuration), reset_less=True)
        # The interpolants are the last field of a triangle: without them the rest is its start.
        outline = Value.cast(packet.body)[:outline_layout(configuration).size]
        assert len(outline) + planes_layout(configuration).size == triangle.shape().size

        arrived = Signal()
        in_rows = Signal()
        in_columns = Signal()
        waits = Signal()
        drained = Signal()
        operation = self.operations
        # A triangle's interpolants are there as long as its outline, and longer.
        m.d.sync += drained.eq((planes.level == 0) & ~self.strobe & ~arrived)
        m.d.sync += [
            arrived.eq(self.strobe & is_triangle),
            in_rows.eq(first_row < triangle.bottom),
            in_columns.eq(first_column < triangle.right),
            kept.eq(outline),
            kept_row.eq(first_row),
            planes.w_data.eq(triangle.planes),
        ]
        m.d.comb += [
            second_row.eq(next_owned(kept_row, lattice.y_mask, square_bits)),
            triangles.w_data.eq(Cat(kept, kept_row, second_row, second_row >= kept.bottom)),
        ]
        with m.If(self.strobe & ~is_triangle):
            m.d.sync += [waits.eq(1), operation.payload.eq(packet.operation)]
        with m.Elif(operation.valid & operation.ready):
            m.d.sync += waits.eq(0)
        m.d.comb += [
            # Room for this word and for one that has just arrived.
            self.ready.eq((planes.level < depth - 1) & ~waits),
            triangles.w_en.eq(arrived & (~self.whole | (in_rows & in_columns))),
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
