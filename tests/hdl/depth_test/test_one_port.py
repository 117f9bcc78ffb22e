"""One or two lanes on the bus of one-port units: each pixel as if one fragment came after the
other."""

import random
from itertools import cycle

import pytest
from hdl_bench.bench import Drive, Watch, rejects, simulate
from hdl_bench.depth_tests import (
    DepthTestRun,
    fragment,
    on_few_pixels,
    sees_a_clear_in_between,
)
from hdl_bench.memory import MemoryBusModel
from hdl_bench.pictures import small_machine
from hdl_bench.streams import Source, pauses
from suite.cases import chosen

from cardcage.hdl.components import COMPONENTS
from cardcage.hdl.depth_test.one_port import OnePortDepthTest

CONFIGURATION = small_machine("PMMMM", 16, 16)
WORDS = CONFIGURATION.words


class Run(DepthTestRun):
    """In order in each lane.  ``clocks`` are those from the first fragment to the last access."""

    def __init__(self, fragments, *, configuration=CONFIGURATION, **settings):
        self.dut = dut = COMPONENTS["one_port_depth_test"](configuration)
        super().__init__(dut, fragments, words=configuration.words, after=12 * 40, **settings)
        memory, busy = self.memory, self.busy
        places = [(item["unit"], item["address"]) for item in fragments]
        for parity in range(2):
            for accesses, wanted in (
                    (memory.reads, places),
                    (memory.writes, [places[number] for number in self.winners])):
                assert [place[1:] for place in accesses if place[1] % 2 == parity] == [
                    place for place in wanted if place[0] % 2 == parity]
        accesses = [access[0] for access in memory.reads + memory.writes]
        self.clocks = max(accesses) - self.source.taken[0] + 1
        held = [access[0] for access in memory.writes + memory.reads]
        assert all(busy[clock] for clock in held)
        assert not any(busy[max(accesses) + dut.latency:])

    def per_unit(self, unit):
        """Accesses of one unit."""
        return sum(access[1] == unit for access in self.memory.reads + self.memory.writes)


@pytest.mark.parametrize("cards", ["PM", "PMPM", "PMM", "PMPMMM"])
def test_two_lanes_where_a_processing_element_has_several_units(cards):
    run = Run([fragment(0, 3, 7, 1)], units=1, configuration=small_machine(cards), background=255)
    dut = run.dut
    assert dut.lanes == (2 if "MM" in cards else 1)
    assert run.memory.reads[0][0] == dut.waiting
    assert run.memory.writes[0][0] == dut.waiting + dut.latency


@pytest.mark.parametrize("cards", ["PM", "PMMMM"])
@pytest.mark.parametrize("scan", chosen([0.0, 0.3, 0.8], 0.3))
@pytest.mark.parametrize("units", [1, 2, 4])
def test_random_fragments_on_few_pixels(units, scan, cards):
    """A card of one lane may find more units, too."""
    seed = f"{units} {scan} {cards}"
    configuration = small_machine(cards, 16, 16, maximum_units=4, words=64)
    fragments = on_few_pixels(seed, 300, units=units, words=64)
    run = Run(fragments, units=units, configuration=configuration, pause=pauses(seed), scan=scan,
              seed=seed)
    assert run.memory.writes


@pytest.mark.parametrize("scan", [0.0, 0.2, 0.5])
@pytest.mark.parametrize("seed", chosen(range(3), 0))
def test_a_pixel_of_each_lane_nearer_and_nearer(seed, scan):
    """Every fragment is a winner that waits for its port, and often for the bus."""
    pick = random.Random(f"nearer {seed}")
    depths, fragments = [255, 255], []
    while min(depths) > 3:
        unit = pick.choice((0, 0, 1, 1, pick.randrange(2)))
        depths[unit] -= pick.choice((0, 1, 1, 1))
        fragments.append(fragment(unit, 5, depths[unit], pick.getrandbits(24)))
    run = Run(fragments, units=2, seed=seed, scan=scan, background=255)
    print(f"{run.forwarded} of {len(fragments)} compared with a winner on its way")
    assert run.forwarded > len(fragments) / 4


def visible(runs):
    """Fragments of ever new pixels, so many in each unit's turn."""
    places = [0, 0]
    for number, length in enumerate(runs):
        unit = number % 2
        for _ in range(length):
            yield fragment(unit, places[unit] % WORDS, 250 - places[unit] // WORDS, number)
            places[unit] += 1


@pytest.mark.parametrize("longest", [1, 2, 6, 12])
@pytest.mark.parametrize("scan", [0.0, 0.12])
def test_ports_are_hardly_ever_idle(longest, scan):
    """Runs of random lengths in one unit and the other: within two percent of the accesses of the
    busier port."""
    pick = random.Random(f"runs {longest}")
    fragments = list(visible([pick.randint(1, longest) for _ in range(1000 // longest)]))
    run = Run(fragments, units=2, background=255, scan=scan)
    bound = max(run.per_unit(0), run.per_unit(1)) / (1 - scan)
    print(f"{run.clocks} clocks, bound {bound:.0f}: {bound / run.clocks:.3f} of it")
    # The scan may take this run's ports a little more or less often than on average.
    assert run.clocks <= (1.02 if not scan else 1.06) * bound + 12


def test_hidden_fragments_take_a_clock_each():
    fragments = [fragment(index // 4 % 2, index % WORDS, 200, index) for index in range(200)]
    run = Run(fragments, units=2, background=0)
    assert run.source.taken == list(range(200))
    assert run.clocks == 200 + run.dut.waiting
    assert not run.memory.writes


def test_one_unit_takes_two_clocks_a_visible_fragment():
    run = Run([fragment(0, index % WORDS, 5, index) for index in range(WORDS)], units=1,
              background=255)
    assert 2 * WORDS <= run.clocks <= 2 * WORDS + run.dut.waiting + 3


@pytest.mark.parametrize("cards", ["PM", "PMMMM"])
def test_ports_work_while_no_fragment_comes(cards):
    """Bursts of eight, and eight clocks between: a port that is never idle takes as long."""
    waits = cycle([8] + [0] * 7)
    run = Run([fragment(0, index % WORDS, 250 - index // WORDS, index) for index in range(160)],
              units=1, background=255, configuration=small_machine(cards, 16, 16),
              pause=waits.__next__)
    assert run.clocks <= 2 * 160 + run.dut.waiting + 3


def test_units_of_one_lane_take_a_visible_fragment_a_clock():
    """As many pixels as there are, from units with even numbers in turn."""
    fragments = [fragment(2 * (index % 2), index // 2, 5, index) for index in range(2 * WORDS)]
    run = Run(fragments, units=4, background=255)
    assert run.clocks == 2 * WORDS + run.dut.waiting + run.dut.latency


@pytest.mark.parametrize("parity", [0, 1])
def test_both_lanes_have_their_turn(parity):
    """One winner among many of the other lane, of which one is written every clock: once its port
    is free it is the next one."""
    dut = COMPONENTS["one_port_depth_test"](CONFIGURATION)
    fragments = [fragment(2 * (index % 2) + parity, index // 2, 5, index) for index in range(60)]
    fragments.insert(20, fragment(1 - parity, 3, 5, 99))
    source = Source(dut.fragments, fragments)
    read, written = [], {0: [], 1: []}

    def ports(ctx, clock):
        ctx.set(dut.memory.read_data, 255)
        scanned = read and clock < read[0] + dut.latency + 5
        ctx.set(dut.memory.scanned, 1 << 1 - parity if scanned else 0)

    def look(ctx, clock):
        reads, write = ctx.get(dut.memory.read), ctx.get(dut.memory.write)
        if reads.valid and reads.unit == 1 - parity:
            read.append(clock)
        if write.valid:
            written[write.unit % 2].append(clock)

    simulate(dut, Drive(ports), source, Watch(look), after=60)
    assert len(read) == 1 and len(written[parity]) == 60
    free = read[0] + dut.latency + 5
    assert written[1 - parity] == [free]
    assert {free - 1, free + 1} <= set(written[parity])


@pytest.mark.parametrize("seed", range(3))
def test_a_lane_keeps_still_while_the_scan_has_a_port_of_its_units(seed):
    """So the bus is never kept from the other lane by a request that has to wait."""
    dut = COMPONENTS["one_port_depth_test"](CONFIGURATION)
    source = Source(dut.fragments, on_few_pixels(f"still {seed}", 250, units=4, words=WORDS))
    memory = MemoryBusModel(dut.memory, first=0, end=4, words=WORDS, depth_bits=dut.depth_bits,
                            seed=seed, scan=0.4)
    moved = 0

    def look(ctx, clock):
        nonlocal moved
        scanned = ctx.get(dut.memory.scanned)
        for request in (ctx.get(dut.memory.read), ctx.get(dut.memory.write)):
            if request.valid:
                assert not scanned >> request.unit % 2 & 1
                moved += scanned != 0

    simulate(dut, source, memory, Watch(look), after=100)
    assert moved > 50, "the other lane goes on"


def test_a_clear_in_between_is_seen():
    sees_a_clear_in_between(COMPONENTS["one_port_depth_test"](CONFIGURATION), 1, 12, words=WORDS)


@pytest.mark.parametrize(("name", "wrong"), [("lanes", 0), ("lanes", 3), ("depth_bits", 0)])
def test_bad_sizes(name, wrong):
    sizes = {"id_bits": 3, "address_bits": 6, "depth_bits": 8, "lanes": 2}
    rejects(OnePortDepthTest, name, **sizes | {name: wrong})
