"""From vertices to outlines: what a triangle's increments are computed from, if it has pixels."""

from amaranth.hdl import *
from amaranth.lib import data, fifo, stream, wiring
from amaranth.lib.wiring import In, Out

from ...golden.specification import commands
from ...golden.specification.configuration import MachineConfiguration
from ...golden.specification.queues import OUTLINES_WAITING
from ...golden.specification.ranges import COLOR_BITS
from ..arithmetic.delay import delayed
from ..arithmetic.pipelined_multiplier import PipelinedMultiplier
from ..backplane.words import struct_layout
from .pixel_box import PixelBox, box_layout
from .sampling_grid import grid_layout
from .vertex_sort import VertexSort, interpolants, share_member

__all__ = ["TriangleOutline", "sorted_triangle_layout"]


def sorted_triangle_layout(configuration: MachineConfiguration) -> data.StructLayout:
    """A triangle that may cover a pixel centre, its vertices sorted; lengths in sub-pixel units.

    ``box``                    the pixels it may touch
    ``clockwise``              the way from upper over middle to lower is clockwise, as seen
    ``double_area``            positive
    ``x``, ``y``               position of the upper vertex
    ``middle_x``, ``middle_y`` from there to the middle vertex
    ``lower_x``, ``lower_y``   from there to the lower vertex
    ``values``                 for each interpolant ``upper``, the value there, and the rises from
                               there to the two others, ``first`` and ``second`` clockwise
    ``color``                  where nothing but depth is interpolated
    ``share``                  round and node, of a machine that wants them
    """
    bits = configuration.coordinate_bits
    values = {name: data.StructLayout({"upper": value, "first": signed(value + 1),
                                       "second": signed(value + 1)})
              for name, value in interpolants(configuration).items()}
    return data.StructLayout({
        "box": box_layout(grid_layout(configuration)),
        "clockwise": 1,
        "double_area": 2 * bits,
        "x": signed(bits), "y": signed(bits),
        # Of a difference one bit more than this would repeat the sign.
        "middle_x": signed(bits + 1), "middle_y": bits,
        "lower_x": signed(bits + 1), "lower_y": bits,
        "values": data.StructLayout(values),
        "color": COLOR_BITS if configuration.shading == "flat" else 0,
        **share_member(configuration),
    })


class TriangleOutline(wiring.Component):
    """Sorts the vertices, finds box and area, and drops what covers nothing.

    Triangles without area, or whose box holds no pixel centre, go no further, as in
    ``golden.reference.triangle_setup.prepare``.  The pipeline inside never waits: a triangle is
    taken only when the queue behind it has a place for it.

    Latency: ``latency`` clocks where nothing waits.  Throughput: a triangle a clock, kept or
    dropped.

    Members
    -------
    grid: In(grid_layout)
    triangles: In(stream of triangle_layout)
    outlines: Out(stream of sorted_triangle_layout)
        The triangles that are left, in order.
    busy: Out(1)
        Holds a triangle.

    Fuchs & Johnson, figure 12: the controller prepares a polygon while the last one is drawn.
    """

    queue_depth = OUTLINES_WAITING

    def __init__(self, *, configuration: MachineConfiguration):
        self.configuration = configuration
        self._sort = VertexSort(configuration=configuration)
        self._pixels = PixelBox(grid=grid_layout(configuration),
                                coordinate_bits=configuration.coordinate_bits,
                                sub_bits=configuration.sub_bits)
        difference = configuration.coordinate_bits + 1
        self._area = PipelinedMultiplier(a_bits=difference, b_bits=difference, pairs=2)
        super().__init__({
            "grid": In(grid_layout(configuration)),
            "triangles": In(stream.Signature(
                struct_layout(commands.triangle_layout(configuration)))),
            "outlines": Out(stream.Signature(sorted_triangle_layout(configuration))),
            "busy": Out(1),
        })

    @property
    def _judged(self) -> int:
        """Clocks until a triangle is kept or dropped: sorted, differences, area, its sign."""
        return self._sort.latency + 1 + self._area.latency + 1

    @property
    def latency(self) -> int:
        """Clocks from a triangle to its outline, two of them in the queue."""
        return self._judged + 2

    def elaborate(self, platform):
        m = Module()
        layout = sorted_triangle_layout(self.configuration)
        m.submodules.sort = sort = self._sort
        m.submodules.pixels = pixels = self._pixels
        m.submodules.area = area = self._area
        m.submodules.queue = queue = fifo.SyncFIFOBuffered(width=layout.size,
                                                           depth=self.queue_depth)
        m.d.comb += [sort.triangle.eq(self.triangles.payload), pixels.grid.eq(self.grid)]
        upper, middle, lower = sort.vertices.upper, sort.vertices.middle, sort.vertices.lower
        m.d.comb += [
            pixels.top.eq(upper.y), pixels.middle.eq(middle.y), pixels.bottom.eq(lower.y),
            pixels.left.eq(sort.vertices.least_x), pixels.right.eq(sort.vertices.greatest_x),
        ]

        # Differences, and beside the area's pipeline all that waits for its sign.
        outline = Signal(layout, reset_less=True)
        m.d.sync += [outline.x.eq(upper.x), outline.y.eq(upper.y),
                     outline.color.eq(sort.vertices.color)]
        m.d.sync += [outline[name].eq(sort.vertices[name])
                     for name in share_member(self.configuration)]
        for axis in "xy":
            m.d.sync += [outline[f"{name}_{axis}"].eq(vertex[axis] - upper[axis])
                         for name, vertex in (("middle", middle), ("lower", lower))]
        for name in interpolants(self.configuration):
            m.d.sync += [outline.values[name].upper.eq(upper[name]),
                         outline.values[name].first.eq(middle[name] - upper[name]),
                         outline.values[name].second.eq(lower[name] - upper[name])]
        m.d.comb += [
            area.a[0].eq(outline.middle_x), area.b[0].eq(outline.lower_y),
            area.a[1].eq(-outline.lower_x), area.b[1].eq(outline.middle_y),
        ]
        waiting = delayed(m, outline, area.latency, "outline")
        beside = 1 + area.latency - pixels.latency
        box = delayed(m, pixels.box, beside, "box")
        empty = delayed(m, pixels.empty, beside, "empty")

        # The area's sign tells the orientation, and which of the two others comes first.  What is
        # said of a triangle without area, >= or >, is the same: it is dropped.
        judged = Signal(layout, reset_less=True)
        clockwise = area.sum >= 0
        m.d.sync += [
            judged.eq(waiting),
            judged.box.eq(box),
            judged.clockwise.eq(clockwise),
            judged.double_area.eq(Mux(clockwise, area.sum, -area.sum)),
        ]
        with m.If(~clockwise):
            for name in interpolants(self.configuration):
                m.d.sync += [judged.values[name].first.eq(waiting.values[name].second),
                             judged.values[name].second.eq(waiting.values[name].first)]
        keep = Signal(reset_less=True)
        m.d.sync += keep.eq((area.sum != 0) & ~empty)

        # A place is taken with a triangle and free again when it is dropped or has left.
        taken = self.triangles.valid & self.triangles.ready
        arrived = delayed(m, taken, self._judged, "arrived", reset_less=False)
        places = Signal(range(self.queue_depth + 1), init=self.queue_depth)
        left = self.outlines.valid & self.outlines.ready
        m.d.comb += [
            self.triangles.ready.eq(places != 0),
            queue.w_en.eq(arrived & keep),
            queue.w_data.eq(judged),
            self.outlines.valid.eq(queue.r_rdy),
            self.outlines.payload.eq(queue.r_data),
            queue.r_en.eq(self.outlines.ready),
            self.busy.eq(places != self.queue_depth),
        ]
        m.d.sync += places.eq(places - taken + (arrived & ~keep) + left)
        return m
