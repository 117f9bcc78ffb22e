"""Every request after every grant, and that nobody is passed over more than once."""

import pytest
from amaranth.hdl import Fragment
from hdl_bench.bench import Drive, rejects, simulate

from cardcage.hdl.direct.round_robin import RoundRobin


def next_grant(last, requests, count):
    """The first that asks after ``last``, in a circle; None where nobody does."""
    circle = [(last + 1 + place) % count for place in range(count)]
    return next((each for each in circle if requests >> each & 1), None)


@pytest.mark.parametrize("count", [1, 2, 3, 4, 7])
def test_every_request_after_every_grant(count):
    """Whether it is taken or not; so that what it has granted last is all that it knows."""
    dut = RoundRobin(requesters=count)
    steps = [(before, requests, take) for before in range(count)
             for requests in range(1 << count) for take in (0, 1)]
    last = count - 1

    def drive(ctx, clock):
        nonlocal last
        before, requests, take = steps[clock // 2]
        if clock % 2 == 0:  # comes there from wherever it was
            requests, take = 1 << before, 1
        ctx.set(dut.requests, requests)
        ctx.set(dut.take, take)
        grant = next_grant(last, requests, count)
        assert ctx.get(dut.grant) == (0 if grant is None else 1 << grant)
        if take and grant is not None:
            last = grant

    simulate(dut, Drive(drive, 2 * len(steps)), limit=10_000)


@pytest.mark.parametrize("count", [1, 2, 3, 4, 5])
def test_whoever_keeps_asking_is_served_within_as_many_grants_as_there_are_requesters(count):
    """Whatever the others do: all that they can."""
    for patient in range(count):
        waiting, grants = set(range(count)), 0  # after each of these grants it may begin to ask
        while waiting:
            grants += 1
            waiting = {next_grant(last, requests, count) for last in waiting
                       for requests in range(1 << count) if requests >> patient & 1} - {patient}
        assert grants == count


def test_the_first_grant_is_of_the_first_that_asks():
    dut = RoundRobin(requesters=3)

    def drive(ctx, clock):
        ctx.set(dut.requests, 0b110)
        assert ctx.get(dut.grant) == 0b010

    simulate(dut, Drive(drive, 3))


def test_bad_sizes():
    rejects(RoundRobin, "requesters", requesters=0)
    Fragment.get(RoundRobin(requesters=1), None)
