"""From objects to their triangles."""

from amaranth.hdl import *
from amaranth.lib import stream, wiring
from amaranth.lib.wiring import In, Out

from ...golden.specification import commands
from ...golden.specification.configuration import MachineConfiguration
from ...golden.specification.ranges import CHANNEL_BITS
from ..backplane.words import struct_layout
from .mesh_memory import MeshLines

__all__ = ["ObjectReader"]


class ObjectReader(wiring.Component):
    """Reads the mesh of each object, and moves and colours its triangles.

    ::

        objects ─▶ looked up ─▶ read triangle by triangle ─▶ moved, coloured ─▶ triangles
                     directory         triangles

    A vertex' x, y and depth are the mesh's plus the object's, modulo their fields; a channel is the
    object's times the shade plus one, its low eight bits dropped
    (``golden.specification.fixed_point.modulated``).  Round and node are the object's.  The colours
    of the second and third vertex are 0 where the machine does not look at them.

    Latency: ``latency`` clocks from an object to its first triangle.  Throughput: a triangle a
    clock, and those of different objects follow one another without a gap if each has two or more;
    an object without triangles takes a clock.

    Members
    -------
    objects: In(stream of object_layout)
        Only of meshes that were loaded.
    lines: Out(MeshLines)
    triangles: Out(stream of triangle_layout)
    busy: Out(1)
        Holds an object or a triangle.

    Blazek 1991, chapter V: a node makes the polygons of the objects it is given.
    """

    latency = 4

    def __init__(self, *, configuration: MachineConfiguration):
        self.configuration = configuration
        self._object = struct_layout(commands.object_layout(configuration))
        super().__init__({
            "objects": In(stream.Signature(self._object)),
            "lines": Out(MeshLines(configuration)),
            "triangles": Out(stream.Signature(
                struct_layout(commands.triangle_layout(configuration)))),
            "busy": Out(1),
        })

    def elaborate(self, platform):
        m = Module()
        objects, lines, triangles = self.objects, self.lines, self.triangles
        entry = lines.entry
        # What is looked up, what is read, and whose the triangle is that was read.
        asked, own, read = (Signal(self._object, name=name, reset_less=True)
                            for name in ("asked", "own", "read"))
        has_asked, giving, has_read = Signal(), Signal(), Signal()
        place = Signal.like(lines.place)
        left = Signal.like(entry.count)  # triangles of it after the next one
        leaves, moves, reads, ends = Signal(), Signal(), Signal(), Signal()
        m.d.comb += [
            leaves.eq(~triangles.valid | triangles.ready),
            moves.eq(~has_read | leaves),
            reads.eq(giving & moves),
            ends.eq(~giving | (reads & (left == 0))),
            objects.ready.eq(~has_asked | ends | (entry.count == 0)),
            lines.mesh.eq(objects.payload.mesh),
            lines.look.eq(objects.valid & objects.ready),
            lines.place.eq(place),
            lines.read.eq(reads),
            self.busy.eq(has_asked | giving | has_read | triangles.valid),
        ]
        with m.If(objects.ready):
            m.d.sync += [has_asked.eq(objects.valid), asked.eq(objects.payload)]
        with m.If(ends):
            m.d.sync += [giving.eq(has_asked & (entry.count != 0)), own.eq(asked),
                         place.eq(entry.first), left.eq(entry.count - 1)]
        with m.Elif(reads):
            m.d.sync += [place.eq(place + 1), left.eq(left - 1)]
        with m.If(moves):
            m.d.sync += [has_read.eq(reads), read.eq(own)]
        with m.If(leaves):
            m.d.sync += triangles.valid.eq(has_read)
            self._move(m, read)
        return m

    def _move(self, m, read):
        """The triangle that was read, moved and coloured, into the output's register."""
        kept, triangle = self.lines.triangle, self.triangles.payload
        for corner, part in kept.shape().members.items():
            for name in part.members:
                value = (read[name] * (kept[corner][name] + 1) >> CHANNEL_BITS
                         if name in commands.CHANNELS else kept[corner][name] + read[name])
                m.d.sync += triangle[corner][name].eq(value)
        m.d.sync += [triangle[name].eq(read[name]) for name in ("round", "node")
                     if name in triangle.shape().members]
