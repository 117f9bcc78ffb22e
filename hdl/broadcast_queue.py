"""What a processing element was told and has not done yet."""

from amaranth.hdl import *
from amaranth.lib import fifo, stream, wiring
from amaranth.lib.wiring import In, Out

from ..golden.configuration import MachineConfiguration
from .lattice import first_owned, lattice_layout, rows_mask
from .layouts import Operation, broadcast_layout, operation_layout, outline_layout, planes_layout

__all__ = ["BroadcastQueue"]


class BroadcastQueue(wiring.Component):
    """Takes what concerns this processing element, and gives it back in order.

    A triangle whose bounding box holds no pixel of the lattice is passed over as
    it is announced, and costs nothing; where the domain is no single lattice all
    are kept.  Of a lattice with shifted rows, one whose box holds their columns is
    kept, in whichever row.  Rows and edges wait apart from the interpolants: those are needed
    later, span by span, and stay at their output until a triangle's last one.

    Latency: three clocks.  Throughput: a word a clock.

    Members
    -------
    strobe: In(1), packet: In(broadcast_layout)
        A broadcast word, only while ``ready``.
    ready: Out(1)
        There is room.
    lattice: In(lattice_layout), whole: In(1)
        The pixels of the domain, where it is one block of units.
    operations: Out(stream of operation_layout)
    planes: Out(stream of planes_layout)
        Of the triangles among the operations, each at least as early as its operation.
    empty: Out(1)
        No operation waits.

    Fuchs & Johnson leave the processing elements waiting for one another with each
    polygon; these queues are what lets each of them go on.
    """

    latency = 3

    def __init__(self, *, configuration: MachineConfiguration):
        self.configuration = configuration
        super().__init__({
            "strobe": In(1),
            "packet": In(broadcast_layout(configuration)),
            "ready": Out(1),
            "lattice": In(lattice_layout(configuration)),
            "whole": In(1),
            "operations": Out(stream.Signature(operation_layout(configuration))),
            "planes": Out(stream.Signature(planes_layout(configuration))),
            "empty": Out(1),
        })

    def elaborate(self, platform):
        m = Module()
        configuration, packet = self.configuration, self.packet
        depth, square_bits = configuration.fifo_depth, configuration.square_bits
        # One place is the output register, into which a word moves a clock later: with two in all,
        # the second of two words in a row would find the other place taken.
        places = max(depth, 3)
        m.submodules.operations = operations = fifo.SyncFIFOBuffered(
            width=operation_layout(configuration).size, depth=places)
        m.submodules.planes = planes = fifo.SyncFIFOBuffered(
            width=planes_layout(configuration).size, depth=places)

        triangle, lattice = packet.body.draw, self.lattice
        is_triangle = packet.operation == Operation.DRAW
        first_row = first_owned(triangle.top, lattice.y_offset, lattice.y_mask, square_bits)
        first_column = first_owned(triangle.left, lattice.x_offset,
                                   rows_mask(lattice, configuration), square_bits)
        # The interpolants are the last field of a triangle: without them the rest is its start.
        outline = Value.cast(packet.body)[:outline_layout(configuration).size]
        assert len(outline) + planes_layout(configuration).size == triangle.shape().size

        arrived, drawn, in_rows, in_columns = (
            Signal(name=name) for name in ("arrived", "drawn", "in_rows", "in_columns"))
        m.d.sync += [
            arrived.eq(self.strobe),
            drawn.eq(is_triangle),
            in_rows.eq(first_row < triangle.bottom),
            in_columns.eq(first_column < triangle.right),
            operations.w_data.eq(Cat(packet.operation, outline, first_row)),
            planes.w_data.eq(triangle.planes),
        ]
        m.d.comb += [
            # Room for this word and for one that has just arrived.
            self.ready.eq((operations.level < depth - 1) & (planes.level < depth - 1)),
            operations.w_en.eq(arrived & (~drawn | ~self.whole | (in_rows & in_columns))),
            planes.w_en.eq(operations.w_en & drawn),
            self.empty.eq((operations.level == 0) & ~arrived),
        ]
        for queue, out in ((operations, self.operations), (planes, self.planes)):
            m.d.comb += [
                out.valid.eq(queue.r_rdy),
                out.payload.eq(queue.r_data),
                queue.r_en.eq(out.ready),
            ]
        return m
