"""Read, compare, write without ever waiting: against a dictionary, fragment by fragment."""

import random

import pytest
from hdl_bench.bench import Watch, simulate
from hdl_bench.memory import MemoryLines
from hdl_bench.pictures import small_machine
from hdl_bench.streams import Source, no_pause, pauses

from cardcage.hdl.two_port_depth_test import TwoPortDepthTest

CONFIGURATION = small_machine("PMMMM", 8, 8, memory_ports=2)
WORDS = CONFIGURATION.words
LATENCY = TwoPortDepthTest.latency


def fragment(unit, address, depth, color):
    return {"unit": unit, "address": address, "depth": depth, "color": color}


def run(fragments, *, units, pause=no_pause, seed=0, background=None):
    """Returns the memory, and how often a depth was forwarded.

    What is read in the clock in which it is written is random there.
    """
    dut = TwoPortDepthTest(configuration=CONFIGURATION)
    memory = MemoryLines(dut.memory, first=0, end=units, words=WORDS,
                         depth_bits=CONFIGURATION.depth_bits, seed=seed, ports=2)
    if background is not None:
        memory.depth = dict.fromkeys(memory.depth, background)
    depth, color, winners = dict(memory.depth), dict(memory.back), []
    for number, item in enumerate(fragments):
        place = item["unit"], item["address"]
        if item["depth"] < depth[place]:
            depth[place], color[place] = item["depth"], item["color"]
            winners.append((number, *place))
    source = Source(dut.fragments, fragments, pause)
    forwarded, busy = [], []

    def look(ctx, clock):
        forwarded.append(ctx.get(dut.forwarded))
        busy.append(ctx.get(dut.busy))
        if clock > 1 and not any(busy[-2:]):
            assert ctx.get(dut.memory.write).address == 0

    simulate(dut, source, memory, Watch(look), after=8)
    assert memory.depth == depth and memory.back == color
    # Read in the clock in which it is taken, written LATENCY later, whatever comes.
    assert memory.reads == [(clock, item["unit"], item["address"])
                            for clock, item in zip(source.taken, fragments, strict=True)]
    assert memory.writes == [(source.taken[number] + LATENCY, *place)
                             for number, *place in winners]
    assert all(busy[clock + step] for clock in source.taken for step in range(1, LATENCY))
    assert all(busy[write[0]] for write in memory.writes)
    assert not any(busy[source.taken[-1] + LATENCY + 1:])
    return source, memory, sum(forwarded)


@pytest.mark.parametrize("units", [1, 2, 4])
@pytest.mark.parametrize("seed", range(4))
def test_random_fragments(seed, units):
    """Few places and few depths, so that pixels repeat at once and ties are common."""
    pick = random.Random(f"fragments {seed} {units}")
    chosen = [(pick.randrange(units), pick.randrange(WORDS)) for _ in range(2 * units)]
    fragments = [fragment(*pick.choice(chosen), pick.randrange(256), number)
                 for number in range(1, 400)]
    _, memory, forwarded = run(fragments, units=units, seed=seed,
                               pause=pauses(seed) if seed % 2 else no_pause)
    assert memory.writes and forwarded


@pytest.mark.parametrize("seed", range(3))
def test_one_pixel_in_consecutive_clocks(seed):
    """Runs that get nearer and nearer, then farther; ties within."""
    pick = random.Random(f"one pixel {seed}")
    fragments = []
    for _ in range(40):
        top = pick.randrange(20, 256)
        fragments += [fragment(0, pick.randrange(2), max(0, top - pick.choice((0, 1, 2, 5)) * step),
                               pick.getrandbits(24)) for step in range(4)]
    fragments += [fragment(0, 0, depth, depth + 1) for depth in reversed(range(20))]
    *_, forwarded = run(fragments, units=1, seed=seed, background=255)
    assert forwarded > 0


@pytest.mark.parametrize("gap", range(1, 7))
@pytest.mark.parametrize("between", [None, 0, 1])
def test_the_same_pixel_after_every_number_of_clocks(gap, between):
    """On one pixel, ever nearer or farther: also in the very clock in which the winner is written,
    while another one follows it."""
    fragments, waits = [], [0]
    for step in range(30):
        depth = 250 - 8 * step if step < 20 else 8 * step
        fragments.append(fragment(0, 3, depth, 2 * step + 1))
        waits.append(0)
        # In the clocks between nothing, hidden fragments or winners of other pixels.
        for place in range(gap - 1):
            if between is None:
                waits[-1] += 1
            else:
                other = 250 - 4 * step - place if between else 254
                fragments.append(fragment(0, 4 + (place + step) % 2, other, 0x10000 + step))
                waits.append(0)
    run(fragments, units=1, background=253, pause=iter(waits).__next__)


@pytest.mark.parametrize("units", [1, 2])
def test_a_fragment_a_clock(units):
    fragments = [fragment(index % units, index // units, 5, index)
                 for index in range(units * WORDS)]
    source, memory, _ = run(fragments, units=units, background=255)
    assert source.taken == list(range(len(fragments)))
    assert LATENCY == 3 and len(memory.writes) == len(fragments)


def test_ties_keep_the_first():
    fragments = [fragment(unit, 3, 77, color) for unit in (0, 1) for color in range(1, 9)]
    _, memory, forwarded = run(fragments, units=2, background=255)
    assert memory.back[0, 3] == memory.back[1, 3] == 1
    assert forwarded > 0
    # Against what is stored already, too.
    _, memory, _ = run([fragment(0, 5, 77, 1)], units=1, background=77)
    assert not memory.writes
