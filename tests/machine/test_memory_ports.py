"""A fragment a clock with two ports; with one, as near as its accesses allow.  Every fragment is
visible and the scan runs at four clocks a pixel."""

import numpy as np
from amaranth.sim import Simulator
from frames import check, triangles

from cardcage.golden.configuration import configure
from cardcage.testbenches import pysim_engine
from cardcage.testbenches.simulation import simulate


class Ports:
    """Clocks, fragments and scan reads from the first fragment taken to the last write."""

    def __init__(self):
        self.clock = self.fragments = 0
        self.first = self.last = None
        self.scanned = []

    def attach(self, machine):
        simulator = Simulator(machine)
        test = machine.processing_elements[0].depth_test
        access = machine.memory_units[0].memory.access

        async def watch(ctx):
            async for _, _, valid, ready, write, busy, scan in ctx.tick().sample(
                    test.fragments.valid, test.fragments.ready, access.write, access.write_busy,
                    access.scan):
                self.clock += 1
                if valid and ready:
                    self.first = self.first or self.clock
                    self.fragments += 1
                if self.first and write and not busy:
                    self.last = self.clock
                if scan:
                    self.scanned.append(self.clock)

        simulator.add_testbench(watch, background=True)
        return simulator

    @property
    def clocks(self):
        return self.last - self.first + 1

    @property
    def bound(self):
        """Accesses that the one port has to serve: a read and a write each, and the scan's."""
        scans = sum(self.first <= clock <= self.last for clock in self.scanned)
        return 2 * self.fragments + scans


def draw_twice(monkeypatch, ports, size=48):
    """A right triangle with its corners at the centres of pixels, and again, sloped and nearer."""
    right = [[0.5, 0.5], [size - 0.5, 0.5], [0.5, size - 0.5]]
    depth = np.array([[3000, 2500, 2000], [2900, 2400, 1900]])
    listed = triangles([right] * 2, depth, np.full((2, 3, 3), 99), width=size, height=size)
    configuration = configure(listed, cards="PM", clocks_per_pixel=4, memory_ports=ports)
    counts = Ports()
    monkeypatch.setattr(pysim_engine, "Simulator", counts.attach)
    check(configuration, listed, simulate(configuration, listed, pysim_engine.PysimEngine()))
    assert counts.fragments == size * (size - 1)  # a hypotenuse is no top or left edge
    return counts


def test_two_ports_take_a_visible_fragment_a_clock(monkeypatch):
    counts = draw_twice(monkeypatch, ports=2)
    rate = counts.fragments / counts.clocks
    print(f"{counts.fragments} fragments in {counts.clocks} clocks: {rate:.4f} a clock")
    assert rate >= 0.99


def test_one_port_is_hardly_ever_idle(monkeypatch):
    counts = draw_twice(monkeypatch, ports=1)
    print(f"{counts.clocks} clocks for {counts.fragments} fragments, bound {counts.bound}: "
          f"{counts.clocks / counts.bound:.4f} of it")
    assert counts.bound <= counts.clocks <= 1.05 * counts.bound
