"""Three results become one word, and words wait."""

import random

import pytest
from hdl_bench.bench import Drive, rejects, simulate
from hdl_bench.streams import Sink, no_pause, pauses

from cardcage.hdl.triangle_setup.result_queue import ResultQueue


def run(depth, words, pause, gap):
    """Write results at random times, never more words than there is room for."""
    dut = ResultQueue(result_bits=7, depth=depth)
    pick = random.Random(f"results {depth}")
    results = [pick.randrange(128) for _ in range(3 * words)]
    sink = Sink(dut.words, words, pause)
    written, wait = [], 0

    def drive(ctx, clock):
        nonlocal wait
        room = len(written) // 3 < len(sink.items) + depth
        go = len(written) < len(results) and room and wait == 0
        ctx.set(dut.write, go)
        ctx.set(dut.result, results[len(written)] if go else pick.randrange(128))
        if go:
            written.append(clock)
            wait = gap()
        elif wait:
            wait -= 1

    simulate(dut, Drive(drive), sink, after=2)
    assert [list(item) for item in sink.items] == [results[place:place + 3]
                                                   for place in range(0, len(results), 3)]
    return dut, written, sink


@pytest.mark.parametrize("depth", [2, 3, 16])
@pytest.mark.parametrize("seed", range(2))
def test_nothing_is_lost(depth, seed):
    gaps = random.Random(f"gaps {seed}")
    run(depth, 60, pauses(f"{depth} {seed}"), lambda: gaps.choice((0, 0, 0, 5)))


def test_latency_and_throughput():
    dut, written, sink = run(4, 20, no_pause, lambda: 0)
    assert written == list(range(60))
    assert sink.clocks == [clock + dut.latency for clock in written[2::3]]


def test_sizes():
    rejects(ResultQueue, "depth", result_bits=3, depth=1)
    rejects(ResultQueue, "result_bits", result_bits=0, depth=2)
