"""The cycle model: its matrices against the recurrence, its parts against the picture."""

from __future__ import annotations

import random

import numpy as np
import pytest

from cardcage.golden.configuration import MachineConfiguration, configure
from cardcage.golden.coverage import Triangles
from cardcage.golden.cycle_model import Pipeline, predict_cycles
from cardcage.golden.display_list import DisplayList
from cardcage.golden.exact import draw, fragments
from cardcage.golden.grid import Grid
from cardcage.golden.lattice_spans import ROW_LIMIT, lattice_blocks, lattice_spans
from cardcage.golden.port_clocks import WRITE_LATENCY, PortClocks, RowClocks
from cardcage.golden.scene_display_list import make_display_list

CARDS = ("PM", "PMM", "2x(PM)", "PMPMMM", "4x(PMM)")


def scene(seed: int, n: int = 40, size: int = 12) -> DisplayList:
    return make_display_list(f"random:n={n},size={size},seed={seed}", width=40,
                             height=28).display_list


def spans_of(configuration: MachineConfiguration, listed: DisplayList, row_limit: int = 64):
    triangles = Triangles.of(listed, Grid.of(listed))
    return triangles, list(lattice_spans(triangles, lattice_blocks(configuration), row_limit))


def owner(configuration: MachineConfiguration, unit: int) -> int:
    """The processing element left of a unit."""
    seen = -1
    for place, card in enumerate(configuration.cards):
        seen += card == "M"
        if seen == unit:
            return configuration.cards[:place].count("P") - 1
    raise AssertionError(unit)


@pytest.mark.parametrize("cards", CARDS)
def test_spans_hold_every_fragment_of_their_element(cards):
    listed = scene(1)
    configuration = configure(listed, cards=cards)
    triangles, parts = spans_of(configuration, listed)
    assert len(parts) > 1 and [part.begin for part in parts[1:]] == [
        part.end for part in parts[:-1]]
    drawn = fragments(listed)
    owners = [owner(configuration, unit) for unit in range(configuration.units)]
    wanted: dict[tuple[int, int, int], int] = {}
    for primitive, x, y in zip(drawn.primitive.tolist(), drawn.x.tolist(), drawn.y.tolist(),
                               strict=True):
        key = primitive, owners[configuration.interlace.unit(x, y)], y
        wanted[key] = wanted.get(key, 0) + 1
    found: dict[tuple[int, int, int], int] = {}
    for part in parts:
        for triangle, element, row, length in zip(part.triangle, part.element, part.row,
                                                  part.length, strict=True):
            key = int(triangles.primitive[part.begin + triangle]), int(element), int(row)
            found[key] = found.get(key, 0) + int(length)
    assert found == wanted


@pytest.mark.parametrize("cards", CARDS)
def test_rows_are_those_of_the_lattice(cards):
    listed = scene(2)
    configuration = configure(listed, cards=cards)
    triangles, parts = spans_of(configuration, listed)
    for number, block in enumerate(lattice_blocks(configuration)):
        for part in parts:
            for place, triangle in enumerate(range(part.begin, part.end)):
                rows = [row for row in range(triangles.top[triangle], triangles.bottom[triangle])
                        if row % (1 << block.y_bits) == block.y_offset]
                assert part.rows[place, number] == len(rows)
                here = ((part.triangle == place) & (part.element == block.element)
                        & (part.place == block.place))
                assert [rows[step] for step in part.step[here]] == part.row[here].tolist()


def test_written_fragments():
    """With one port and one unit a span takes a clock for each fragment and for each write."""
    listed = scene(3, n=150)
    configuration = configure(listed, cards="PM", clocks_per_pixel=256)
    triangles, parts = spans_of(configuration, listed)
    ports = PortClocks(configuration, listed, triangles)
    total = sum(float(ports.of(part).sum()) for part in parts)
    nearest = np.full((28, 40), configuration.depth_background)
    accesses = 0
    drawn = fragments(listed)
    for x, y, depth in zip(drawn.x, drawn.y, drawn.depth, strict=True):
        visible = depth < nearest[y, x]
        accesses += 1 + visible
        nearest[y, x] = min(nearest[y, x], depth)
    np.testing.assert_array_equal(nearest, draw(listed).depth)
    assert accesses < 2 * len(drawn), "some fragments are hidden"
    assert total == pytest.approx(accesses * 256 / 255, rel=1e-3)


@pytest.mark.parametrize("units", [1, 2, 4])
def test_reads_and_writes_of_rows_clock_by_clock(units):
    """Against a port that takes the write first, else the read, and two elements interleaved."""
    pick = random.Random(f"rows {units}")
    runs = [(pick.randrange(2), pick.randrange(units), pick.choice((1, 1, 2, 3, 4, 7, 20)))
            for _ in range(300)]
    clocks = RowClocks(2, units)
    element, unit, length = (np.array(column) for column in zip(*runs, strict=True))
    found = np.concatenate([clocks.of(element[part], unit[part], length[part])
                            for part in (slice(0, 111), slice(111, None))])
    for chosen in range(2):
        now, writes = 0, set()
        for place, (which, in_unit, reads) in enumerate(runs):
            if which != chosen:
                continue
            begin = now
            while reads:
                if (now, in_unit) not in writes:
                    writes.add((now + WRITE_LATENCY, in_unit))
                    reads -= 1
                now += 1
            assert found[place] == now - begin


def written_out(configuration, listed, pipeline, depth, setup_clocks):
    """The same recurrence, clock by clock, span by span, FIFO by FIFO."""
    triangles, parts = spans_of(configuration, listed, ROW_LIMIT)
    ports = PortClocks(configuration, listed, triangles)
    blocks = lattice_blocks(configuration)
    elements = configuration.processing_elements
    interval = max(pipeline.broadcast, setup_clocks)
    never = -1e15
    walker, free = [never] * elements, [never] * elements
    begun = [[never] * pipeline.spans_ahead for _ in range(elements)]
    walked, finished, sent = [], [], -interval
    for part in parts:
        clocks = ports.of(part)
        for place in range(part.end - part.begin):
            number = part.begin + place
            sent += interval
            if number >= depth:
                sent = max(sent, walked[number - depth] + pipeline.fifo_room)
            for element in range(elements):
                at = max(walker[element], sent + pipeline.fifo)
                for index, block in enumerate(blocks):
                    if block.element != element:
                        continue
                    at += pipeline.load + pipeline.stride * block.y_bits
                    row, rows = 0, max(part.rows[place, index], pipeline.least_rows)
                    for span in np.flatnonzero(
                            (part.triangle == place) & (part.element == element)
                            & (part.place == block.place)):
                        at += pipeline.row * (part.step[span] - row)
                        row = part.step[span]
                        at = max(at, begun[element][-1] - pipeline.lead)
                        begin = max(at + pipeline.latency, free[element])
                        free[element] = begin + clocks[span]
                        begun[element] = [begin, *begun[element][:-1]]
                    at += pipeline.row * (rows - row)
                walker[element] = at
            walked.append(max(walker))
            finished.append(max(free) + pipeline.finish)
    return finished


@pytest.mark.parametrize("cards", CARDS)
@pytest.mark.parametrize("seed", range(3))
def test_the_matrices_say_what_the_recurrence_says(cards, seed):
    pick = random.Random(f"pipeline {cards} {seed}")
    listed = scene(10 + seed, n=60, size=pick.choice((4, 12, 25)))
    pipeline = Pipeline(**{name: pick.randrange(1, 4) for name in (
        "broadcast", "fifo", "fifo_room", "load", "stride", "row", "least_rows", "latency",
        "spans_ahead", "lead", "finish")})
    configuration = configure(listed, cards=cards)
    depths = [2, 5, 100]
    setup_clocks = pick.choice((1, 1, 20))
    predictions = predict_cycles(configuration, listed, pipeline, depths,
                                 setup_clocks=setup_clocks)
    for depth, prediction in zip(depths, predictions, strict=True):
        np.testing.assert_allclose(
            prediction.finished,
            written_out(configuration, listed, pipeline, depth, setup_clocks), atol=1e-2)
        # The bound also counts what follows the last fragment: one interval, and some rows.
        assert prediction.cycles >= prediction.bound - setup_clocks - 40 * pipeline.row
    assert predictions[0].cycles >= predictions[1].cycles >= predictions[2].cycles


def test_the_binding_bound():
    listed = scene(4)
    machine = configure(listed, cards="PM")
    assert predict_cycles(machine, listed)[0].binding == "busiest element"
    [slow] = predict_cycles(machine, listed, setup_clocks=1000)
    assert slow.binding == "broadcast"
    assert slow.cycles - 1000 < slow.bound <= slow.cycles + 1000


def test_an_empty_list_takes_no_time():
    listed = scene(5)
    none = DisplayList(40, 28, listed.position[:0], listed.depth[:0], listed.color[:0])
    [prediction] = predict_cycles(configure(listed, cards="PMM"), none)
    assert (prediction.cycles, prediction.bound) == (0, 0)
