"""Set-up of objects: from what a place is told to prepared triangles."""

from amaranth.hdl import *
from amaranth.lib import data, fifo, stream, wiring
from amaranth.lib.wiring import In, Out

from ...golden.specification import commands
from ...golden.specification.configuration import MachineConfiguration
from ..backplane.words import (
    ObjectOperation,
    object_word_layout,
    prepared_triangle_layout,
    struct_layout,
)
from ..triangle_setup.triangle_setup import TriangleSetup
from .mesh_memory import MeshMemory
from .object_reader import ObjectReader

__all__ = ["ObjectSetup"]


class ObjectSetup(wiring.Component):
    """Keeps meshes, makes the triangles of objects, and sets these up, and others that come as
    vertices, in the order in which they are told.

    ::

        words ─┬─▶ MeshMemory ──────────┐
               │                        ▼
               └─▶ queue ──objects─▶ ObjectReader ─▶ TriangleSetup ─▶ triangles
                         ──vertices────────────────────▲

    A triangle that comes as vertices waits until those of all objects before it have gone on to
    set-up.

    Latency: ``latency`` clocks from an object to its first triangle, where nothing waits.
    Throughput: that of ``TriangleSetup``, as long as there are objects.

    Members
    -------
    total: In(id_bits)
        As for ``TriangleSetup``.
    words: In(stream of object_word_layout)
        ``depth`` objects and triangles can wait; what changes meshes waits until nothing is inside.
    triangles: Out(stream of prepared_triangle_layout)
    busy: Out(1)
        Holds an object or a triangle.
    full: Out(1)
        A mesh found no room since all were cleared.
    start: In(1)
        Count anew; only while not ``busy``.
    made: Out(RESPONSE_VALUE_BITS)
        Triangles made of objects.
    dropped: Out(RESPONSE_VALUE_BITS)
        Of these and of those that came as vertices, what set-up dropped; right while not ``busy``.

    Blazek 1991, chapter V, node initiated decomposition.
    """

    #: Objects and triangles that can wait.
    depth = 16
    #: Clocks through the queue.
    queue_latency = 2

    def __init__(self, *, configuration: MachineConfiguration):
        self.configuration = c = configuration
        self.meshes = MeshMemory(configuration=c)
        self.setup = TriangleSetup(configuration=c)
        super().__init__({
            "total": In(c.id_bits),
            "words": In(stream.Signature(object_word_layout(c))),
            "triangles": Out(stream.Signature(prepared_triangle_layout(c))),
            "busy": Out(1),
            "full": Out(1),
            "start": In(1),
            "made": Out(commands.RESPONSE_VALUE_BITS),
            "dropped": Out(commands.RESPONSE_VALUE_BITS),
        })

    @property
    def latency(self) -> int:
        """Clocks from an object to its first triangle."""
        return self.queue_latency + ObjectReader.latency + self.setup.latency

    @property
    def storages(self):
        """The RAMs that outlast a frame."""
        return self.meshes.storages

    def elaborate(self, platform):
        m = Module()
        m.submodules.meshes = meshes = self.meshes
        m.submodules.reader = reader = ObjectReader(configuration=self.configuration)
        m.submodules.setup = setup = self.setup
        wiring.connect(m, reader.lines, meshes.lines)
        wiring.connect(m, setup.triangles, wiring.flipped(self.triangles))
        m.d.comb += [setup.total.eq(self.total), self.full.eq(meshes.full)]
        self._load(m, meshes)
        self._draw(m, reader, setup)
        self._count(m, reader, setup)
        return m

    def _load(self, m, meshes):
        """What changes meshes, while nothing is inside."""
        word, taken = self.words.payload, Signal(name="load_taken")
        m.d.comb += [taken.eq(self.words.valid & ~self.busy),
                     meshes.word.eq(word.body.mesh_triangle)]
        for operation, line in ((ObjectOperation.CLEAR, meshes.clear),
                                (ObjectOperation.MESH, meshes.begin),
                                (ObjectOperation.MESH_TRIANGLE, meshes.store)):
            m.d.comb += line.eq(taken & (word.operation == operation))

    def _draw(self, m, reader, setup):
        """Objects and vertices, in turn."""
        object_, triangle = (struct_layout(layout(self.configuration)) for layout in (
            commands.object_layout, commands.triangle_layout))
        entry = data.StructLayout({
            "whole": 1, "body": data.UnionLayout({"object": object_, "triangle": triangle})})
        m.submodules.queue = queue = fifo.SyncFIFOBuffered(width=entry.size, depth=self.depth)
        words, waiting, given = self.words, Signal(entry), data.View(entry, queue.r_data)
        operation = words.payload.operation
        draws, whole, direct = Signal(), Signal(), Signal()
        m.d.comb += [
            draws.eq((operation == ObjectOperation.OBJECT)
                     | (operation == ObjectOperation.TRIANGLE)),
            waiting.whole.eq(operation == ObjectOperation.OBJECT),
            Value.cast(waiting.body).eq(Value.cast(words.payload.body)),
            queue.w_data.eq(waiting),
            queue.w_en.eq(words.valid & draws),
            words.ready.eq(Mux(draws, queue.w_rdy, ~self.busy)),
            whole.eq(queue.r_rdy & given.whole),
            direct.eq(queue.r_rdy & ~given.whole & ~reader.busy),
            reader.objects.valid.eq(whole),
            reader.objects.payload.eq(given.body.object),
            setup.vertices.valid.eq(reader.triangles.valid | direct),
            setup.vertices.payload.eq(Mux(reader.triangles.valid,
                                          reader.triangles.payload.as_value(),
                                          given.body.triangle.as_value())),
            reader.triangles.ready.eq(setup.vertices.ready),
            queue.r_en.eq(Mux(given.whole, reader.objects.ready,
                              setup.vertices.ready & ~reader.busy)),
            self.busy.eq((queue.level != 0) | reader.busy | setup.busy),
        ]

    def _count(self, m, reader, setup):
        vertices, triangles = setup.vertices, setup.triangles
        made = reader.triangles.valid & reader.triangles.ready
        m.d.sync += [self.made.eq(self.made + made),
                     self.dropped.eq(self.dropped + (vertices.valid & vertices.ready)
                                     - (triangles.valid & triangles.ready))]
        with m.If(self.start):
            m.d.sync += [self.made.eq(0), self.dropped.eq(0)]
