"""The cycle model: its arrays against the recurrence, its parts against the whole."""

from __future__ import annotations

import random
from collections import Counter
from dataclasses import fields, replace
from functools import partial

import numpy as np
import pytest
from cycle_lists import CARDS, owner, scene
from wide_machines import wide_machine

from cardcage.golden.cycles.cycle_model import SetupTiming, predict_cycles
from cardcage.golden.cycles.element_latencies import Pipeline
from cardcage.golden.cycles.element_spans import lattice_spans
from cardcage.golden.organisations.organisation_of import organisation_of
from cardcage.golden.reference.coverage import Triangles
from cardcage.golden.reference.exact import fragments
from cardcage.golden.specification.configuration import MachineConfiguration
from cardcage.golden.specification.display_list import DisplayList
from cardcage.golden.specification.sampling_grid import Grid


def walked_by_hand(configuration: MachineConfiguration, listed: DisplayList, pipeline: Pipeline):
    """For each triangle and element: None where its box misses the element, else the clocks of the
    walk and, clocks after its load, every row's pixels; None in place of pixels at an open end."""
    triangles = Triangles.of(listed, Grid.of(listed))
    drawn = fragments(listed)
    owners = np.array([owner(configuration, unit) for unit in range(configuration.units)])
    covered = Counter(zip(drawn.primitive.tolist(), configuration.interlace.unit(
        drawn.x, drawn.y).tolist(), drawn.y.tolist(), strict=True))
    blocks = organisation_of(configuration).blocks
    units = configuration.interlace.unit(*np.meshgrid(np.arange(listed.width),
                                                      np.arange(listed.height)))
    by_block = [  # the units whose pixels have its offset from a multiple of its stride
        {int(unit) for unit in np.unique(units[block.y_offset::1 << block.y_bits << block.shifted,
                                               block.x_offset::1 << block.x_bits])}
        for block in blocks]
    work = []
    for place, primitive in enumerate(triangles.primitive.tolist()):
        box = units[triangles.top[place]:triangles.bottom[place],
                    triangles.left[place]:triangles.right[place]]
        of_triangle = []
        for element in range(configuration.processing_elements):
            mine = [units for block, units in zip(blocks, by_block, strict=True)
                    if block.element == element]
            if len(mine) == 1 and element not in owners[box]:
                of_triangle.append(None)
                continue
            clock = pipeline.first_row if len(mine) > 1 else 0
            rows = []
            for number, block in enumerate(mine):
                if number:
                    clock += pipeline.block
                owned = [y for y in range(triangles.top[place], triangles.bottom[place])
                         if set(units[y].tolist()) & block]
                for y in owned:
                    rows.append((clock, sum(covered[primitive, unit, y] for unit in block)))
                    clock += 1
                clock += not owned
            if not rows or rows[-1][0] < clock - 1 or not rows[-1][1]:
                rows.append((clock - 1, None))
            walk = clock + (pipeline.again if len(mine) > 1 else 0)
            of_triangle.append((walk, [row for row in rows if row[1] != 0]))
        work.append(of_triangle)
    return triangles, work


def written_out(configuration, listed, pipeline, depth, setup):
    """The same recurrence with two ports, span by span, queue by queue."""
    triangles, work = walked_by_hand(configuration, listed, pipeline)
    elements = range(configuration.processing_elements)
    clocks = []  # of each element's spans, once all of them are known
    for element in elements:
        pixels = [row[1] for kept in work if kept[element] for row in kept[element][1]]
        clocks.append([1 if count is None else count for count in pixels])
    never = -10**9
    load, free, number = ([never for _ in elements], [never for _ in elements],
                          [0 for _ in elements])
    freed, taken = [[] for _ in elements], [[] for _ in elements]
    entered, sent, finished, offered = [], [], [], -1
    for place, kept in enumerate(work):
        now = sent[-1] + 1 if sent else 0
        if setup is not None:
            before = triangles.primitive[place - 1] if place else -1
            offered += triangles.primitive[place] - before
            if place >= setup.waiting:
                offered = max(offered, entered[place - setup.waiting])
            entered.append(max(offered, entered[-1] + setup.interval if place else never,
                               sent[place - setup.inside] if place >= setup.inside else never))
            now = max(now, entered[-1] + setup.latency,
                      sent[-1] + setup.leaving if sent else never)
        while any(sum(time <= now - 2 for time in taken[element])
                  - sum(time <= now for time in freed[element]) >= depth - 1
                  for element in elements):
            now += 1
        sent.append(now)
        for element in elements:
            if kept[element] is None:
                continue
            walk, rows = kept[element]
            taken[element].append(now)
            begin = max(load[element], now + pipeline.queue)
            for clock, _ in rows:
                span = clocks[element][number[element]]
                free[element] = max(free[element], begin + pipeline.latency + clock) + span
                number[element] += 1
            done = clocks[element][:number[element]]

            def back(spans, done=done, end=free[element]):
                return end - max(spans, sum(done[-1 - spans:])) if len(done) > spans else never

            load[element] = max(begin + walk, back(pipeline.spans_ahead) - pipeline.lead)
            freed[element].append(1 + free[element] - pipeline.valued)
        finished.append(max(free) + pipeline.finish)
    return finished


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
        prediction = predict_cycles(replace(configuration, fifo_depth=depth), listed, pipeline,
                                    setup=setup)
        np.testing.assert_array_equal(
            prediction.finished, written_out(configuration, listed, pipeline, depth, setup))
        assert prediction.cycles >= prediction.bound
        cycles.append(prediction.cycles)
    assert cycles == sorted(cycles, reverse=True)


@pytest.mark.parametrize("cards", CARDS)
def test_parts_of_a_list_hang_together(cards, monkeypatch):
    """Cut into parts of a few triangles it takes as long, but for spans that lie across a cut."""
    listed = scene(20, n=300)
    configuration = wide_machine(listed, cards=cards, memory_ports=2)
    whole = predict_cycles(configuration, listed)
    monkeypatch.setattr("cardcage.golden.cycles.cycle_model.lattice_spans",
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
