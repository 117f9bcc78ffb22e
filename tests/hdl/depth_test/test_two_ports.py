"""Read, compare, write without ever waiting: against a dictionary, fragment by fragment."""

import pytest
from hdl_bench.bench import rejects
from hdl_bench.depth_tests import (
    DepthTestRun,
    fragment,
    keeps_the_first_of_ties,
    on_few_pixels,
    on_one_pixel_after,
    on_one_pixel_in_consecutive_clocks,
    sees_a_clear_in_between,
)
from hdl_bench.streams import no_pause, pauses

from cardcage.hdl.depth_test.two_ports import TwoPortDepthTest

WORDS = 16
BITS = {"id_bits": 3, "address_bits": 4, "depth_bits": 8}
LATENCY = TwoPortDepthTest.latency


def draw(fragments, *, units=2, **settings):
    """What is read in the clock in which it is written is random there."""
    run = DepthTestRun(TwoPortDepthTest(**BITS), fragments, units=units, words=WORDS, after=8,
                       ports=2, **settings)
    places = [(item["unit"], item["address"]) for item in fragments]
    taken, busy = run.source.taken, run.busy
    # Read in the clock in which it is taken, written LATENCY later, whatever comes.
    assert run.memory.reads == [(clock, *place)
                                for clock, place in zip(taken, places, strict=True)]
    assert run.memory.writes == [(taken[number] + LATENCY, *places[number])
                                 for number in run.winners]
    assert all(busy[clock + step] for clock in taken for step in range(1, LATENCY))
    assert all(busy[write[0]] for write in run.memory.writes)
    assert not any(busy[taken[-1] + LATENCY + 1:])
    # A winner written now or a clock ago is what the fragment read a clock ago has to see; the one
    # a clock ahead of it is seen a clock later.
    read, written = dict(zip(taken, places, strict=True)), {
        clock: place for clock, *place in run.memory.writes}
    assert run.forwarded_in == [
        clock for clock in range(len(busy))
        if same(read.get(clock - 1), written.get(clock), written.get(clock - 1))
        or same(read.get(clock - 2), written.get(clock))]
    return run


def same(place, *others):
    return place is not None and list(place) in others


@pytest.mark.parametrize("units", [1, 2, 4])
@pytest.mark.parametrize("seed", range(4))
def test_random_fragments(seed, units):
    run = draw(on_few_pixels(f"{seed} {units}", 400, units=units, words=WORDS), units=units,
               seed=seed, pause=pauses(seed) if seed % 2 else no_pause)
    assert run.memory.writes and run.forwarded


@pytest.mark.parametrize("seed", range(3))
def test_one_pixel_in_consecutive_clocks(seed):
    fragments = on_one_pixel_in_consecutive_clocks(seed, 40)
    assert draw(fragments, units=1, seed=seed, background=255).forwarded > 0


@pytest.mark.parametrize("gap", range(1, 7))
@pytest.mark.parametrize("between", [None, 0, 1])
def test_the_same_pixel_after_every_number_of_clocks(gap, between):
    """Also in the very clock in which the winner is written, while another one follows it."""
    fragments, pause = on_one_pixel_after(gap, between)
    draw(fragments, units=1, background=253, pause=pause)


@pytest.mark.parametrize("units", [1, 2])
def test_a_fragment_a_clock(units):
    fragments = [fragment(index % units, index // units, 5, index)
                 for index in range(units * WORDS)]
    run = draw(fragments, units=units, background=255)
    assert run.source.taken == list(range(len(fragments)))
    assert LATENCY == 3 and len(run.memory.writes) == len(fragments)


def test_ties_keep_the_first():
    keeps_the_first_of_ties(lambda fragments, far: draw(fragments, background=far))


def test_a_clear_in_between_is_seen():
    sees_a_clear_in_between(TwoPortDepthTest(**BITS), 1, 8, words=WORDS)


@pytest.mark.parametrize("name", BITS)
def test_bad_sizes(name):
    rejects(TwoPortDepthTest, name, **BITS | {name: 0})
