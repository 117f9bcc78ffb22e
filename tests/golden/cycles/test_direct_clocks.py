"""The clocks of a cage whose elements share all units, by arrays against one fragment at a time."""

from __future__ import annotations

import random
from dataclasses import fields, replace

import numpy as np
import pytest
from counted_lists import list_of
from crossbar_by_hand import ONE_QUEUE, clocks_by_hand
from cycle_lists import scene
from wide_machines import wide_machine

from cardcage.golden.cycles.broadcast import SetupTiming
from cardcage.golden.cycles.cycle_estimate import estimate_cycles
from cardcage.golden.cycles.cycle_model import predict_cycles
from cardcage.golden.cycles.direct.crossbar import Crossbar
from cardcage.golden.cycles.direct.direct_work import CROSSBAR_LATENCY, DirectWork
from cardcage.golden.cycles.direct.element_streams import (
    NO_FRAGMENT,
    element_streams,
    joined,
)
from cardcage.golden.cycles.element_latencies import PIPELINE, Pipeline
from cardcage.golden.merging.direct import direct_traffic
from cardcage.golden.organisations.organisation_of import organisation_of
from cardcage.golden.specification.queues import FRAGMENTS_OF_ELEMENT

CAGES = ("PDM", "PPDM", "3xP D 4xM", "4xP D 2xM")


def machine_of(cards, listed=None, **fields_):
    return wide_machine(listed or scene(0), cards=cards, order_bits=16,
                        **{"memory_ports": 2} | fields_)


@pytest.mark.parametrize("queue", [2, 4, "element"])
@pytest.mark.parametrize("cards", CAGES)
def test_the_arrays_do_what_queues_do(cards, queue):
    assert ONE_QUEUE == FRAGMENTS_OF_ELEMENT
    pick = random.Random(f"{cards} {queue}")
    for seed, (n, size) in enumerate(((30, 4), (25, 14), (12, 30))):
        print(cards, queue, "seed", seed)
        listed = scene(60 + seed, n=n, size=size)
        machine = machine_of(cards, queue=queue, fifo_depth=pick.choice((2, 3, 7)),
                             packet=pick.choice((1, 3, "contiguous")))
        pipeline = Pipeline(**{field.name: pick.randrange(1, 9) for field in fields(Pipeline)})
        for retained in (False, True):
            taken = clocks_by_hand(machine, listed, pipeline, retained=retained)
            prediction = predict_cycles(machine, listed, pipeline, retained=retained)
            assert prediction.cycles == max(taken.values()) + pipeline.finish + CROSSBAR_LATENCY
            shares = organisation_of(machine).shares(list_of(n))
            work = DirectWork(machine, listed, pipeline)
            node = shares.node[work.primitive]
            place = [int((work.primitive[(node == of) & (work.primitive < primitive)]).size)
                     for primitive, of in zip(work.primitive, node, strict=True)]
            sent = np.argsort(shares.host_place[work.primitive])
            drawn = work.drawn(node[sent], None, retained)
            assert (drawn - pipeline.finish - CROSSBAR_LATENCY).tolist() == [
                taken[of, number] for of, number in zip(node.tolist(), place, strict=True)]
            assert prediction.cycles >= prediction.bound


@pytest.mark.parametrize("retained", [False, True])
def test_one_element_and_one_unit_are_as_ever(retained):
    """But for what the crossbar takes, to a few clocks: places are known to be free by another
    rule."""
    for seed, n, size in ((2, 40, 12), (3, 80, 4), (4, 30, 25)):
        listed = scene(seed, n=n, size=size)
        direct, chain = (predict_cycles(machine_of(cards), listed, retained=retained).finished
                         for cards in ("PDM", "PMC"))
        assert abs(direct - CROSSBAR_LATENCY - chain).max() <= 3


def test_streams_are_the_fragments_of_each_element():
    listed = scene(9, n=50, size=14)
    machine = machine_of("3xP D 4xM", packet=2, memory_ports=1)
    organisation = organisation_of(machine)
    each = [element_streams(machine, listed, node, PIPELINE, True) for node in range(3)]
    streams, firsts = joined(each)
    taken = direct_traffic(organisation, listed).taken
    for node in range(3):
        unit = streams.unit[firsts[2][node]:firsts[2][node + 1]]
        fragments = unit[unit != NO_FRAGMENT]
        np.testing.assert_array_equal(np.bincount(fragments, minlength=4), taken[node])
        place = streams.place[firsts[3][node]:firsts[3][node + 1]]
        np.testing.assert_array_equal(place // organisation.words, fragments)
    rounds = organisation.shares(list_of(50))
    primitive = streams.primitive[streams.triangle]
    np.testing.assert_array_equal(
        streams.rank & ((1 << 16) - 1), rounds.round[primitive] * 4 + rounds.node[primitive])
    assert len(streams.primitive) == firsts[0][-1] and streams.slot[-1] == firsts[2][-1]


def test_a_unit_serves_all_in_turn():
    """Of four that all want it each has every fourth clock, whatever they have waiting."""
    listed = scene(4, n=40, size=30)
    machine = machine_of("4xP D M")
    streams, firsts = joined([element_streams(machine, listed, node, PIPELINE, False)
                              for node in range(4)])
    crossbar, everyone = Crossbar(machine, streams, firsts[3]), np.arange(4)
    served = []
    for _ in range(40):
        element, unit = crossbar.chosen(np.ones(1, bool))
        room = everyone[crossbar.queues.room(np.zeros(4, np.int64))]
        crossbar.queues.put(room, np.zeros(len(room), np.int64))
        crossbar.queues.take(element, unit)
        served += element.tolist()
    assert served == [place % 4 for place in range(39)]


def test_what_binds():
    listed = scene(12, n=200, size=14)
    for cards, binding in (("8xP D M", "busiest port"), ("PPD8xM", "busiest element")):
        machine = machine_of(cards, listed)
        prediction = predict_cycles(machine, listed, retained=True)
        assert prediction.binding == binding
        assert prediction.bound <= prediction.cycles <= 1.1 * prediction.bound + 30
        taken = direct_traffic(organisation_of(machine), listed).taken
        assert prediction.port_bound == taken.sum(axis=0).max()
        assert prediction.element_bound.max() >= taken.sum(axis=1).max()
    small = scene(12, n=400, size=2)
    assert predict_cycles(machine_of("8xP D 8xM", small), small).binding == "broadcast"


def test_queues_and_ports_that_are_fewer_are_slower():
    listed = scene(21, n=300, size=9)
    clocks = [predict_cycles(machine_of("8xP D 8xM", listed, **fields_), listed,
                             retained=True).cycles
              for fields_ in ({"queue": 4}, {"queue": 2}, {"queue": "element"},
                              {"queue": "element", "memory_ports": 1})]
    assert clocks == sorted(clocks) and clocks[0] < 0.9 * clocks[2] < 0.9 * clocks[3]


def test_what_was_drawn_before_spares_writes():
    listed = scene(22, n=80, size=20)
    near, far = (replace(listed, depth=np.full_like(listed.depth, depth))
                 for depth in (5, 1 << 20))
    machine = machine_of("PPDM", listed, memory_ports=1)
    hidden, seen = (predict_cycles(machine, far, after=before).port_bound
                    for before in (near, None))
    assert hidden < seen


def test_set_up_in_hardware_and_lists():
    listed = scene(23, n=60, size=10)
    machine = machine_of("PPPPDMMMM", listed)
    setup = SetupTiming(interval=30, latency=40, inside=2)
    slow, fast = (predict_cycles(machine, listed, setup=each) for each in (setup, None))
    assert slow.binding == "set-up" and slow.cycles > 30 * 50 > fast.cycles
    lists = predict_cycles(machine, listed, retained=True, setup=setup)
    assert lists.setup_bound == 0 and lists.cycles < fast.cycles + 3
    assert len(lists.finished) == len(fast.finished)
    assert (np.diff(lists.finished) >= 0).all()


@pytest.mark.parametrize("cards", ["PPPPDMMMM", "8xP D 4xM"])
@pytest.mark.parametrize("fields_", [
    {}, {"queue": "element"}, {"memory_ports": 1}], ids=str)
def test_the_estimate(cards, fields_):
    for seed, n, size in ((31, 300, 5), (32, 100, 20)):
        listed = scene(seed, n=n, size=size)
        machine = machine_of(cards, listed, **fields_)
        for retained in (False, True):
            estimate = estimate_cycles(machine, listed, retained=retained)
            predicted = predict_cycles(machine, listed, retained=retained).cycles
            assert estimate.total == pytest.approx(predicted, rel=0.25)
            np.testing.assert_array_equal(
                estimate.fragments,
                direct_traffic(organisation_of(machine), listed).taken.sum(axis=1))


def test_nothing_to_draw():
    nothing = scene(1, n=10).chosen(np.arange(0))
    for retained in (False, True):
        prediction = predict_cycles(machine_of("PPDM", memory_ports=1), nothing, retained=retained)
        assert prediction.cycles == 0 and prediction.bound == 0
