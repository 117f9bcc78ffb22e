"""The cycle model: its arrays against the recurrence, its parts against the whole."""

from __future__ import annotations

import random
from dataclasses import fields, replace
from functools import partial

import numpy as np
import pytest
from cycle_lists import CARDS, scene
from cycle_recurrence import written_out
from wide_machines import wide_machine

from cardcage.golden.cycles.broadcast import SetupTiming
from cardcage.golden.cycles.cycle_model import predict_cycles
from cardcage.golden.cycles.element_latencies import Pipeline
from cardcage.golden.cycles.element_spans import lattice_spans
from cardcage.golden.specification.display_list import DisplayList


@pytest.mark.parametrize(("cards", "skew", "seed"), [
    *((cards, False, seed) for cards in CARDS for seed in range(3)), ("PMPMMM", True, 3),
    ("4x(PMM)", True, 4)])
def test_the_arrays_say_what_the_recurrence_says(cards, skew, seed):
    pick = random.Random(f"pipeline {cards} {seed}")
    listed = scene(10 + seed, n=60, size=pick.choice((4, 12, 25)))
    # The last triangle has a span in every element, which keeps the list in one part.
    listed.position[-1] = 256 * np.array([[0, 0], [39, 0], [0, 27]])
    pipeline = Pipeline(**{field.name: pick.randrange(1, 9) for field in fields(Pipeline)})
    configuration = wide_machine(listed, cards=cards, memory_ports=2, skew=skew)
    setup = pick.choice((None, SetupTiming(interval=20, latency=30, inside=3),
                         SetupTiming(interval=2, latency=11, waiting=4, inside=7)))
    cycles = []
    for depth in (2, 5, 100):
        machine = replace(configuration, fifo_depth=depth)
        prediction = predict_cycles(machine, listed, pipeline, setup=setup)
        np.testing.assert_array_equal(
            prediction.finished, written_out(machine, listed, pipeline, setup))
        assert prediction.cycles >= prediction.bound
        cycles.append(prediction.cycles)
    assert cycles == sorted(cycles, reverse=True)


@pytest.mark.parametrize("cards", CARDS)
def test_parts_of_a_list_hang_together(cards, monkeypatch):
    """Cut into parts of a few triangles it takes as long, but for spans that lie across a cut."""
    listed = scene(20, n=300)
    configuration = wide_machine(listed, cards=cards, memory_ports=2)
    whole = predict_cycles(configuration, listed)
    monkeypatch.setattr("cardcage.golden.cycles.node_work.lattice_spans",
                        partial(lattice_spans, row_limit=200))
    parts = predict_cycles(configuration, listed)
    assert (parts.bound, parts.binding) == (pytest.approx(whole.bound, rel=0.01), whole.binding)
    assert parts.cycles == pytest.approx(whole.cycles, rel=0.01)


def test_the_binding_bound():
    listed = scene(4)
    machine = wide_machine(listed, cards="PM")
    assert predict_cycles(machine, listed).binding == "busiest port"
    assert predict_cycles(replace(machine, memory_ports=2), listed).binding == "busiest element"
    slow = predict_cycles(machine, listed, setup=SetupTiming(interval=1000))
    assert slow.binding == "set-up"
    assert slow.cycles - 1000 < slow.bound <= slow.cycles + 1000
    pixels = scene(4, n=300, size=1)
    many = wide_machine(pixels, cards="8x(PM)", memory_ports=2)
    assert predict_cycles(many, pixels).binding == "broadcast"


def test_an_empty_list_takes_no_time():
    listed = scene(5)
    none = DisplayList(40, 28, listed.position[:0], listed.depth[:0], listed.color[:0])
    prediction = predict_cycles(wide_machine(listed, cards="PMM"), none)
    assert (prediction.cycles, prediction.bound) == (0, 0)
