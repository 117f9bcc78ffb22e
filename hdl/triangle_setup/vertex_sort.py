"""The three vertices of a triangle from top to bottom."""

from amaranth.hdl import *
from amaranth.lib import data, wiring
from amaranth.lib.wiring import In, Out

from ...golden.specification import commands
from ...golden.specification.configuration import MachineConfiguration
from ...golden.specification.ranges import CHANNEL_BITS, COLOR_BITS
from ..arithmetic.delay import delayed
from ..backplane.words import struct_layout

__all__ = ["VertexSort", "interpolants", "share_member", "sorted_vertices_layout"]


def interpolants(configuration: MachineConfiguration) -> dict[str, int]:
    """What is interpolated over a triangle: name → bits of a vertex's value."""
    channels = () if configuration.shading == "flat" else commands.CHANNELS
    return {"depth": configuration.depth_bits, **dict.fromkeys(channels, CHANNEL_BITS)}


def sorted_vertices_layout(configuration: MachineConfiguration) -> data.StructLayout:
    """Vertices ``upper``, ``middle``, ``lower``: position and interpolated values.

    ``least_x``, ``greatest_x``  of the three
    ``color``                    vertex 0's, where nothing but depth is interpolated
    ``share``                    round and node, of a machine that wants them
    """
    coordinate = signed(configuration.coordinate_bits)
    vertex = data.StructLayout({"x": coordinate, "y": coordinate, **interpolants(configuration)})
    flat = COLOR_BITS if configuration.shading == "flat" else 0
    return data.StructLayout({"upper": vertex, "middle": vertex, "lower": vertex,
                              "least_x": coordinate, "greatest_x": coordinate, "color": flat,
                              **share_member(configuration)})


def share_member(configuration: MachineConfiguration) -> dict[str, int]:
    """What passes with a triangle through set-up, where merge cards end nodes: round and node."""
    bits = configuration.share_of_list_bits
    return {"share": bits} if bits else {}


class VertexSort(wiring.Component):
    """Sorts by y; vertices of the same y keep their order.

    Latency: ``latency`` clocks.  Throughput: a triangle a clock; nothing stalls.

    Members
    -------
    triangle: In(triangle_layout)
        Its vertices are in the order of the display list.
    vertices: Out(sorted_vertices_layout)
        They are sorted from top to bottom.
    """

    latency = 2

    def __init__(self, *, configuration: MachineConfiguration):
        self.configuration = configuration
        super().__init__({
            "triangle": In(struct_layout(commands.triangle_layout(configuration))),
            "vertices": Out(sorted_vertices_layout(configuration)),
        })

    def elaborate(self, platform):
        m = Module()
        output = self.vertices.shape()
        given = [self.triangle[f"vertex_{corner}"] for corner in range(3)]
        corners = []
        for number, vertex in enumerate(given):
            corner = Signal(output["upper"].shape, name=f"corner_{number}", reset_less=True)
            m.d.sync += [corner[name].eq(vertex[name]) for name in corner.shape().members]
            corners.append(corner)

        def after(axis):
            """Three bits: 0 comes after 1, 0 after 2, 1 after 2."""
            flags = Signal(3, name=f"{axis}_after", reset_less=True)
            m.d.sync += flags.eq(Cat(given[i][axis].as_signed() > given[j][axis].as_signed()
                                     for i, j in ((0, 1), (0, 2), (1, 2))))
            return flags

        def at(rank, flags, values):
            """The value whose vertex has that many before it."""
            ranks = (flags[0] + flags[1], ~flags[0] + flags[2], ~flags[1] + ~flags[2])
            first, second, third = values
            return Mux(ranks[0] == rank, first, Mux(ranks[1] == rank, second, third))

        along_y, along_x = after("y"), after("x")
        for rank, name in enumerate(("upper", "middle", "lower")):
            m.d.sync += Value.cast(self.vertices[name]).eq(
                at(rank, along_y, [Value.cast(corner) for corner in corners]))
        for rank, name in ((0, "least_x"), (2, "greatest_x")):
            m.d.sync += self.vertices[name].eq(at(rank, along_x, [corner.x for corner in corners]))
        if self.configuration.shading == "flat":
            color = Cat(given[0][name] for name in commands.CHANNELS)
            m.d.comb += self.vertices.color.eq(delayed(m, color, self.latency, "color"))
        if share_member(self.configuration):
            share = Cat(self.triangle[name] for name in ("round", "node")
                        if name in self.triangle.shape().members)
            m.d.comb += self.vertices.share.eq(delayed(m, share, self.latency, "share"))
        return m
