"""What regions that are dealt out cost their elements: spans against single fragments, and when
visits are known."""

from __future__ import annotations

from collections import Counter
from dataclasses import replace

import numpy as np
import pytest
from region_bench.lists import listed, random_list, random_table

from cardcage.golden.balancing.region_counts import loads, region_counts
from cardcage.golden.balancing.region_grid import RegionGrid
from cardcage.golden.cycles.cycle_estimate import estimate_cycles
from cardcage.golden.cycles.cycle_model import predict_cycles
from cardcage.golden.cycles.element_latencies import PIPELINE
from cardcage.golden.cycles.regions.large_visits import Band, find_visits
from cardcage.golden.cycles.regions.region_spans import region_spans
from cardcage.golden.organisations.organisation_of import organisation_of
from cardcage.golden.reference.coverage import Triangles
from cardcage.golden.reference.exact import fragments
from cardcage.golden.specification.configuration import MachineConfiguration
from cardcage.golden.specification.sampling_grid import Grid

WIDTH, HEIGHT = 70, 66


def machine(cards: str = "3x(PMM)", **fields) -> MachineConfiguration:
    fields = {"memory_ports": 2, "regions": (9, 9), "slots": 40} | fields
    return MachineConfiguration(cards, WIDTH, HEIGHT, **fields)


@pytest.mark.parametrize("cards", ["3x(PM)", "3x(PMM)", "5x(PMMMM)"])
@pytest.mark.parametrize("row_limit", [1, 60, 1 << 15])
def test_spans_and_what_leaves_the_walkers(cards, row_limit):
    configuration = machine(cards)
    random = np.random.default_rng(15)
    display_list = random_list(random, 80, WIDTH, HEIGHT, 8)
    organisation = organisation_of(configuration).dealt(
        random_table(random, 81, configuration.processing_elements, 40))
    triangles = Triangles.of(display_list, Grid.of(display_list))
    drawn = fragments(display_list)
    x, y = drawn.x.astype(np.int64), drawn.y.astype(np.int64)
    lane = organisation.unit(x, y) & 1
    region = organisation.regions.region(x, y)
    expected = Counter(zip(drawn.primitive.tolist(), region.tolist(), y.tolist(), lane.tolist(),
                           strict=True))

    found, covered = Counter(), 0
    for spans in region_spans(triangles, organisation, row_limit):
        here = np.isin(drawn.primitive, triangles.primitive[spans.begin:spans.end])
        lanes = spans.counted(x[here], lane[here], None)
        rows = spans.counted(x[here], lane[here], y[here] % 2 == 1)
        assert np.array_equal(lanes.sum(axis=1), spans.length) and spans.length.all()
        visited = spans.visit_region[spans.visit]
        assert np.array_equal(organisation.table[visited], spans.element)
        owner = (triangles.primitive[spans.begin + spans.visit_triangle[spans.visit]]).tolist()
        for number, (primitive, place) in enumerate(zip(owner, visited.tolist(), strict=True)):
            top = max(triangles.top[spans.begin + spans.visit_triangle[spans.visit[number]]],
                      place // 9 * 8)
            row = int(top + spans.step[number])
            for each in range(2):
                if lanes[number, each]:
                    found[primitive, place, row, each] += int(lanes[number, each])
            assert rows[number].sum() == (lanes[number].sum() if row % 2 else 0)
        covered += int(spans.length.sum())
        check_entries(spans)
    assert found == expected and covered == len(x)


def check_entries(spans):
    """Spans, and where a triangle's last visit of an element ends without one, its end."""
    entries, visits = spans.entries()
    left = {}
    for pair, offset, span in zip(entries.pair, entries.offset, entries.span, strict=True):
        left.setdefault(int(visits[pair]), []).append((int(offset), int(span)))
    for visit, (rows, ends) in enumerate(zip(spans.visit_rows, spans.visit_ends, strict=True)):
        own = [(int(spans.step[span]), int(span)) for span in np.flatnonzero(spans.visit == visit)]
        if ends and (not own or own[-1][0] < rows - 1):
            own.append((int(rows) - 1, -1))
        assert left.pop(visit, []) == own
    assert not left


def test_who_keeps_a_triangle():
    """A box of 2 × 2 regions only their elements, a larger one all."""
    display_list = listed([[[0, 0], [16, 0], [0, 16]], [[0, 0], [18, 0], [0, 16]]], WIDTH, HEIGHT,
                          1)
    large = listed([[[0, 0], [40, 0], [0, 16]]], WIDTH, HEIGHT, 1)
    organisation = organisation_of(machine("5x(PMM)"))  # region modulo 5
    [spans] = region_spans(Triangles.of(display_list, Grid.of(display_list)), organisation)
    kept = list(zip(spans.visit_triangle.tolist(), spans.visit_element.tolist(),
                    spans.visit_region.tolist(), spans.visit_rows.tolist(), strict=True))
    assert kept == [(0, 0, 0, 8), (1, 0, 0, 8), (1, 1, 1, 8)]
    [spans] = region_spans(Triangles.of(large, Grid.of(large)), organisation)
    kept = list(zip(spans.visit_element.tolist(), spans.visit_region.tolist(),
                    spans.visit_rows.tolist(), strict=True))
    assert kept == [(0, 0, 8), (1, 1, 8), (2, 2, 8), (3, -1, 1), (4, -1, 1)]


@pytest.mark.parametrize("ports", [1, 2])
def test_the_bound_is_what_is_counted(ports):
    """Of an element the clocks of its regions, if rows and fragments are as one; and no machine is
    faster than its bound, nor slower for more that can wait."""
    random = np.random.default_rng(94)
    display_list = random_list(random, 150, WIDTH, HEIGHT, 8)
    table = random_table(random, 81, 3, 40)
    configuration = machine(memory_ports=ports)
    counts = region_counts(display_list, RegionGrid.of(configuration.dealt_regions))
    cycles = []
    for depth in (3, 16, 200):
        prediction = predict_cycles(replace(configuration, fifo_depth=depth), display_list,
                                    table=table)
        assert prediction.cycles >= prediction.bound
        assert np.all(prediction.element_bound <= loads(counts.clocks, table, 3) + 150)
        cycles.append(prediction.cycles)
    assert cycles == sorted(cycles, reverse=True)
    static = predict_cycles(configuration, display_list)
    assert static.cycles != cycles[1], "the table says nothing"
    modulo = predict_cycles(configuration, display_list, table=np.arange(81) % 3)
    assert modulo.cycles == static.cycles
    estimate = estimate_cycles(configuration, display_list, table=table)
    assert estimate.total == pytest.approx(cycles[2], rel=0.12)
    assert int(estimate.fragments.sum()) == len(fragments(display_list))


def test_one_triangle_after_another():
    """A visit's rows follow one another, the next visit and the next triangle without a bubble."""
    once = listed([[[0, 0], [17, 0], [0, 17]]], WIDTH, HEIGHT, 1)
    configuration = machine("3x(PMM)")
    alone = PIPELINE.queue + PIPELINE.latency + PIPELINE.finish
    # 36 pixels in eight rows, 8 in the first one.
    assert predict_cycles(configuration, once).cycles == alone + 36
    assert predict_cycles(configuration, once.followed_by(once)).cycles == alone + 72
    # Three bands of a column have pixels, and eight rows each; two have none, and are not visited.
    # The other elements take the box's clock.
    narrow = listed([[[0, 0], [2, 0], [2, 80]]], WIDTH, HEIGHT, 1)
    both = predict_cycles(configuration, narrow, table=np.zeros(81, np.int64))
    assert both.element_bound.tolist() == [24, 1, 1]


def known(bands, rows=()):
    """When each visit of a triangle that is there at 0 is known, where the walker takes ``rows``
    clocks for each before."""
    seen, free, lengths = [], 0, iter(rows)

    def walk(clock):
        nonlocal free
        taken = max(clock, free)
        free = taken + next(lengths, 1)
        seen.append((clock, taken))
        return taken

    find_visits(0, bands, walk)
    return seen


def test_when_visits_are_known():
    """As ``hdl.regions.large_visits`` states it; its own test holds it to that."""
    # Two probes, sent at 1 and 2, taken at 7; the column is looked at in 8, found in 9; nothing
    # more can come from 10 on.
    assert known([Band(2, 1, (0,))]) == [(10, 10)]
    assert known([Band(4, 1, (0,))]) == [(12, 12)]
    # A band without own regions within reach costs a clock, one that is probed in vain its probes.
    assert known([Band(0, 0, ()), Band(2, 1, (0,))]) == [(11, 11)]
    assert known([Band(2, 0, ()), Band(2, 1, (0,))]) == [(12, 12)]
    # None at all: known when the last probe's extent has been taken, or a column was not its own.
    assert known([Band(2, 0, ())]) == [(8, 8)]
    assert known([Band(2, 1, ())]) == [(10, 10)]
    assert known([Band(0, 0, ()), Band(0, 0, ())]) == [(3, 3)]
    # The first of two is known when the second is found.
    assert known([Band(2, 3, (0, 2))]) == [(11, 11), (12, 12)]
    assert known([Band(2, 1, (0,)), Band(2, 1, (0,))]) == [(11, 11), (12, 12)]


def test_visits_wait_for_the_walker():
    """One waits, the next one has been found; what follows is looked for after that."""
    bands = [Band(2, 4, (0, 1, 2, 3))]
    assert known(bands) == [(10, 10), (11, 11), (12, 12), (13, 13)]
    assert known(bands, [20, 1, 1, 1]) == [(10, 10), (11, 30), (31, 31), (32, 32)]
