"""The meshes that a board keeps."""

from amaranth.hdl import *
from amaranth.lib import data, memory, wiring
from amaranth.lib.wiring import In, Out

from ...golden.specification import commands
from ...golden.specification.configuration import MachineConfiguration
from ..backplane.words import struct_layout

__all__ = ["MeshLines", "MeshMemory", "kept_triangle_layout", "mesh_entry_layout"]


def mesh_entry_layout(configuration: MachineConfiguration) -> data.StructLayout:
    """Where a mesh lies: its first triangle, and how many it has."""
    return data.StructLayout({"first": range(configuration.mesh_triangles),
                              "count": range(configuration.mesh_triangles + 1)})


def kept_triangle_layout(configuration: MachineConfiguration) -> data.StructLayout:
    """A triangle of a mesh, without the colours that a flat machine does not look at."""
    layout = commands.mesh_triangle_layout(configuration)
    if configuration.shading == "flat":
        for corner in ("vertex_1", "vertex_2"):
            layout[corner] = {name: bits for name, bits in layout[corner].items()
                              if name not in commands.CHANNELS}
    return struct_layout(layout)


class MeshLines(wiring.Signature):
    """From whoever reads meshes to the memory; what is asked for is there in the next clock, and
    stays until something else of its kind is asked for.

    Members
    -------
    look: Out(1), mesh: Out(mesh_bits)
        Which mesh to look up; it has been begun.
    entry: In(mesh_entry_layout)
    read: Out(1), place: Out(of a triangle among all)
    triangle: In(kept_triangle_layout)
    """

    def __init__(self, configuration: MachineConfiguration):
        super().__init__({
            "look": Out(1),
            "mesh": Out(configuration.mesh_bits),
            "entry": In(mesh_entry_layout(configuration)),
            "read": Out(1),
            "place": Out(range(configuration.mesh_triangles)),
            "triangle": In(kept_triangle_layout(configuration)),
        })


class MeshMemory(wiring.Component):
    """Keeps meshes, and gives their triangles as often as wanted.

    Meshes have the numbers 0, 1, 2 … in the order in which they are begun; a directory says where
    each lies.  Boxes, which only those need that pass objects on, are not kept here.

    Latency: a clock from ``look`` and from ``read`` to what is asked for; what is begun or stored
    can be asked for from the next clock on.  Throughput: a mesh, a triangle and an answer of either
    kind a clock.

    Members
    -------
    clear: In(1)
        Keep nothing any more.
    begin: In(1)
        The next mesh begins, without triangles.
    store: In(1), word: In(mesh_triangle_layout)
        It has this triangle, after all others; where none is begun it is dropped.  At most one of
        ``clear``, ``begin`` and ``store`` is high, and ``look`` and ``read`` are low.
    full: Out(1)
        Since the last ``clear`` there was no room for a mesh or a triangle, which is lost.
    lines: In(MeshLines)

    Blazek 1991, chapter V: with node initiated decomposition a node keeps what it makes polygons
    of.
    """

    def __init__(self, *, configuration: MachineConfiguration):
        self.configuration = c = configuration
        self._entry = mesh_entry_layout(c)
        self._kept = kept_triangle_layout(c)
        # Nothing is read in a clock in which something is written.
        self.directory, self.triangles = (
            memory.Memory(shape=layout, depth=depth, init=[], attrs={"no_rw_check": 1})
            for layout, depth in ((self._entry, c.meshes), (self._kept, c.mesh_triangles)))
        super().__init__({
            "clear": In(1),
            "begin": In(1),
            "store": In(1),
            "word": In(struct_layout(commands.mesh_triangle_layout(c))),
            "full": Out(1),
            "lines": In(MeshLines(c)),
        })

    @property
    def storages(self):
        """Its RAMs."""
        return [self.directory, self.triangles]

    def elaborate(self, platform):
        m = Module()
        m.submodules.directory, m.submodules.triangles = self.directory, self.triangles
        self._read(m)
        entry, kept = self.directory.write_port(), self.triangles.write_port()
        begun = Signal(range(self.configuration.meshes + 1))
        stored = Signal(range(self.configuration.mesh_triangles + 1))
        last = Signal(self._entry)  # the mesh begun last
        begins, stores = Signal(), Signal()
        m.d.comb += [
            begins.eq(self.begin & (begun != self.configuration.meshes)),
            # After a mesh without room, triangles are not to become another one's.
            stores.eq(self.store & (begun != 0) & ~self.full
                      & (stored != self.configuration.mesh_triangles)),
            kept.addr.eq(stored),
            kept.en.eq(stores),
            *(kept.data[corner][name].eq(self.word[corner][name])
              for corner, part in self._kept.members.items() for name in part.members),
            entry.addr.eq(Mux(begins, begun, begun - 1)),
            entry.en.eq(begins | stores),
            entry.data.first.eq(Mux(begins, stored, last.first)),
            entry.data.count.eq(Mux(begins, 0, last.count + 1)),
        ]
        m.d.sync += [begun.eq(begun + begins), stored.eq(stored + stores)]
        with m.If(entry.en):
            m.d.sync += last.eq(entry.data)
        with m.If((self.begin & ~begins) | (self.store & ~stores & (begun != 0))):
            m.d.sync += self.full.eq(1)
        with m.If(self.clear):
            m.d.sync += [begun.eq(0), stored.eq(0), self.full.eq(0)]
        return m

    def _read(self, m):
        entry, triangle, lines = self.directory.read_port(), self.triangles.read_port(), self.lines
        m.d.comb += [
            entry.addr.eq(lines.mesh),
            entry.en.eq(lines.look),
            lines.entry.eq(entry.data),
            triangle.addr.eq(lines.place),
            triangle.en.eq(lines.read),
            lines.triangle.eq(triangle.data),
        ]
