"""Fragments of all elements reach their units: in every state that a small crossbar has, at random
in larger ones, and a fragment a clock where nothing is in the way."""

import random

import pytest
from amaranth.hdl import Value
from hdl_bench.bench import Drive, rejects, simulate
from hdl_bench.crossbar_model import CrossbarModel
from hdl_bench.streams import Sink, Source, no_pause, once, pauses

from cardcage.golden.specification.queues import FRAGMENTS_OF_ELEMENT
from cardcage.hdl.direct import crossbar
from cardcage.hdl.direct.crossbar import Crossbar

BITS = {"id_bits": 4, "address_bits": 6, "depth_bits": 9}

#: Small crossbars, of which every state is tried: elements, units, places in a queue, one queue
#: per element.
SMALL = [(2, 1, 2, False), (3, 1, 1, False), (2, 2, 1, False), (2, 2, 1, True)]


def built(model, monkeypatch):
    monkeypatch.setattr(crossbar, "FRAGMENTS_OF_ELEMENT", model.depth)
    return Crossbar(elements=model.elements, units=model.units,
                    queue="element" if model.shared else model.depth, **BITS)


def tour(following, model, start, limit):
    """Inputs, one a clock, and the state in each, until every step from every state was taken, or
    ``limit`` were."""
    inputs = model.inputs()
    left = {state: list(range(len(inputs))) for state in following}
    state, steps = start, 0
    while steps < limit:
        path = [left[state].pop()] if left[state] else way(following, left, state)
        if path is None:
            return
        for number in path:
            yield state, inputs[number]
            state = following[state][number]
            steps += 1


def way(following, left, state):
    """The shortest way to a state with a step that was not taken; None where there is none."""
    found, waiting = {state: None}, [state]
    for at in waiting:
        if left[at]:
            path = []
            while found[at] is not None:
                at, number = found[at]
                path.append(number)
            return path[::-1]
        for number, after in enumerate(following[at]):
            if after not in found:
                found[after] = at, number
                waiting.append(after)
    return None


@pytest.mark.parametrize(("elements", "units", "depth", "shared"), SMALL)
def test_who_waits_is_served_within_as_many_grants_as_there_are_elements(elements, units, depth,
                                                                         shared):
    """In every state, whatever comes and whenever units take it."""
    model = CrossbarModel(elements, units, depth, shared=shared)
    following, inputs = model.explored(), model.inputs()
    assert len(following) >= 50
    for element in range(elements):
        for unit in range(units):
            waiting, grants = set(following), 0
            while waiting:
                assert grants < elements, f"element {element} starves at unit {unit}"
                waiting = passed_over(model, following, inputs, element, unit, waiting)
                grants += 1


def passed_over(model, following, inputs, element, unit, states):
    """The states after one more grant of the unit to others, for which the element has waited on
    and on in any of ``states`` or others after them without a grant."""
    after, seen, stack = set(), set(states), list(states)
    while stack:
        state = stack.pop()
        for (_, ready), then in zip(inputs, following[state], strict=True):
            if not model.asks(state, element, unit, ready):
                continue
            granted = model.granted(state, unit, ready)
            if model.moves(state, unit, ready):
                assert granted is not None  # no clock is lost
            if granted is None:
                if then not in seen:
                    seen.add(then)
                    stack.append(then)
            elif granted != element:
                after.add(then)
    return after


@pytest.mark.parametrize(("elements", "units", "depth", "shared", "limit"), [
    (2, 1, 2, False, None), (3, 1, 1, False, None), (2, 2, 1, False, 3000),
    (2, 2, 1, True, 3000), (2, 2, 2, True, 3000)])
def test_every_step_from_every_state(monkeypatch, elements, units, depth, shared, limit):
    """As the model has it, signal by signal; of the larger ones as many as there is time for."""
    model = CrossbarModel(elements, units, depth, shared=shared)
    dut = built(model, monkeypatch)
    following = model.explored()
    steps = list(tour(following, model, model.start, limit or 100_000))
    taken = {(state, given) for state, given in steps}
    if limit is None:
        assert len(taken) == len(following) * len(model.inputs())

    def drive(ctx, clock):
        if clock == len(steps):
            return
        state, (offers, ready) = steps[clock]
        for fragments, offer in zip(dut.elements, offers, strict=True):
            ctx.set(fragments.valid, offer is not None)
            if offer is not None:
                ctx.set(fragments.payload.unit, offer[0])
        for line, value in zip(dut.units, ready, strict=True):
            ctx.set(line.ready, value)
        for element, offer in enumerate(offers):
            if offer is not None:
                assert ctx.get(dut.elements[element].ready) == model.takes(
                    state, element, offer[0]), clock
        assert [ctx.get(line.valid) for line in dut.units] == [
            offer is not None for offer in state.offered], clock

    simulate(dut, Drive(drive, len(steps)), limit=100_000)


def fragments_of(seed, elements, units, count):
    """Fragments of each element, no two alike: at random, in runs along the units, or all for one
    unit."""
    pick = random.Random(f"crossbar {seed}")
    lists = []
    for element in range(elements):
        way = pick.randrange(3)
        first = pick.randrange(units)
        lists.append([{
            "unit": (pick.randrange(units) if way == 0 else (first + (way == 1) * place) % units),
            "address": pick.getrandbits(6), "depth": pick.getrandbits(9),
            "color": element << 16 | place} for place in range(count)])
    return lists


def run(lists, units, queue, pause=lambda name: no_pause, after=3):
    dut = Crossbar(elements=len(lists), units=units, queue=queue, **BITS)
    sources = [Source(stream, items, pause(f"from {number}"))
               for number, (stream, items) in enumerate(zip(dut.elements, lists, strict=True))]
    sinks = [Sink(stream, sum(item["unit"] == number for items in lists for item in items),
                  pause(f"to {number}")) for number, stream in enumerate(dut.units)]
    simulate(dut, *sources, *sinks, after=after)
    for number, sink in enumerate(sinks):
        arrived = [item.color >> 16 for item in sink.items]
        for element, items in enumerate(lists):  # each one's in its order
            assert [{"unit": number} | {name: getattr(item, name)
                                        for name in ("address", "depth", "color")}
                    for item, source in zip(sink.items, arrived, strict=True)
                    if source == element] == [item for item in items if item["unit"] == number]
    return dut, sources, sinks


@pytest.mark.parametrize("queue", [2, 3, 4, "element"])
@pytest.mark.parametrize(("elements", "units"), [(1, 1), (3, 2), (2, 8), (5, 4)])
def test_random_fragments(elements, units, queue):
    seed = f"{elements} {units} {queue}"
    run(fragments_of(seed, elements, units, 70), units, queue,
        lambda name: pauses(f"{seed} {name}"))


@pytest.mark.parametrize("queue", [2, 4, "element"])
def test_a_fragment_a_clock_from_each_element_to_each_unit(queue):
    """Elements that walk the units one place apart: nothing is ever in the way."""
    count = 40
    lists = [[{"unit": (place + element) % 4, "address": place % 64, "depth": 0,
               "color": element << 16 | place} for place in range(count)] for element in range(4)]
    _, sources, sinks = run(lists, 4, queue)
    for source in sources:
        assert source.taken == list(range(count))
    for sink in sinks:
        assert sink.clocks == list(range(Crossbar.latency, Crossbar.latency + count))


@pytest.mark.parametrize("queue", [2, "element"])
def test_all_for_one_unit_in_turn(queue):
    """A fragment a clock, of every element in turn."""
    lists = [[{"unit": 1, "address": 0, "depth": 0, "color": element << 16 | place}
              for place in range(12)] for element in range(3)]
    _, _, sinks = run(lists, 2, queue)
    assert sinks[1].clocks == list(range(Crossbar.latency, Crossbar.latency + 36))
    assert [item.color >> 16 for item in sinks[1].items] == [0, 1, 2] * 12


@pytest.mark.parametrize(("queue", "places"), [(2, 2), (3, 3), (4, 4),
                                               ("element", FRAGMENTS_OF_ELEMENT)])
def test_so_many_wait(queue, places):
    """Of a unit that takes nothing: besides one that it is offered, and one that comes next."""
    dut = Crossbar(elements=1, units=2, queue=queue, **BITS)
    items = [{"unit": 0, "address": 0, "depth": 0, "color": place} for place in range(places + 3)]
    source = Source(dut.elements[0], items, once(0, no_pause))
    taken = []

    def units(ctx, clock):
        ctx.set(dut.units[1].ready, 1)
        taken.append(len(source.taken))
        assert ctx.get(dut.busy) == (clock > 0)

    with pytest.raises(AssertionError, match="Source not finished"):
        simulate(dut, source, Drive(units), limit=20)
    assert taken[-1] == places + 2


@pytest.mark.parametrize(("name", "value"), [("elements", 0), ("units", 0), ("units", 16),
                                             ("queue", 0)])
def test_bad_sizes(name, value):
    rejects(Crossbar, name, **{"elements": 2, "units": 2, "queue": 2} | BITS | {name: value})


def test_busy_while_it_holds_something():
    dut = Crossbar(elements=2, units=2, queue=2, **BITS)
    source = Source(dut.elements[1], [{"unit": 1, "address": 5, "depth": 3, "color": 9}],
                    once(3, no_pause))
    sink = Sink(dut.units[1], 1, once(9, no_pause))
    busy = []

    def look(ctx, clock):
        busy.append(ctx.get(dut.busy))
        assert ctx.get(Value.cast(dut.units[0].valid)) == 0

    simulate(dut, source, sink, Drive(look), after=3)
    assert busy == [clock in range(4, sink.clocks[0] + 1) for clock in range(len(busy))]
