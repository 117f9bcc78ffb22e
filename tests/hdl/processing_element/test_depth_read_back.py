"""Depth words of a domain, in order."""

import pytest
from hdl_bench.bench import Drive, Service, simulate
from hdl_bench.memory import MemoryBusModel
from hdl_bench.streams import Sink, no_pause, pauses

from cardcage.golden.cycles.frame_clocks import READ_BACK
from cardcage.hdl.processing_element.depth_read_back import DepthReadBack

WORDS = 16


def read_back(first, end, words, *, scan=0.0, seed=0, rounds=1, pause=no_pause, gap=no_pause):
    dut = DepthReadBack(id_bits=3, address_bits=4, depth_bits=8)
    memory = MemoryBusModel(dut.memory, first=first, end=end, words=WORDS, depth_bits=8,
                         seed=seed, scan=scan)

    def inputs(ctx, clock):
        ctx.set(dut.first, first)
        ctx.set(dut.end, end)
        ctx.set(dut.last_word, words - 1)

    expected = [memory.depth[unit, address]
                for unit in range(first, end) for address in range(words)] * rounds
    sink = Sink(dut.depths, len(expected), pause, zero=True)
    taken = []
    service = Service(dut, rounds, gap, lambda ctx: taken.append(len(sink.items)))
    # The sink looks first: at done the last word has been taken.
    simulate(dut, Drive(inputs), sink, service, memory, after=3)
    assert sink.items == expected
    assert taken == [len(expected) * (round_ + 1) // rounds for round_ in range(rounds)]
    assert not memory.writes
    return service, sink, memory


@pytest.mark.parametrize("seed", range(3))
@pytest.mark.parametrize(("first", "end", "words"), [(0, 4, 16), (1, 3, 5), (3, 4, 1), (2, 2, 9)])
def test_units_in_order_addresses_ascending(first, end, words, seed):
    read_back(first, end, words, scan=0.3 * seed, seed=seed, rounds=2, pause=pauses(seed),
              gap=pauses(-seed))


def test_latency_and_throughput():
    service, sink, memory = read_back(0, 4, 16)
    reads = [read[0] for read in memory.reads]
    assert reads == list(range(1, 1 + 64 * READ_BACK, READ_BACK))
    assert sink.clocks == [clock + DepthReadBack.latency for clock in reads]
    # Done in the clock in which the last word is taken.
    assert service.ended == [sink.clocks[-1]]
