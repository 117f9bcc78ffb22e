"""Many frames without a clear: far past the last tag, busy, idle, empty, late and abandoned."""

import numpy as np
import pytest
from amaranth.sim import Simulator
from frames import (
    SCREEN,
    check_frames,
    draw,
    many_frames,
    random_list,
    spans_twice,
    triangles,
)
from suite.cases import EVERY, chosen

from cardcage.golden.specification.commands import ResponseKind
from cardcage.testbenches.engines import pysim_engine


@pytest.fixture
def waits(monkeypatch):
    """Clocks in which no tag was free, in a list of one number."""
    clocks = [0]

    def probed(machine):
        simulator = Simulator(machine)

        async def watch(ctx):
            async for _, _, ready in ctx.tick().sample(machine.controller.tags.ready):
                clocks[0] += not ready

        simulator.add_testbench(watch, background=True)
        return simulator

    monkeypatch.setattr(pysim_engine, "Simulator", probed)
    return clocks


@pytest.mark.parametrize("ports", [1, 2])
@pytest.mark.parametrize(("tag_bits", "count", "cards"), [
    (2, 16, "PMM"), pytest.param(3, 20, "PM", marks=EVERY)])
def test_frames_past_the_last_tag(tag_bits, count, cards, ports):
    lists = many_frames(count, seed=ports)
    assert count > 2 << tag_bits
    responses = check_frames(lists, cards=cards, tag_bits=tag_bits, memory_ports=ports,
                             seed=tag_bits + ports)
    values = [value for kind, value, _ in responses if kind == ResponseKind.FRAME_SHOWN]
    print(f"scans that repeated a picture: {values}")


@pytest.mark.parametrize("ports", chosen([1, 2], 2))
@pytest.mark.parametrize("tag_bits", chosen([2, 3], 2))
def test_frames_that_leave_no_idle_clock_wait(waits, tag_bits, ports):
    """One frame after the other is started over, each pixel of it visible several times."""
    count = 2 + (3 << tag_bits)
    lists = [triangles([SCREEN] * 3,
                       [[3000 - 100 * layer - number] * 3 for layer in range(3)],
                       [[[number, layer, 3]] * 3 for layer in range(3)],
                       background=(number, 0, 0)) for number in range(count)]
    lists[-1] = random_list((tag_bits, ports), 5)  # leaves some background
    check_frames(lists, tag_bits=tag_bits, memory_ports=ports,
                 abandoned=set(range(1, count - 1)), seed=4)
    print(f"{waits[0]} clocks without a free tag")
    assert waits[0] > 0


def test_a_picture_shown_all_the_while_keeps_its_tag():
    """The front stays through more frame starts than there are tags, and is drawn over last."""
    lists = many_frames(14, seed=8)
    check_frames(lists, tag_bits=2, abandoned=set(range(2, 12)), seed=2)


@pytest.mark.parametrize("ports", [1, 2])
def test_an_empty_frame_costs_nothing(ports):
    """Not a clock for the words of the memory, however many."""
    took = set()
    for size in (4, 16):
        empty = triangles([], [], [], width=size, height=size)
        simulation = draw(empty, cards="PM", memory_ports=ports)
        took.add(simulation.draw_cycles)
    print(f"an empty frame takes {took} clocks")
    assert len(took) == 1 and took.pop() <= 6


@pytest.mark.parametrize("cards", ["PM", "PMM"])
def test_with_two_ports_no_update_is_lost(cards):
    for seed in range(2):
        draw(spans_twice(seed=seed), cards=cards, seed=seed, memory_ports=2)


@pytest.mark.parametrize("ports", chosen([1, 2], 1))
def test_coarser_pictures_and_padding(ports):
    source = np.random.default_rng(ports)
    for options in ({"words": 16, "maximum_units": 16}, {}):
        draw(random_list(int(source.integers(100)), 8, width=13, height=7), cards="PMMPMM",
             memory_ports=ports, **options)
