"""What is said of the processing elements' clocks adds up, and is the same whoever records it."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from cardcage.golden.planning.machine_plan import plan
from cardcage.golden.scene_display_list import make_display_list
from cardcage.golden.specification.activity import Activity
from cardcage.golden.specification.commands import ResponseKind
from cardcage.testbenches.engines.activity_record import (
    ACTIVITY_KINDS,
    BUCKETS,
    KINDS,
    ActivityWatch,
    activity_record,
)
from cardcage.testbenches.engines.pysim_engine import PysimEngine
from cardcage.testbenches.engines.verilator_engine import VerilatorEngine
from cardcage.testbenches.engines.verilator_tool import ToolMissingError, find_verilator
from cardcage.testbenches.frames.frame_job import frame_job

LIST = make_display_list("random:n=25,size=20,seed=3", width=16, height=12).display_list
PLAIN = plan(LIST, cards="PMPMMM", clocks_per_pixel=2).configuration
OBSERVED = replace(PLAIN, observe=True)


@pytest.fixture(scope="module")
def run():
    return PysimEngine().run(frame_job(OBSERVED, LIST, memory_seed=4))


def test_the_clocks_of_a_frame_add_up(run):
    [record] = run.activity
    [(drawn, last)] = [(value, cycle) for kind, value, cycle in run.responses
                       if kind == ResponseKind.FRAME_DRAWN]
    assert record.begin == run.accepted[0]  # the frame's start is the first command
    assert record.begin + record.clocks - 1 == last
    assert 0 < record.clocks - drawn < 8
    np.testing.assert_array_equal(record.by_element.sum(axis=1), record.clocks)
    fragments = [value for kind, value, _ in run.responses if kind == ResponseKind.FRAGMENTS]
    np.testing.assert_array_equal(record.by_element[:, 0], fragments)
    assert sum(record.shares().values()) == pytest.approx(1)
    for kind in ("port_conflict", "scan_slot", "empty_row", "preparing", "service"):
        assert record.shares()[kind] > 0, kind


def test_observing_changes_no_clock(run):
    plain = PysimEngine().run(frame_job(PLAIN, LIST, memory_seed=4))
    assert plain.responses == run.responses
    assert plain.cycles == run.cycles
    assert not plain.activity


def test_the_compiled_model_records_the_same(run):
    try:
        engine = VerilatorEngine(find_verilator())
    except ToolMissingError as missing:
        pytest.skip(f"simulator verilator: {missing}")
    [record] = run.activity
    [compiled] = engine.run(frame_job(OBSERVED, LIST, memory_seed=4)).activity
    assert (compiled.begin, compiled.clocks, compiled.bucket_clocks) == (
        record.begin, record.clocks, record.bucket_clocks)
    np.testing.assert_array_equal(compiled.counts, record.counts)


@pytest.mark.parametrize("clocks", [0, 1, BUCKETS, BUCKETS + 1, 3 * BUCKETS])
def test_buckets(clocks):
    record = activity_record(7, [0x10 + clock % KINDS for clock in range(clocks)], 2)
    assert record.counts.shape[1:] == (2, KINDS)
    assert len(record.counts) == -(-clocks // record.bucket_clocks) <= BUCKETS
    assert record.counts.sum() == 2 * clocks
    assert (record.counts[:, 1, 1].sum()) == clocks
    full = record.counts.sum(axis=(1, 2))[:-1]
    assert (full == 2 * record.bucket_clocks).all()


def test_a_record_ends_where_the_counters_are_read():
    watch = ActivityWatch(1)
    commands = {3: 3, 5: 6, 8: 1, 9: 3, 11: 6}  # triangle, read; frame start, triangle, read
    for cycle in range(14):
        watch.clock(cycle, Activity.DRAIN, commands.get(cycle), None)
    assert [(record.begin, record.clocks) for record in watch.records] == [(3, 2), (8, 3)]


def test_every_kind_has_a_name():
    assert {kind.activity for kind in ACTIVITY_KINDS} == set(Activity)
    assert len({kind.name for kind in ACTIVITY_KINDS}) == len(Activity)
