"""A fragment a clock with two ports; with one, as near as its accesses allow.  Every fragment is
visible and the scan runs at four clocks a pixel."""

import numpy as np
import pytest
from amaranth.sim import Simulator
from frames import check, triangles
from suite.cases import EVERY
from wide_machines import wide_machine

from cardcage.testbenches.engines import pysim_engine
from cardcage.testbenches.frames.simulation import simulate


class Ports:
    """Clocks, fragments and accesses of each unit from the first fragment taken to the last write.
    """

    def __init__(self):
        self.clock = self.fragments = 0
        self.first = self.last = None
        self.served = []  # of each unit, the clocks in which its port was taken

    def attach(self, machine):
        simulator = Simulator(machine)
        test = machine.processing_elements[0].depth_test
        self.served = [[] for _ in machine.memory_units]

        async def watch(ctx):
            signals = [signal for unit in machine.memory_units for access in [unit.memory.access]
                       for signal in (access.scan, access.write, access.write_busy, access.read,
                                      access.read_busy)]
            async for _, _, valid, ready, *states in ctx.tick().sample(
                    test.fragments.valid, test.fragments.ready, *signals):
                self.clock += 1
                if valid and ready:
                    self.first = self.first or self.clock
                    self.fragments += 1
                for unit, served in enumerate(self.served):
                    scan, write, write_busy, read, read_busy = states[5 * unit:5 * unit + 5]
                    if self.first and write and not write_busy:
                        self.last = self.clock
                    accesses = (write and not write_busy) + (read and not read_busy) + scan
                    served += [self.clock] * accesses

        simulator.add_testbench(watch, background=True)
        return simulator

    @property
    def clocks(self):
        return self.last - self.first + 1

    @property
    def bound(self):
        """Accesses that the busiest port has to serve: reads, writes and the scan's."""
        return max(sum(self.first <= clock <= self.last for clock in served)
                   for served in self.served)


def draw_twice(monkeypatch, ports, size=32, **machine):
    """A right triangle with its corners at the centres of pixels, and again, sloped and nearer."""
    right = [[0.5, 0.5], [size - 0.5, 0.5], [0.5, size - 0.5]]
    depth = np.array([[3000, 2500, 2000], [2900, 2400, 1900]])
    listed = triangles([right] * 2, depth, np.full((2, 3, 3), 99), width=size, height=size)
    configuration = wide_machine(listed, clocks_per_pixel=4, memory_ports=ports,
                              **{"cards": "PM"} | machine)
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


@pytest.mark.parametrize(("cards", "rate"), [
    ("PMM", 0.84), pytest.param("PM", 0.37, marks=EVERY)])
def test_one_port_is_hardly_ever_idle(monkeypatch, cards, rate):
    """That of the only unit, nor those of two that alternate along every row."""
    counts = draw_twice(monkeypatch, ports=1, cards=cards, skew=True)
    print(f"{counts.clocks} clocks for {counts.fragments} fragments, bound {counts.bound}: "
          f"{counts.clocks / counts.bound:.4f} of it")
    assert counts.bound <= counts.clocks <= 1.02 * counts.bound
    assert counts.fragments / counts.clocks > rate
