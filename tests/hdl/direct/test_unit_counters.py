"""What units took, counted and reported unit by unit."""

import random

import pytest
from hdl_bench.bench import Drive, rejects, simulate
from hdl_bench.streams import Sink, no_pause, pauses

from cardcage.golden.specification.commands import ResponseKind
from cardcage.hdl.direct.unit_counters import UnitCounters

CLOCKS = 60


def run(units, end, seed, pause):
    """Counts, is cleared and counts again; then it reports twice."""
    pick = random.Random(f"counters {units} {seed}")
    dut = UnitCounters(units=units)
    words = [(pick.getrandbits(units), pick.getrandbits(units)) for _ in range(CLOCKS)]
    clear = pick.randrange(CLOCKS - 5)
    expected = []
    for unit in range(end):
        counts = [sum(word[kind] >> unit & 1 for word in words[clear + 1:]) for kind in range(2)]
        expected += zip((ResponseKind.TAKEN, ResponseKind.FOLLOWED), counts, strict=True)
    sink = Sink(dut.responses, 2 * len(expected), pause, zero=True)
    starts, busy = [], []

    def drive(ctx, clock):
        taken, followed = words[clock] if clock < CLOCKS else (0, 0)
        ctx.set(dut.taken, taken)
        ctx.set(dut.followed, followed)
        ctx.set(dut.clear, clock == clear)
        ctx.set(dut.end, end)
        start = clock >= CLOCKS and len(starts) < 2 and len(sink.items) == (
            len(starts) * len(expected))
        ctx.set(dut.start, start)
        if start:
            starts.append(clock)

    simulate(dut, sink, Drive(drive, CLOCKS + 5),
             Drive(lambda ctx, clock: busy.append(ctx.get(dut.busy))), after=3)
    assert [(item.kind, item.value) for item in sink.items] == expected * 2
    assert not any(busy[:starts[0]]) and not busy[-1]
    return starts, sink, len(expected)


@pytest.mark.parametrize(("units", "end"), [(1, 1), (4, 4), (8, 2), (5, 4), (4, 0)])
@pytest.mark.parametrize("seed", range(2))
def test_counts(units, end, seed):
    run(units, end, seed, pauses(seed))


def test_latency_and_throughput():
    """A clock after it is asked, and then a word a clock."""
    starts, sink, count = run(4, 4, 9, no_pause)
    assert sink.clocks == [start + UnitCounters.latency + place
                           for start in starts for place in range(count)]


def test_bad_sizes():
    rejects(UnitCounters, "units", units=0)
