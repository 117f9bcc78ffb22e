"""What is said of each clock, for every combination of what there is to hear."""

import random
from itertools import product

import pytest
from hdl_bench.bench import Drive, Watch, evaluate, rejects, simulate

from cardcage.golden.specification.activity import Activity
from cardcage.hdl.observer import ElementActivity, MachineActivity

RASTERISER = ("preparing", "empty_row", "walking")
DEPTH_TEST = ("taken", "offered", "scanned", "service")
EVERY = [dict(zip((*RASTERISER, *DEPTH_TEST), bits, strict=True))
         for bits in product((0, 1), repeat=len(RASTERISER) + len(DEPTH_TEST))]


def reason(heard):
    """Why no fragment sets out."""
    for name, activity in (("preparing", Activity.PREPARING), ("empty_row", Activity.EMPTY_ROW),
                           ("walking", Activity.FILLING)):
        if heard[name]:
            return activity
    return Activity.SETUP


def said(heard, earlier):
    """At the depth test, where what was ``earlier`` is missing."""
    if heard["taken"]:
        return Activity.FRAGMENT
    if heard["offered"]:
        return Activity.SCAN if heard["scanned"] else Activity.PORT
    return Activity.SERVICE if heard["service"] else earlier


def hear(ctx, dut, heard):
    for name, value in heard.items():
        ctx.set(getattr(dut, name), value)


@pytest.mark.parametrize("delay", [1, 7])
def test_an_element_tells_the_reason_of_the_clock_in_which_the_fragment_should_have_set_out(delay):
    dut = ElementActivity(delay=delay)
    assert dut.delay == delay
    heard = random.Random(delay).sample(EVERY, len(EVERY))
    told = []
    simulate(dut, Drive(lambda ctx, clock: hear(ctx, dut, heard[clock]), len(heard)),
             Watch(lambda ctx, clock: told.append(ctx.get(dut.activity))))
    before = [Activity.SETUP] * delay + [reason(each) for each in heard]
    assert told == [said(each, before[clock]) for clock, each in enumerate(heard)]


def test_without_a_delay_it_is_the_reason_of_the_same_clock():
    dut = ElementActivity(delay=0)

    def steps(ctx):
        for each in EVERY:
            hear(ctx, dut, each)
            assert ctx.get(dut.activity) == said(each, reason(each))

    evaluate(dut, steps)


def test_the_machine_tells_why_an_element_has_nothing():
    dut = MachineActivity(elements=3)

    def steps(ctx):
        for blocked, more, activity in product((0, 1), (0, 1), Activity):
            elements = [Activity.SETUP, activity, Activity.FRAGMENT]
            ctx.set(dut.blocked, blocked)
            ctx.set(dut.more, more)
            ctx.set(dut.elements, elements)
            idle = (Activity.BROADCAST if blocked else Activity.SETUP if more else Activity.DRAIN)
            assert [ctx.get(dut.activity[place]) for place in range(3)] == [
                idle if element == Activity.SETUP else element for element in elements]

    evaluate(dut, steps)


def test_no_delay_is_negative():
    rejects(ElementActivity, "delay", delay=-1)
