"""Read, compare, write: against a dictionary, fragment by fragment."""

import pytest
from hdl_bench.bench import Drive, Watch, rejects, simulate
from hdl_bench.depth_tests import (
    DepthTestRun,
    fragment,
    keeps_the_first_of_ties,
    on_few_pixels,
    on_one_pixel_after,
    on_one_pixel_in_consecutive_clocks,
    sees_a_clear_in_between,
)
from hdl_bench.streams import Source, pauses

from cardcage.hdl.depth_test.one_port_lane import OnePortLane

WORDS = 16
BITS = {"id_bits": 3, "address_bits": 4, "depth_bits": 8}


def draw(fragments, *, units=2, **settings):
    """In order: a read as it is taken, a write of each winner."""
    run = DepthTestRun(OnePortLane(**BITS), fragments, units=units, words=WORDS, **settings)
    places = [(item["unit"], item["address"]) for item in fragments]
    memory, taken, busy = run.memory, run.source.taken, run.busy
    assert [write[1:] for write in memory.writes] == [places[number] for number in run.winners]
    assert [read[1:] for read in memory.reads] == places
    assert [read[0] for read in memory.reads] == taken
    # Busy from the clock after it takes one until the last is decided and written.
    last = max([taken[-1] + OnePortLane.latency - 1, *(write[0] for write in memory.writes)])
    assert not any(busy[last + 2:])
    assert all(busy[write[0]] for write in memory.writes)
    assert all(busy[clock + step] for clock in taken for step in range(1, OnePortLane.latency))
    assert run.forwarded_in == list(forwarded_in(run, places))
    return run


def forwarded_in(run, places):
    """The clocks in which a fragment is compared with a winner of its pixel that is written just
    then, or was written last, when nothing was idle since."""
    written = {number: write[0] for number, write in
               zip(run.winners, run.memory.writes, strict=True)}
    compared, last, before = -1, None, None  # the last winner, and the one before it
    for number, place in enumerate(places):
        answered = max(run.source.taken[number] + 1, compared)
        compared = max(answered + 1, -1 if last is None else written[last])
        for winner in (last, before) if last is not None and written[last] == compared else (last,):
            if winner is not None and places[winner] == place and all(
                    run.busy[written[winner] + 1:compared]):
                yield compared
                break
        if number in written:
            last, before = number, last


@pytest.mark.parametrize(("scan", "refused"), [
    (0.0, 0.0), (0.3, 0.0), (0.8, 0.0), (0.0, 0.5), (0.3, 0.3)])
@pytest.mark.parametrize("units", [1, 2, 4])
@pytest.mark.parametrize("seed", [1])
def test_random_fragments(seed, units, scan, refused):
    fragments = on_few_pixels(f"{seed} {units} {scan}", 250, units=units, words=WORDS)
    run = draw(fragments, units=units, pause=pauses(seed), scan=scan, seed=seed, refused=refused)
    assert run.memory.writes


@pytest.mark.parametrize(("scan", "refused"), [(0.0, 0.0), (0.5, 0.0), (0.0, 0.3), (0.0, 0.6),
                                              (0.2, 0.4)])
@pytest.mark.parametrize("seed", range(3))
def test_one_pixel_in_consecutive_clocks(seed, scan, refused):
    """No update is lost, and the comparison with a winner still on its way takes place; also where
    a winner waits for the bus while its unit is read."""
    fragments = on_one_pixel_in_consecutive_clocks(seed, 20)
    assert draw(fragments, units=1, seed=seed, scan=scan, background=255,
                refused=refused).forwarded > 0


@pytest.mark.parametrize("gap", range(1, 7))
@pytest.mark.parametrize("between", [None, 0, 1])
def test_the_same_pixel_after_every_number_of_clocks(gap, between):
    fragments, pause = on_one_pixel_after(gap, between)
    draw(fragments, units=1, background=253, pause=pause)


def test_ties_keep_the_first():
    keeps_the_first_of_ties(lambda fragments, far: draw(fragments, background=far))


def test_latency():
    """Read in the clock it is taken, written three clocks later."""
    run = draw([fragment(0, 0, 1, 1)], units=1, background=255)
    source, memory = run.source, run.memory
    assert source.taken == [0]
    assert memory.writes[0][0] == source.taken[0] + OnePortLane.latency == 3


def test_while_a_winner_waits_two_more_fragments_are_read():
    """Each as soon as it comes: no stage that is empty waits for the one after it."""
    lane = OnePortLane(**BITS)
    gap, free = 6, 50
    source = Source(lane.fragments, [fragment(0, index, 5, index) for index in range(4)],
                    lambda: gap)
    written = []

    def port(ctx, clock):
        ctx.set(lane.memory.write_busy, clock < free)
        ctx.set(lane.memory.read_data, 255)

    def watch(ctx, clock):
        if ctx.get(lane.memory.write).valid and clock >= free:
            written.append(ctx.get(lane.memory.write).address)

    simulate(lane, Drive(port), source, Watch(watch), after=10)
    first = gap
    assert source.taken == [first, first + gap + 1, first + 2 * (gap + 1), free]
    assert written == [0, 1, 2, 3]


def test_two_units_in_turn_take_a_visible_fragment_a_clock():
    fragments = [fragment(index % 2, index // 2, 5, index) for index in range(2 * WORDS)]
    run = draw(fragments, units=2, background=255)
    source, memory = run.source, run.memory
    assert source.taken == list(range(len(fragments)))
    assert [write[0] for write in memory.writes] == [clock + OnePortLane.latency
                                                     for clock in source.taken]


def test_one_unit_takes_a_hidden_fragment_a_clock():
    fragments = [fragment(0, index % WORDS, 200, index) for index in range(40)]
    run = draw(fragments, units=1, background=0)
    source, memory = run.source, run.memory
    assert source.taken == list(range(len(fragments)))
    assert not memory.writes


def test_one_unit_takes_two_accesses_for_a_visible_fragment():
    fragments = [fragment(0, index, 5, index) for index in range(WORDS)]
    memory = draw(fragments, units=1, background=255).memory
    assert len(memory.reads) == len(memory.writes) == WORDS
    # Its port is never idle in between, but for the time the last one takes.
    accesses = sorted(access[0] for access in memory.reads + memory.writes)
    busy = 2 * WORDS - OnePortLane.latency
    assert accesses[:busy] == list(range(busy))
    assert accesses[-1] < 2 * WORDS + OnePortLane.latency


@pytest.mark.parametrize("unit", [0, 1])
def test_a_clear_in_between_is_seen(unit):
    sees_a_clear_in_between(OnePortLane(**BITS), unit, 8, words=WORDS)


@pytest.mark.parametrize("name", BITS)
def test_bad_sizes(name):
    rejects(OnePortLane, name, **BITS | {name: 0})
