"""The upper end of a domain, found by asking."""

import random

import pytest
from hdl_bench.bench import Drive, Service, simulate
from hdl_bench.memory import MemoryBusModel
from hdl_bench.streams import no_pause, pauses

from cardcage.golden.cycles.frame_clocks import SURVEY_END, SURVEYED_UNIT
from cardcage.hdl.processing_element.survey import Survey


def survey(first, end, total, *, depth_bits=8, scan=0.0, seed=0, rounds=1, pause=no_pause):
    dut = Survey(id_bits=5, address_bits=4, depth_bits=depth_bits)
    memory = MemoryBusModel(dut.memory, first=first, end=end, words=1, depth_bits=depth_bits,
                         seed=seed, scan=scan)

    def found(ctx):
        assert ctx.get(dut.end) == end

    def lines(ctx, clock):
        ctx.set(dut.first, first)
        ctx.set(dut.total, total)

    service = Service(dut, rounds, pause, found)
    simulate(dut, Drive(lines), service, memory, after=3)
    return service.clocks, memory


def cost(first, end, total):
    """Clocks after the start: write, read, compare and decide twice a unit, once at the one that
    is silent, one clock to see that there are no more."""
    return SURVEYED_UNIT * (end - first) + (1 if end == total else SURVEY_END)


@pytest.mark.parametrize("total", [1, 2, 5, 8, 16])
def test_every_domain(total):
    for first in range(total + 1):
        for end in range(first, total + 1):
            clocks, memory = survey(first, end, total, seed=first * total + end)
            assert clocks == [cost(first, end, total)]
            # Every bit of the word was seen both ways.
            written = [write[1] for write in memory.writes]
            for unit in range(first, end):
                assert written.count(unit) == 2


@pytest.mark.parametrize("depth_bits", [2, 3, 8, 24, 32])
@pytest.mark.parametrize("seed", range(2))
def test_random_domains_while_the_scan_takes_ports(seed, depth_bits):
    pick = random.Random(f"domains {seed} {depth_bits}")
    for _ in range(4):
        total = pick.randrange(1, 17)
        first = pick.randrange(total + 1)
        end = pick.randrange(first, total + 1)
        clocks, _ = survey(first, end, total, depth_bits=depth_bits, scan=0.5, seed=seed,
                           rounds=3, pause=pauses(seed))
        assert min(clocks) >= cost(first, end, total)


@pytest.mark.parametrize("stuck", [0b0000_0001, 0b1000_0000, 0b0110_0000])
@pytest.mark.parametrize("level", [0, 1])
def test_a_unit_with_a_stuck_bit_is_not_found(stuck, level):
    """Not one that a single pattern would have let pass."""
    dut = Survey(id_bits=5, address_bits=4, depth_bits=8)

    class Stuck(MemoryBusModel):
        def drive(self, ctx):
            self._answer = self._answer | stuck if level else self._answer & ~stuck
            super().drive(ctx)

    memory = Stuck(dut.memory, first=0, end=3, words=1, depth_bits=8)
    service = Service(dut, at_done=lambda ctx: ends.append(ctx.get(dut.end)))
    ends = []
    simulate(dut, Drive(lambda ctx, clock: ctx.set(dut.total, 3)), service, memory)
    assert ends == [0]
