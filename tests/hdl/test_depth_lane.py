"""Read, compare, write: against a dictionary, fragment by fragment."""

import random

import pytest
from hdl_bench.bench import Watch, simulate
from hdl_bench.memory import MemoryLines
from hdl_bench.pictures import small_machine
from hdl_bench.streams import Source, no_pause, pauses

from cardcage.hdl.depth_lane import DepthLane

CONFIGURATION = small_machine("PMMMM", 8, 8)
WORDS = CONFIGURATION.words


def fragment(unit, address, depth, color):
    return {"unit": unit, "address": address, "depth": depth, "color": color}


def random_fragments(seed, count, *, units, places, depths):
    """Few places and few depths, so that pixels repeat at once and ties are common."""
    pick = random.Random(f"fragments {seed}")
    chosen = [(pick.randrange(units), pick.randrange(WORDS)) for _ in range(places)]
    return [fragment(*pick.choice(chosen), pick.randrange(depths), number)
            for number in range(1, count + 1)]


def run(fragments, *, units, pause=no_pause, scan=0.0, seed=0, background=None,
        refused=0.0):
    """Returns the bench's parts, and the fragments that had to be written, in order."""
    dut = DepthLane(configuration=CONFIGURATION)
    memory = MemoryLines(dut.memory, first=0, end=units, words=WORDS,
                         depth_bits=CONFIGURATION.depth_bits, seed=seed, scan=scan,
                         refused=refused)
    if background is not None:
        memory.depth = dict.fromkeys(memory.depth, background)
    depth, color, winners = dict(memory.depth), dict(memory.back), []
    for item in fragments:
        place = item["unit"], item["address"]
        if item["depth"] < depth[place]:
            depth[place], color[place] = item["depth"], item["color"]
            winners.append(place)
    source = Source(dut.fragments, fragments, pause)
    forwarded, busy = [], []

    def look(ctx, clock):
        forwarded.append(ctx.get(dut.forwarded))
        busy.append(ctx.get(dut.busy))

    simulate(dut, source, memory, Watch(look), after=40)
    assert memory.depth == depth
    assert memory.back == color
    assert [write[1:] for write in memory.writes] == winners
    assert [read[1:] for read in memory.reads] == [(item["unit"], item["address"])
                                                  for item in fragments]
    assert [read[0] for read in memory.reads] == source.taken
    # Busy from the clock after it takes one until the last is decided and written.
    last = max([source.taken[-1] + DepthLane.latency - 1, *(write[0] for write in memory.writes)])
    assert not any(busy[last + 2:])
    assert all(busy[write[0]] for write in memory.writes)
    assert all(busy[clock + step] for clock in source.taken for step in range(1, DepthLane.latency))
    return source, memory, sum(forwarded)


@pytest.mark.parametrize(("scan", "refused"), [
    (0.0, 0.0), (0.3, 0.0), (0.8, 0.0), (0.0, 0.5), (0.3, 0.3)])
@pytest.mark.parametrize("units", [1, 2, 4])
@pytest.mark.parametrize("seed", range(2))
def test_random_fragments(seed, units, scan, refused):
    fragments = random_fragments(f"{seed} {units} {scan}", 250, units=units, places=2 * units,
                                 depths=256)
    _, memory, _ = run(fragments, units=units, pause=pauses(seed), scan=scan, seed=seed,
                       refused=refused)
    assert memory.writes


@pytest.mark.parametrize(("scan", "refused"), [(0.0, 0.0), (0.5, 0.0), (0.0, 0.3), (0.0, 0.6),
                                              (0.2, 0.4)])
@pytest.mark.parametrize("seed", range(3))
def test_one_pixel_in_consecutive_clocks(seed, scan, refused):
    """No update is lost, and the comparison with a winner still on its way takes place; also where
    a winner waits for the lines while its unit is read."""
    pick = random.Random(f"one pixel {seed}")
    # Runs that get nearer and nearer, then farther; ties within.
    fragments = []
    for _ in range(20):
        top = pick.randrange(20, 256)
        depths = [top - pick.choice((0, 1, 2, 5)) * step for step in range(4)]
        fragments += [fragment(0, pick.randrange(2), max(0, depth), pick.getrandbits(24))
                      for depth in depths]
    fragments += [fragment(0, 0, depth, depth + 1) for depth in reversed(range(20))]
    _, _, forwarded = run(fragments, units=1, seed=seed, scan=scan, background=255,
                        refused=refused)
    assert forwarded > 0


@pytest.mark.parametrize("gap", range(1, 7))
@pytest.mark.parametrize("between", [None, 0, 1])
def test_the_same_pixel_after_every_number_of_clocks(gap, between):
    """On one pixel and two, ever nearer or farther."""
    fragments = []
    for step in range(30):
        depth = 250 - 8 * step if step < 20 else 8 * step
        fragments.append(fragment(0, 3, depth, 2 * step + 1))
        # In the clocks between nothing, hidden fragments or winners of other pixels.
        for place in range(gap - 1):
            other = 250 - 4 * step - place if between else 254
            fragments.append(None if between is None else
                             fragment(0, 4 + (place + step) % 2, other, 0x10000 + step))
    waits = [0]
    for item in fragments:
        if item is None:
            waits[-1] += 1
        else:
            waits.append(0)
    run([item for item in fragments if item is not None], units=1, background=253,
        pause=iter(waits).__next__)


def test_ties_keep_the_first():
    fragments = [fragment(unit, 3, 77, color) for unit in (0, 1) for color in range(1, 9)]
    _, memory, forwarded = run(fragments, units=2, background=255)
    assert memory.back[0, 3] == memory.back[1, 3] == 1
    assert forwarded > 0
    # Against what is stored already, too.
    _, memory, _ = run([fragment(0, 5, 77, 1)], units=1, background=77)
    assert not memory.writes


def test_latency():
    """Read in the clock it is taken, written three clocks later."""
    source, memory, _ = run([fragment(0, 0, 1, 1)], units=1, background=255)
    assert source.taken == [0]
    assert memory.writes[0][0] == source.taken[0] + DepthLane.latency == 3


def test_two_units_in_turn_take_a_visible_fragment_a_clock():
    fragments = [fragment(index % 2, index // 2, 5, index) for index in range(2 * WORDS)]
    source, memory, _ = run(fragments, units=2, background=255)
    assert source.taken == list(range(len(fragments)))
    assert [write[0] for write in memory.writes] == [clock + DepthLane.latency
                                                     for clock in source.taken]


def test_one_unit_takes_a_hidden_fragment_a_clock():
    fragments = [fragment(0, index % WORDS, 200, index) for index in range(40)]
    source, memory, _ = run(fragments, units=1, background=0)
    assert source.taken == list(range(len(fragments)))
    assert not memory.writes


def test_one_unit_takes_two_accesses_for_a_visible_fragment():
    fragments = [fragment(0, index, 5, index) for index in range(WORDS)]
    _, memory, _ = run(fragments, units=1, background=255)
    assert len(memory.reads) == len(memory.writes) == WORDS
    # Its port is never idle in between, but for the time the last one takes.
    accesses = sorted(access[0] for access in memory.reads + memory.writes)
    busy = 2 * WORDS - DepthLane.latency
    assert accesses[:busy] == list(range(busy))
    assert accesses[-1] < 2 * WORDS + DepthLane.latency


@pytest.mark.parametrize("units", [1, 2])
def test_a_clear_in_between_is_seen(units):
    """Once it is not busy, what it wrote is forgotten: the memory may be cleared."""
    dut = DepthLane(configuration=CONFIGURATION)
    memory = MemoryLines(dut.memory, first=0, end=units, words=WORDS,
                         depth_bits=CONFIGURATION.depth_bits)
    memory.depth = dict.fromkeys(memory.depth, 255)
    source = Source(dut.fragments, [fragment(0, 4, 10, 1), fragment(0, 4, 200, 2)],
                    lambda: 8)
    idle = []

    def clear(ctx, clock):
        if len(memory.writes) == 1 and not ctx.get(dut.busy):
            if not idle:
                memory.depth[0, 4] = 255
            idle.append(clock)

    simulate(dut, source, memory, Watch(clear), after=8)
    assert idle
    assert (memory.depth[0, 4], memory.back[0, 4]) == (200, 2)
