"""Responses of the cards, in the order of the cards."""

import random

import pytest
from hdl_bench.bench import Drive, simulate
from hdl_bench.streams import Sink, Source, no_pause, pauses

from cardcage.hdl.backplane.response_link import ResponseLink


def words(seed, count):
    pick = random.Random(f"responses {seed}")
    return [{"kind": pick.getrandbits(8), "value": pick.getrandbits(32)} for _ in range(count)]


def run(own, right, pause=(no_pause,) * 3, turn=None):
    dut = ResponseLink()
    own_source = Source(dut.own, own, pause[0], zero=True)
    right_source = Source(dut.right, right, pause[1])
    sink = Sink(dut.left, len(own) + len(right), pause[2])

    def decide(ctx, clock):
        mine = turn(clock) if turn else not own_source.finished
        ctx.set(dut.own_turn, mine or ctx.get(dut.own.valid))

    simulate(dut, own_source, right_source, Drive(decide), sink, after=3)
    return own_source, right_source, sink, [
        {"kind": item.kind, "value": item.value} for item in sink.items]


@pytest.mark.parametrize("seed", range(4))
def test_own_first_then_the_right(seed):
    own, right = words(f"own {seed}", 20), words(f"right {seed}", 20)
    *_, items = run(own, right, [pauses(f"{end} {seed}") for end in range(3)])
    assert items == own + right


@pytest.mark.parametrize("seed", range(4))
def test_turns_at_random(seed):
    """Whose turn it is while nothing is to say: no word is lost, doubled or out of order."""
    own = [{"kind": 1, "value": number} for number in range(25)]
    right = [{"kind": 2, "value": number} for number in range(25)]
    turns = random.Random(f"turns {seed}")
    state = [False]

    def turn(clock):
        if turns.random() < 0.2:
            state[0] = not state[0]
        return state[0]

    own_source, right_source, _, items = run(own, right,
                                             [pauses(f"{end} {seed}") for end in range(3)], turn)
    assert [item for item in items if item["kind"] == 1] == own
    assert [item for item in items if item["kind"] == 2] == right
    assert items != own + right
    assert not set(own_source.taken) & set(right_source.taken)


def test_latency_and_throughput():
    own, right = words("own", 10), words("right", 10)
    own_source, right_source, sink, _ = run(own, right)
    assert own_source.taken == list(range(10))
    assert right_source.taken == list(range(10, 20))
    assert sink.clocks == [clock + ResponseLink.latency
                           for clock in own_source.taken + right_source.taken]
