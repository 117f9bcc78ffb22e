"""Meshes that are stored, looked up and forgotten, against lists in Python."""

import random

import pytest
from hdl_bench.bench import Agent, simulate
from object_bench.objects import object_machine

from cardcage.golden.specification import commands
from cardcage.hdl.objects.mesh_memory import MeshMemory


class Keeper(Agent):
    """Changes and asks at random, and checks every answer a clock later, and ``full`` always."""

    def __init__(self, dut, seed, clocks):
        self.dut, self.left = dut, clocks
        self.pick = random.Random(f"meshes {seed}")
        self.meshes, self.all, self.full = [], [], False
        self.entry = self.triangle = None
        self.seen = {"entries": 0, "triangles": 0, "full": 0, "clears": 0}

    @property
    def finished(self):
        return self.left == 0

    def drive(self, ctx):
        dut, pick, machine = self.dut, self.pick, self.dut.configuration
        for name in ("clear", "begin", "store"):
            ctx.set(getattr(dut, name), 0)
        ctx.set(dut.lines.look, 0)
        ctx.set(dut.lines.read, 0)
        bits = commands.layout_bits(commands.mesh_triangle_layout(machine))
        word = pick.getrandbits(bits)
        ctx.set(dut.word.as_value(), word)
        ctx.set(dut.lines.mesh, pick.randrange(8) % max(1, len(self.meshes)))
        ctx.set(dut.lines.place, pick.randrange(machine.mesh_triangles))
        clears = min(3, 40 / machine.mesh_triangles)  # seldom enough that it fills up
        self.change = pick.choices(("clear", "begin", "store", "ask"), (clears, 8, 40, 50))[0]
        self.word = word
        if self.change == "ask":
            if self.meshes and pick.random() < 0.7:
                mesh = pick.randrange(len(self.meshes))
                ctx.set(dut.lines.look, 1)
                ctx.set(dut.lines.mesh, mesh)
                self.entry = tuple(self.meshes[mesh])
            if self.all and pick.random() < 0.7:
                place = pick.randrange(len(self.all))
                ctx.set(dut.lines.read, 1)
                ctx.set(dut.lines.place, place)
                self.next_triangle = self.all[place]
            else:
                self.next_triangle = self.triangle
        else:
            ctx.set(getattr(dut, self.change), 1)
            self.next_triangle = self.triangle

    def sample(self, ctx):
        lines = self.dut.lines
        assert ctx.get(self.dut.full) == self.full
        self.seen["full"] += self.full
        if hasattr(self, "answer"):
            entry, triangle = self.answer
            if entry is not None:
                assert (ctx.get(lines.entry.first), ctx.get(lines.entry.count)) == entry
                self.seen["entries"] += 1
            if triangle is not None:
                kept = self.dut.lines.triangle.shape()
                machine = self.dut.configuration
                whole = commands.unpack(commands.mesh_triangle_layout(machine), triangle)
                for corner, part in kept.members.items():
                    for name in part.members:
                        assert ctx.get(lines.triangle[corner][name]) == whole[corner][name]
                self.seen["triangles"] += 1
        self.answer = (self.entry, self.next_triangle)
        self.triangle = self.next_triangle
        self.change_model()
        self.left -= 1

    def change_model(self):
        machine = self.dut.configuration
        if self.change == "clear":
            self.meshes, self.all, self.full = [], [], False
            self.seen["clears"] += 1
            # What was asked for before stays on the lines: nobody looks at it any more.
            self.entry = self.triangle = None
            self.answer = (None, None)
        elif self.change == "begin":
            if len(self.meshes) == machine.meshes:
                self.full = True
            else:
                self.meshes.append([len(self.all), 0])
        elif self.change == "store" and self.meshes:
            if self.full or len(self.all) == machine.mesh_triangles:
                self.full = True
            else:
                self.all.append(self.word)
                self.meshes[-1][1] += 1


@pytest.mark.parametrize(("meshes", "triangles", "shading"), [
    (1, 1, "flat"), (3, 9, "gouraud"), (6, 40, "flat")])
def test_random_changes_and_questions(meshes, triangles, shading):
    dut = MeshMemory(configuration=object_machine(meshes=meshes, mesh_triangles=triangles,
                                                  shading=shading))
    keeper = Keeper(dut, (meshes, triangles), 500)
    simulate(dut, keeper)
    assert all(count > 1 for count in keeper.seen.values()), keeper.seen


def test_a_flat_machine_keeps_one_colour():
    flat, gouraud = (MeshMemory(configuration=object_machine(shading=shading))
                     for shading in ("flat", "gouraud"))
    sizes = [memory.triangles.shape.size for memory in (flat, gouraud)]
    assert sizes[1] - sizes[0] == 2 * 24
    for memory in (flat, gouraud):
        simulate(memory, after=1)
