"""Vertices in random order and with ties, sorted by Python."""

import random

import pytest
from hdl_bench.bench import Agent, simulate
from hdl_bench.pictures import small_machine

from cardcage.golden.specification.commands import CHANNELS
from cardcage.hdl.triangle_setup.vertex_sort import VertexSort


class Sorts(Agent):
    """A triangle a clock; each is looked at when it is due."""

    def __init__(self, dut, triangles, flat):
        self.dut, self.triangles, self.flat = dut, triangles, flat
        self.clock = 0
        self.seen = 0

    @property
    def finished(self):
        return self.seen == len(self.triangles)

    def drive(self, ctx):
        if self.clock < len(self.triangles):
            bits = self.dut.triangle.shape()["vertex_0"].shape["x"].width
            ctx.set(self.dut.triangle, {
                f"vertex_{corner}": vertex | {axis: vertex[axis] % (1 << bits) for axis in "xy"}
                for corner, vertex in enumerate(self.triangles[self.clock])})

    def sample(self, ctx):
        due = self.clock - self.dut.latency
        self.clock += 1
        if not 0 <= due < len(self.triangles):
            return
        given, found = self.triangles[due], ctx.get(self.dut.vertices)
        for name, vertex in zip(("upper", "middle", "lower"),
                                sorted(given, key=lambda vertex: vertex["y"]), strict=True):
            values = ("x", "y", "depth", *(() if self.flat else CHANNELS))
            assert {value: found[name][value] for value in values} == {
                value: vertex[value] for value in values}
        columns = [vertex["x"] for vertex in given]
        assert (found.least_x, found.greatest_x) == (min(columns), max(columns))
        if self.flat:
            assert found.color == sum(given[0][name] << 8 * place
                                      for place, name in enumerate(CHANNELS))
        self.seen += 1


@pytest.mark.parametrize("shading", ["flat", "gouraud"])
def test_sorted_and_stable(shading):
    configuration = small_machine("PM", shading=shading)
    pick = random.Random(f"sort {shading}")
    limit = 1 << (configuration.coordinate_bits - 1)

    def vertex(near):
        return {"x": pick.randrange(-limit, limit),
                "y": pick.choice((near, near, pick.randrange(-limit, limit))),
                "depth": pick.randrange(255), **{name: pick.randrange(256) for name in CHANNELS}}

    triangles = []
    for _ in range(200):
        near = pick.choice((-limit, limit - 1, pick.randrange(-limit, limit)))
        triangles.append([vertex(near) for _ in range(3)])
    dut = VertexSort(configuration=configuration)
    assert dut.latency == 2
    simulate(dut, Sorts(dut, triangles, shading == "flat"))
