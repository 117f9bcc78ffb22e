"""Two primitives on one pixel in consecutive clocks: no update is lost; ties keep the first."""

import numpy as np
import pytest
from amaranth.sim import Simulator
from frames import PIXEL, check, draw, random_list, triangles
from suite.cases import chosen
from wide_machines import wide_machine

from cardcage.hdl.machine import Machine
from cardcage.testbenches.engines import pysim_engine
from cardcage.testbenches.frames.simulation import simulate


class Probe:
    """Counts, in one processing element, fragments taken clock after clock on one pixel."""

    def __init__(self):
        self.consecutive = 0
        self.forwarded = 0

    def attach(self, simulator, machine):
        test = machine.processing_elements[0].depth_test
        fragment = test.fragments.payload

        async def watch(ctx):
            last = None
            async for _, _, valid, ready, unit, address, forwarded in ctx.tick().sample(
                    test.fragments.valid, test.fragments.ready, fragment.unit, fragment.address,
                    test.forwarded):
                pixel = (unit, address) if valid and ready else None
                self.consecutive += pixel is not None and pixel == last
                self.forwarded += forwarded
                last = pixel

        simulator.add_testbench(watch, background=True)


@pytest.fixture
def probe(monkeypatch):
    probe = Probe()

    def probed(machine: Machine):
        simulator = Simulator(machine)
        probe.attach(simulator, machine)
        return simulator

    monkeypatch.setattr(pysim_engine, "Simulator", probed)
    return probe


#: A row of eight pixels apart from that one; while it is drawn the next ones close up behind it.
ROW = [[0.1, 5.4], [0.1, 5.6], [8.2, 5.5]]


@pytest.mark.parametrize(("cards", "skew"), [("PM", False), ("PMM", True)])
@pytest.mark.parametrize("order", ["front to back", "back to front", "shuffled"])
def test_no_update_is_lost_on_one_pixel(probe, order, cards, skew):
    source = np.random.default_rng(4)
    depth = np.sort(source.integers(0, 4000, 60))
    if order == "back to front":
        depth = depth[::-1]
    elif order == "shuffled":
        source.shuffle(depth)
    rows = np.arange(4000, 4000 + 15)  # all but the first hidden: no write of theirs comes between
    depth_of = np.concatenate([rows[:, np.newaxis], depth.reshape(15, 4)], axis=1).ravel()
    display_list = triangles([ROW, *[PIXEL] * 4] * 15, np.repeat(depth_of, 3),
                             source.integers(0, 256, (75, 3, 3)))
    configuration = wide_machine(display_list, cards=cards, clocks_per_pixel=4, skew=skew)
    simulation = simulate(configuration, display_list, pysim_engine.PysimEngine(), memory_seed=1)
    check(configuration, display_list, simulation)
    assert simulation.depth[3, 2] == depth.min()
    print(f"{cards}, {order}: {probe.consecutive} consecutive hits, {probe.forwarded} forwarded")
    assert probe.consecutive > 0
    if order == "back to front":  # every one of them a winner
        assert probe.forwarded > 0


@pytest.mark.parametrize("cards", chosen(
    ["PM", "PMM", "PMPM", "PMMMM", "PMPMMM", "PMMMPM"], "PMPMMM"))
def test_on_equal_depth_the_earlier_primitive_stays(cards):
    corners = [[0, 0], [9, 0], [0, 9]]
    colors = [[[10 * n, 255 - n, n]] * 3 for n in range(1, 5)]
    display_list = triangles([corners, PIXEL, corners[::-1], PIXEL], [[500] * 3] * 4, colors)
    simulation = draw(display_list, cards=cards)
    assert tuple(simulation.video[3, 2]) == (10, 254, 1)
    draw(random_list(21, 6, flat=True), cards=cards)
