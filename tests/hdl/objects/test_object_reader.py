"""Objects become triangles, bit for bit as the display list of an ``ObjectList`` has them."""

import numpy as np
import pytest
from amaranth.hdl import Elaboratable, Module
from amaranth.lib import wiring
from hdl_bench.bench import Agent, simulate
from hdl_bench.streams import Sink, Source, no_pause, once, pauses
from object_bench.objects import from_far, object_commands, object_machine, random_objects

from cardcage.golden.organisations.organisation_of import organisation_of
from cardcage.golden.specification import commands
from cardcage.golden.specification.commands import Opcode
from cardcage.hdl.objects.mesh_memory import MeshMemory
from cardcage.hdl.objects.object_reader import ObjectReader


class Both(Elaboratable):
    """The reader, and the memory that it reads."""

    def __init__(self, configuration):
        self.reader = ObjectReader(configuration=configuration)
        self.memory = MeshMemory(configuration=configuration)

    def elaborate(self, platform):
        m = Module()
        m.submodules.reader, m.submodules.memory = self.reader, self.memory
        wiring.connect(m, self.reader.lines, self.memory.lines)
        return m


class Loader(Agent):
    """Says what changes meshes, a command a clock."""

    def __init__(self, memory, words):
        self.memory, self.words = memory, list(words)

    @property
    def finished(self):
        return not self.words

    def drive(self, ctx):
        word = self.words.pop(0) if self.words else 0
        opcode = commands.opcode_of(word)
        ctx.set(self.memory.begin, opcode == Opcode.MESH)
        ctx.set(self.memory.store, opcode == Opcode.MESH_TRIANGLE)
        ctx.set(self.memory.word.as_value(), word >> commands.BODY_OFFSET)


def run(configuration, objects, pause=(no_pause, no_pause)):
    """The triangles of all objects, compared; returns the clocks of objects and triangles."""
    load, words = object_commands(configuration, objects)
    listed = objects.display_list()
    dut = Both(configuration)
    source = Source(dut.reader.objects, [word >> commands.BODY_OFFSET for word in words],
                    once(len(load) + 1, pause[0]))
    sink = Sink(dut.reader.triangles, listed.triangles, pause[1])
    held = []

    class Busy(Agent):
        def sample(self, ctx):
            held.append(ctx.get(dut.reader.busy))

    simulate(dut, Loader(dut.memory, load), source, sink, Busy(), after=6)
    sent = [commands.unpack(commands.object_layout(configuration), word >> commands.BODY_OFFSET)
            for word in words]
    numbers = sent_order(configuration, listed)
    order = np.concatenate([np.flatnonzero(listed.object_of == number) for number in numbers])
    assert len(sink.items) == len(order) == listed.triangles
    counts = listed.counts[numbers]
    shares = [fields for fields, count in zip(sent, counts, strict=True) for _ in range(count)]
    for item, number, share in zip(sink.items, order, shares, strict=True):
        for corner in range(3):
            vertex = item[f"vertex_{corner}"]
            assert [vertex.x, vertex.y] == (
                listed.position[number, corner] % (1 << configuration.coordinate_bits)).tolist()
            assert vertex.depth == listed.depth[number, corner]
            seen = corner == 0 or configuration.shading == "gouraud"
            assert [vertex.red, vertex.green, vertex.blue] == (
                listed.color[number, corner].tolist() if seen else [0, 0, 0])
        assert (item.node, item.round) == (share["node"], share["round"])
    assert not held[-1]
    # Busy from the clock after an object was taken until its last triangle is.
    for taken, count, end in zip(source.taken, counts, np.cumsum(counts), strict=True):
        assert all(held[taken + 1:sink.clocks[end - 1] + 1 if count else taken + 2])
    return source, sink, counts


def sent_order(configuration, listed):
    """The objects, as the host sends them."""
    return organisation_of(configuration).shares(listed).objects.host_order


@pytest.mark.parametrize("shading", ["flat", "gouraud"])
@pytest.mark.parametrize("seed", range(2))
def test_random_objects_under_stalls(shading, seed):
    configuration = object_machine(shading=shading, packet=2)
    objects = random_objects(configuration, 40, seed)
    run(configuration, objects, (pauses(f"objects {seed}"), pauses(f"triangles {seed}")))


def test_meshes_whose_origins_lie_out_of_the_guard_band():
    configuration = object_machine()
    objects = from_far(random_objects(configuration, 20, 7, triangles=(1, 2, 3)),
                       3 << configuration.coordinate_bits - 2, -200)
    assert not objects.clipped.any()
    run(configuration, objects)


def test_latency_and_a_triangle_a_clock():
    configuration = object_machine(packet="contiguous")
    objects = random_objects(configuration, 30, 5, triangles=(2, 3, 7))
    source, sink, counts = run(configuration, objects)
    assert sink.clocks[0] == source.taken[0] + ObjectReader.latency
    # Without a gap from the first to the last.
    assert sink.clocks == list(range(sink.clocks[0], sink.clocks[0] + sum(counts)))


def test_objects_of_few_triangles():
    """One triangle, or none, takes an object a clock as well, once it is looked up."""
    configuration = object_machine(packet="contiguous")
    objects = random_objects(configuration, 60, 6, triangles=(0, 1))
    source, sink, counts = run(configuration, objects)
    assert len(counts) == 60 and 10 < sum(counts) < 50
    assert source.taken == list(range(source.taken[0], source.taken[0] + 60))
    assert sink.clocks[0] == source.taken[int(np.flatnonzero(counts)[0])] + ObjectReader.latency
