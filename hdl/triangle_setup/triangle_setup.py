"""Triangle set-up in hardware: vertices in, increments out."""

from functools import reduce
from operator import and_

from amaranth.hdl import *
from amaranth.lib import data, fifo, stream, wiring
from amaranth.lib.wiring import In, Out

from ...golden.specification import commands
from ...golden.specification.configuration import MachineConfiguration
from ...golden.specification.ranges import CHANNEL_BITS
from ..arithmetic.delay import delayed
from ..backplane.words import prepared_triangle_layout, struct_layout
from .edge_setup import EdgeSetup, position_bits
from .outline import TriangleOutline, sorted_triangle_layout
from .plane_setup import PlaneSetup, Slot
from .result_queue import ResultQueue
from .sampling_grid import SamplingGrid
from .vertex_sort import interpolants, share_member

__all__ = ["TriangleSetup"]


class TriangleSetup(wiring.Component):
    """Prepares triangles, bit for bit as ``golden.reference.triangle_setup.prepare`` at this
    machine's resolution.

    ::

        vertices ─▶ TriangleOutline ─▶ outline ─▶ EdgeSetup ──────────────┐
                    drops what has        │                               ▼
                    no pixel              ├──▶ PlaneSetup, depth ──────▶ queues ─▶ triangles
                                          ├──▶ PlaneSetup, a channel ─────▲
                                          └──▶ box, colour ───────────────┘

    An outline stays for three slots: in each its next edge, and of each interpolant the next of
    step_x, step_y and start, begin their way through a divider.  Nothing on that way ever waits;
    an outline is let in only when the queues have a place for its results, which wait there for
    each other and to be taken.

    Latency: ``latency`` clocks where nothing waits.  Throughput: a triangle every ``interval``
    clocks, three divisions; one that is dropped takes a clock at the input and none behind.

    Members
    -------
    total: In(id_bits)
        Number of memory units; static while triangles come.
    vertices: In(stream of triangle_layout)
        As in the display list.
    triangles: Out(stream of prepared_triangle_layout)
        In the same order.
    busy: Out(1)
        Holds a triangle.

    Fuchs & Johnson, figure 13 and the text after it: the controller computes the increments
    while the processing elements work on the previous polygon.
    """

    #: Clocks between two triangles that wait to be taken.
    leaving = 2

    def __init__(self, *, configuration: MachineConfiguration):
        self.configuration = c = configuration
        self._outlines = TriangleOutline(configuration=c)
        self._edges = EdgeSetup(configuration=c)
        words = {"depth": c.depth_plane_bits,
                 **dict.fromkeys(commands.CHANNELS, c.channel_plane_bits)}
        self._planes = {name: PlaneSetup(configuration=c, value_bits=bits, word_bits=words[name])
                        for name, bits in interpolants(c).items()}
        super().__init__({
            "total": In(c.id_bits),
            "vertices": In(stream.Signature(struct_layout(commands.triangle_layout(c)))),
            "triangles": Out(stream.Signature(prepared_triangle_layout(c))),
            "busy": Out(1),
        })

    @property
    def slot_clocks(self) -> int:
        """Clocks of a slot: those of the slowest division."""
        return max(part.interval for part in (self._edges, *self._planes.values()))

    @property
    def interval(self) -> int:
        """Clocks between two triangles that are not dropped."""
        return Slot.COUNT * self.slot_clocks

    @property
    def preparation(self) -> int:
        """Clocks from an outline to its triangle: taken, first to last slot, inputs, results,
        queues, pop, output."""
        results = max(part.latency for part in (self._edges, *self._planes.values()))
        return 1 + (Slot.COUNT - 1) * self.slot_clocks + 1 + results + ResultQueue.latency + 2

    @property
    def latency(self) -> int:
        """Clocks from vertices to the triangle."""
        return self._outlines.latency + self.preparation

    @property
    def depth(self) -> int:
        """Triangles on their way from outline to the queues' end: so many that no slot is lost."""
        return -(-self.preparation // self.interval) + 1

    def elaborate(self, platform):
        m = Module()
        m.submodules.sampling_grid = sampling = SamplingGrid(configuration=self.configuration)
        m.submodules.outlines = outlines = self._outlines
        m.d.comb += [sampling.total.eq(self.total), outlines.grid.eq(sampling.grid)]
        wiring.connect(m, wiring.flipped(self.vertices), outlines.triangles)

        # The outline that is in its slots, and how many are in or behind them.
        outline = Signal(sorted_triangle_layout(self.configuration), reset_less=True)
        active = Signal()
        slot = Signal(range(Slot.COUNT))
        clock = Signal(range(self.slot_clocks))
        inside = Signal(range(self.depth + 1))
        begin = Signal()
        ends = Signal()
        pop = Signal()
        entering = outlines.outlines.valid & outlines.outlines.ready
        slot_ends = clock == self.slot_clocks - 1
        m.d.comb += [
            begin.eq(active & (clock == 0)),
            ends.eq(active & slot_ends & (slot == Slot.COUNT - 1)),
            outlines.outlines.ready.eq((~active | ends) & (inside != self.depth)),
            self.busy.eq(outlines.busy | (inside != 0) | self.triangles.valid),
        ]
        m.d.sync += inside.eq(inside + entering - pop)
        with m.If(active):
            m.d.sync += clock.eq(Mux(slot_ends, 0, clock + 1))
            with m.If(slot_ends):
                m.d.sync += slot.eq(slot + 1)
        with m.If(entering):
            m.d.sync += [outline.eq(outlines.outlines.payload), active.eq(1), slot.eq(0)]
        with m.Elif(ends):
            m.d.sync += active.eq(0)

        grid = sampling.grid
        lengths = self._lengths(m, outline, grid)
        begun = delayed(m, begin, 1, "begun", reset_less=False)
        self._start_edges(m, outline, slot, begun, grid, lengths)
        self._start_planes(m, outline, slot, begun, grid, lengths)
        self._collect(m, outline, begin & (slot == 0), pop)
        return m

    def _lengths(self, m, outline, grid):
        """From the upper vertex to the centres of the box's corner, and from the middle one down
        to that of its row; in sub-pixel units."""
        sub_bits = self.configuration.sub_bits

        def centre(pixel, shift):
            return (Cat(C(1, 1), pixel) << (sub_bits - 1)) << shift

        def difference(name, value):
            signal = Signal(signed(self.configuration.coordinate_bits + 1), name=name)
            m.d.comb += signal.eq(value)
            return signal

        box = outline.box
        return (difference("corner_x", centre(box.left, grid.x_shift) - outline.x),
                difference("corner_y", centre(box.top, grid.y_shift) - outline.y),
                difference("middle_row", centre(box.middle, grid.y_shift)
                           - (outline.y + outline.middle_y)))

    def _start_edges(self, m, outline, slot, begun, grid, lengths):
        """Long, upper and lower edge in their slots, through a register."""
        m.submodules.edges = edges = self._edges
        box = outline.box
        _, corner_y, middle_row = lengths
        half = C(1 << (self.configuration.sub_bits - 1)) << grid.x_shift
        m.d.comb += [edges.grid.eq(grid), edges.begin.eq(begun)]
        begin_x = Signal(signed(position_bits(self.configuration) + 1))
        m.d.comb += begin_x.eq(outline.x - half)
        for place, (x, run, height, distance, rows) in enumerate((
            (begin_x, outline.lower_x, outline.lower_y, corner_y, C(1)),
            (begin_x, outline.middle_x, outline.middle_y, corner_y, box.top != box.middle),
            (begin_x + outline.middle_x, outline.lower_x - outline.middle_x,
             outline.lower_y - outline.middle_y, middle_row, box.middle != box.bottom),
        )):
            with m.If(slot == place):
                m.d.sync += [edges.x.eq(x), edges.run.eq(run), edges.height.eq(height),
                             edges.distance.eq(distance)]
                with m.If(~rows):  # an edge without rows is 0 / 1 everywhere
                    m.d.sync += [edges.x.eq(0), edges.run.eq(0), edges.height.eq(1)]

    def _start_planes(self, m, outline, slot, begun, grid, lengths):
        """The factors of each slot, through a register; the same for all interpolants."""
        later = delayed(m, slot, 1, "plane_slot")
        corner_x, corner_y, _ = lengths

        def clockwise(one, other):
            """The way from the upper vertex to ``one`` where the triangle runs clockwise, else to
            ``other``."""
            return {axis: Mux(outline.clockwise, outline[f"{one}_{axis}"],
                              outline[f"{other}_{axis}"]) for axis in "xy"}

        first = clockwise("middle", "lower")
        second = clockwise("lower", "middle")
        along_x = slot == Slot.STEP_X
        difference = signed(self.configuration.coordinate_bits + 1)
        factor_1 = Signal(difference, reset_less=True)
        factor_2 = Signal(difference, reset_less=True)
        offset = Signal(difference, reset_less=True)
        m.d.sync += [
            factor_1.eq(Mux(along_x, second["y"], -second["x"])),
            factor_2.eq(Mux(along_x, -first["y"], first["x"])),
            offset.eq(Mux(along_x, corner_x, corner_y)),
        ]
        area = delayed(m, outline.double_area, 1, "area")
        for name, plane in self._planes.items():
            m.submodules[f"{name}_plane"] = plane
            m.d.comb += [
                plane.grid.eq(grid), plane.start.eq(begun), plane.slot.eq(later),
                plane.factor_1.eq(factor_1), plane.factor_2.eq(factor_2), plane.offset.eq(offset),
                plane.double_area.eq(area),
            ]
            m.d.sync += [getattr(plane, part).eq(outline.values[name][part])
                         for part in ("upper", "first", "second")]

    def _share(self, triangle):
        """Where round and node are, in that order."""
        return [*([triangle.planes.round] if self.configuration.round_bits else []),
                *([triangle.node] if self.configuration.node_bits else [])]

    def _collect(self, m, outline, enter, pop):
        """Queues of all results; when each has its part they are popped into the output register.

        That each has its part is registered, since the queues lie far apart, and they are popped
        in the next clock: at most every other clock, which is sooner than triangles come.
        """
        triangle = Signal(self.triangles.payload.shape())
        head = data.StructLayout({"box": outline.box.shape(), "clockwise": 1,
                                  "color": outline.color.shape(),
                                  **share_member(self.configuration)})
        m.submodules.head_queue = heads = fifo.SyncFIFOBuffered(width=head.size, depth=self.depth)
        popped = data.View(head, heads.r_data)
        m.d.comb += [
            heads.w_en.eq(enter),
            heads.w_data.eq(Cat(outline[name] for name in head.members)),
            heads.r_en.eq(pop),
            triangle.long_edge_left.eq(popped.clockwise),
        ]
        m.d.comb += [triangle[name].eq(popped.box[name]) for name in popped.box.shape().members]
        if share_member(self.configuration):
            m.d.comb += Cat(self._share(triangle)).eq(popped.share)
        for place, channel in enumerate(commands.CHANNELS):
            if channel not in self._planes:
                m.d.comb += triangle.planes[channel].eq(
                    popped.color[place * CHANNEL_BITS:(place + 1) * CHANNEL_BITS])

        sources = {f"edge_{part}": (getattr(self._edges, f"{part}_done"),
                                    getattr(self._edges, f"{part}_result"),
                                    [triangle[edge][part] for edge in commands.EDGES])
                   for part in ("start", "step")}
        for name, plane in self._planes.items():
            target = triangle.planes[name]
            sources[name] = plane.done, plane.result, [target.step_x, target.step_y, target.start]
        queues = []
        for name, (done, result, targets) in sources.items():
            queue = ResultQueue(result_bits=len(result), depth=self.depth)
            m.submodules[f"{name}_queue"] = queue
            m.d.comb += [queue.write.eq(done), queue.result.eq(result),
                         queue.words.ready.eq(pop)]
            m.d.comb += [target.eq(queue.words.payload[place])
                         for place, target in enumerate(targets)]
            queues.append(queue)
        complete = reduce(and_, (queue.words.valid for queue in queues), heads.r_rdy)
        m.d.sync += pop.eq(complete & ~pop & (~self.triangles.valid | self.triangles.ready))
        with m.If(pop):
            m.d.sync += [self.triangles.payload.eq(triangle), self.triangles.valid.eq(1)]
        with m.Elif(self.triangles.ready):
            m.d.sync += self.triangles.valid.eq(0)
