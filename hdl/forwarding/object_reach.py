"""Which regions an object can meet: its mesh's box, moved."""

from amaranth.hdl import *
from amaranth.lib import memory, stream, wiring
from amaranth.lib.wiring import In, Out

from ...golden.specification import commands
from ...golden.specification.configuration import MachineConfiguration
from ..arithmetic.delay import delayed
from ..backplane.words import struct_layout
from .reach import object_bits, reaching_object_layout

__all__ = ["ObjectReach"]

#: Axis → low end, high end of a box; and those in regions.
AXES = {"x": ("left", "right"), "y": ("top", "bottom")}


class ObjectReach(wiring.Component):
    """Keeps the boxes of all meshes, and finds for each object the regions that hold a pixel whose
    centre lies in the box where the object is.  No triangle of the object has a pixel elsewhere.

    An object without such a pixel is drawn by nobody, and dropped.

    Latency: ``latency`` clocks.  Throughput: an object a clock.

    Members
    -------
    clear: In(1)
        There are no meshes any more.
    store: In(1), box: In(mesh_layout)
        The box of the next mesh; not while objects come.  One for which there is no room is lost.
    objects: In(stream of object_layout)
    reaching: Out(stream of reaching_object_layout)
        Without the number of the element.
    busy: Out(1)
        It holds an object.

    Blazek 1991, chapter V: a bounding box says to which parts of the screen an object belongs.
    """

    latency = 3

    def __init__(self, *, configuration: MachineConfiguration):
        self.configuration = configuration
        self._box = struct_layout(commands.mesh_layout(configuration))
        self.storage = memory.Memory(shape=self._box, depth=configuration.meshes, init=[],
                                     attrs={"no_rw_check": 1})
        super().__init__({
            "clear": In(1),
            "store": In(1),
            "box": In(self._box),
            "objects": In(stream.Signature(struct_layout(commands.object_layout(configuration)))),
            "reaching": Out(stream.Signature(
                reaching_object_layout(configuration, object_bits(configuration)))),
            "busy": Out(1),
        })

    def elaborate(self, platform):
        m = Module()
        configuration, reaching = self.configuration, self.reaching
        m.submodules.boxes = self.storage
        write, read = self.storage.write_port(), self.storage.read_port()
        count = Signal(configuration.mesh_bits)
        room = count != configuration.meshes
        m.d.comb += [write.addr.eq(count), write.data.eq(self.box),
                     write.en.eq(self.store & room)]
        m.d.sync += count.eq(Mux(self.clear, 0, count + write.en))

        move = Signal()
        stages = Signal(self.latency - 1)
        thing = self.objects.payload
        m.d.comb += [
            move.eq(~reaching.valid | reaching.ready),
            self.objects.ready.eq(move),
            self.busy.eq(stages.any() | reaching.valid),
            read.addr.eq(thing.mesh),
            read.en.eq(move),
        ]
        with m.If(move):
            m.d.sync += stages.eq(Cat(self.objects.valid, stages))

        kept = Value.cast(thing)[:object_bits(configuration)]
        empty, reach = Signal(), reaching.payload.reach
        beside = []
        for axis, ends in AXES.items():
            place = delayed(m, thing[axis], 1, f"place_{axis}", enable=move)
            low, high = (self._moved(m, read.data[end], place, end, move) for end in ends)
            beside.append(self._regions(m, axis, low, high, [reach[end] for end in ends], move))
        m.d.comb += empty.eq(Cat(beside).any())
        carried = delayed(m, kept, self.latency - 1, "object", enable=move)
        with m.If(move):
            m.d.sync += [reaching.valid.eq(stages[-1] & ~empty),
                         reaching.payload.object.eq(carried)]
        return m

    def _moved(self, m, end, place, name, move):
        """A box's end, moved, a move later; half a pixel back, since centres count."""
        bits = self.configuration.coordinate_bits
        half = 1 << self.configuration.sub_bits - 1
        # The first centre that is not before the low end, the last one not beyond the high end.
        back = 1 - half if name in ("left", "top") else half
        where = Signal(signed(bits), name=f"where_{name}")
        pixel = Signal(signed(bits + 1 - self.configuration.sub_bits), name=f"pixel_{name}")
        m.d.comb += where.eq(end + place)
        with m.If(move):
            m.d.sync += pixel.eq((where - back) >> self.configuration.sub_bits)
        return pixel

    def _regions(self, m, axis, first, last, ends, move):
        """Columns or rows of regions into the output register; returns that the box has no pixel of
        the picture along that axis."""
        size = {"x": self.configuration.width, "y": self.configuration.height}[axis]
        regions = self.configuration.dealt_regions
        inside = {"x": regions.x_bits, "y": regions.y_bits}[axis]
        low, high = (Signal(range(size), name=f"{end}_{axis}") for end in ("low", "high"))
        m.d.comb += [low.eq(Mux(first < 0, 0, first)),
                     high.eq(Mux(last > size - 1, size - 1, last))]
        with m.If(move):
            m.d.sync += [end.eq(pixel[inside:])
                         for end, pixel in zip(ends, (low, high), strict=True)]
        return (last < 0) | (first > size - 1) | (last < first)
