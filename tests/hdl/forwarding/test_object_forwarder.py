"""Rows of forwarders: every object comes to all who need it, once, whatever is slow."""

import random

import pytest
from hdl_bench.bench import rejects
from region_bench.forwarding import check_row, some_reaches

from cardcage.golden.specification.configuration import MachineConfiguration
from cardcage.hdl.forwarding.object_forwarder import ObjectForwarder

#: Elements, and columns and rows of regions; in some an element has none.
ROWS = {
    "one": (1, (5, 3)), "two strips": (2, (1, 2)), "three of a grid": (3, (5, 3)),
    "four strips of rows": (4, (1, 24)), "four of two": (4, (1, 2)), "one region": (3, (1, 1)),
    "seven of a grid": (7, (5, 3)),
}


def machine(name):
    elements, regions = ROWS[name]
    return MachineConfiguration(f"{elements}x(PM)", 40, 24, regions=regions, balance="static")


def run(name, kind="any", count=20, seed=None, sources=None, **queues):
    configuration = machine(name)
    pick = random.Random(f"{name} {kind} {seed}")
    elements = configuration.processing_elements
    sources = sources or [pick.randrange(elements) for _ in range(count)]
    return check_row(configuration, sources, some_reaches(configuration, pick, len(sources), kind),
                     seed=seed, **queues)


@pytest.mark.parametrize("name", ROWS)
def test_every_object_comes_to_all_who_need_it(name):
    run(name, seed=1)


@pytest.mark.parametrize("name", ["three of a grid", "four strips of rows"])
@pytest.mark.parametrize("kind", ["small", "all"])
def test_the_smallest_queues(name, kind):
    run(name, kind, seed=2, waiting=1, passing=1)


@pytest.mark.parametrize(("source", "kind"), [(0, "all"), (2, "any"), (2, "all"), (3, "any")])
def test_all_objects_from_one_element(source, kind):
    run("four strips of rows", kind, seed=3, sources=[source] * 16, passing=1)


def test_an_object_for_all_a_clock():
    """In a row where nothing waits each element draws an object a clock, and the first object is
    drawn as early as the docstring says."""
    count, elements = 16, 4
    clocks = run("four strips of rows", "all", sources=[0] * count)
    for element, drawn in enumerate(clocks):
        assert drawn == [ObjectForwarder.latency * (element + 1) + number
                         for number in range(count)]
    everybody = run("four strips of rows", "all", sources=list(range(elements)) * count)
    for drawn in everybody:  # but for some clocks at the beginning and at the end
        assert drawn[-1] - drawn[0] < elements * (count + ObjectForwarder.latency)


def test_one_that_is_slow_to_draw_does_not_keep_a_copy_from_others():
    """Nor does one that cannot pass a copy on keep itself from drawing."""
    slow = 200
    one, two, three, four = run("four strips of rows", "all", sources=[0] * 8,
                                slow={1: slow}, passing=2)
    assert two[0] == slow and three[0] < 20 and four[0] < 20
    assert three[1] < slow  # it waits behind the first only to be drawn there
    assert one[4] < slow and one[7] > slow - 20


def test_bad_sizes():
    configuration = machine("one")
    for name in ("object_bits", "waiting", "passing"):
        key = "depth" if name != "object_bits" else name
        rejects(ObjectForwarder, key, configuration=configuration, **{"object_bits": 3, name: 0})
