"""Two lanes on the lines of one-port units: each pixel as if one fragment came after the other."""

import random

import pytest
from hdl_bench.bench import Watch, simulate
from hdl_bench.memory import MemoryLines
from hdl_bench.pictures import small_machine
from hdl_bench.streams import Source, no_pause, pauses

from cardcage.hdl.depth_test import DepthTest

CONFIGURATION = small_machine("PMMMM", 16, 16)
WORDS = CONFIGURATION.words


def fragment(unit, address, depth, color):
    return {"unit": unit, "address": address, "depth": depth, "color": color}


class Run:
    """Draws ``fragments``, and compares memory and order with a dictionary."""

    def __init__(self, fragments, *, units, configuration=CONFIGURATION, pause=no_pause, scan=0.0,
                 seed=0, background=None):
        self.dut = dut = DepthTest(configuration=configuration)
        self.memory = memory = MemoryLines(
            dut.memory, first=0, end=units, words=configuration.words,
            depth_bits=configuration.depth_bits, seed=seed, scan=scan)
        if background is not None:
            memory.depth = dict.fromkeys(memory.depth, background)
        depth, color, winners = dict(memory.depth), dict(memory.back), []
        for item in fragments:
            place = item["unit"], item["address"]
            if item["depth"] < depth[place]:
                depth[place], color[place] = item["depth"], item["color"]
                winners.append(place)
        self.source = Source(dut.fragments, fragments, pause)
        self.forwarded, busy = 0, []

        def look(ctx, clock):
            self.forwarded += ctx.get(dut.forwarded)
            busy.append(ctx.get(dut.busy))

        simulate(dut, self.source, memory, Watch(look), after=12 * 40)
        assert memory.depth == depth
        assert memory.back == color
        for parity in range(2):  # in order in each lane
            for accesses, wanted in (
                    (memory.reads, [(item["unit"], item["address"]) for item in fragments]),
                    (memory.writes, winners)):
                assert [place[1:] for place in accesses if place[1] % 2 == parity] == [
                    place for place in wanted if place[0] % 2 == parity]
        accesses = [access[0] for access in memory.reads + memory.writes]
        self.clocks = max(accesses) - self.source.taken[0] + 1
        held = [access[0] for access in memory.writes + memory.reads * (dut.lanes == 2)]
        assert all(busy[clock] for clock in held)
        assert not any(busy[max(accesses) + dut.latency:])

    def per_unit(self, unit):
        """Accesses of one unit."""
        return sum(access[1] == unit for access in self.memory.reads + self.memory.writes)


@pytest.mark.parametrize("cards", ["PM", "PMPM", "PMM", "PMPMMM"])
def test_two_lanes_where_a_processing_element_has_several_units(cards):
    run = Run([fragment(0, 3, 7, 1)], units=1, configuration=small_machine(cards), background=255)
    dut = run.dut
    assert (dut.lanes, dut.waiting) == ((2, 2) if "MM" in cards else (1, 0))
    assert run.memory.reads[0][0] == dut.waiting
    assert run.memory.writes[0][0] == dut.waiting + dut.latency


@pytest.mark.parametrize("cards", ["PM", "PMMMM"])
@pytest.mark.parametrize("scan", [0.0, 0.3, 0.8])
@pytest.mark.parametrize("units", [1, 2, 4])
@pytest.mark.parametrize("seed", range(2))
def test_random_fragments_on_few_pixels(seed, units, scan, cards):
    """Pixels repeat at once and ties are common; a card of one lane may find more units, too."""
    configuration = small_machine(cards, 16, 16, maximum_units=4, words=64)
    pick = random.Random(f"fragments {seed} {units} {scan}")
    chosen = [(pick.randrange(units), pick.randrange(64)) for _ in range(2 * units)]
    fragments = [fragment(*pick.choice(chosen), pick.randrange(256), number)
                 for number in range(250)]
    run = Run(fragments, units=units, configuration=configuration, pause=pauses(seed), scan=scan,
              seed=seed)
    assert run.memory.writes


@pytest.mark.parametrize("scan", [0.0, 0.2, 0.5])
@pytest.mark.parametrize("seed", range(3))
def test_a_pixel_of_each_lane_nearer_and_nearer(seed, scan):
    """Every fragment is a winner that waits for its port, and often for the lines."""
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


def test_units_of_one_lane_take_a_visible_fragment_a_clock():
    """As many pixels as there are, from units with even numbers in turn."""
    fragments = [fragment(2 * (index % 2), index // 2, 5, index) for index in range(2 * WORDS)]
    run = Run(fragments, units=4, background=255)
    assert run.clocks == 2 * WORDS + run.dut.waiting + run.dut.latency


def test_a_clear_in_between_is_seen():
    """Once it is not busy, what it wrote is forgotten: the memory may be cleared."""
    dut = DepthTest(configuration=CONFIGURATION)
    memory = MemoryLines(dut.memory, first=0, end=2, words=WORDS,
                         depth_bits=CONFIGURATION.depth_bits)
    memory.depth = dict.fromkeys(memory.depth, 255)
    source = Source(dut.fragments, [fragment(1, 4, 10, 1), fragment(1, 4, 200, 2)], lambda: 12)
    idle = []

    def clear(ctx, clock):
        if len(memory.writes) == 1 and not ctx.get(dut.busy):
            if not idle:
                memory.depth[1, 4] = 255
            idle.append(clock)

    simulate(dut, source, memory, Watch(clear), after=16)
    assert idle
    assert (memory.depth[1, 4], memory.back[1, 4]) == (200, 2)
