"""Elements without pixels of their own: the picture of the whole list, however it is dealt out,
sent, kept and queued, and whoever draws a pixel in the same clock."""

from dataclasses import replace

import numpy as np
import pytest
from frames import joined, random_list, triangles
from node_frames import (
    CLEAR_LISTS,
    all_tied,
    check_merged,
    compiled,
    frames,
    immediate,
    loads,
    pictures,
    redrawn,
    ways,
)
from suite.cases import chosen
from wide_machines import wide_machine

from cardcage.golden.merging.ties import order_matters
from cardcage.golden.organisations.organisation_of import organisation_of
from cardcage.testbenches.engines.pysim_engine import PysimEngine
from cardcage.testbenches.frames.simulation import simulate

PACKETS = (1, 3, 10, "contiguous")
VERTICES = {"setup": "hardware", "shading": "flat"}

#: Cards, size, and the rest.
MODELS = {
    "one of each": ("PDM", (13, 7), {"list_words": 40}),
    "two for one, two ports": ("PPDM", (13, 7), {
        **VERTICES, "setup_interval": 9, "memory_ports": 2, "queue": "element", "list_words": 40}),
    "three for two": ("PPPDMM", (33, 17), {
        **VERTICES, "setup_interval": 40, "queue": 4, "list_words": 40}),
    "four for four, two ports": ("4x(P)D4x(M)", (13, 7), {
        "memory_ports": 2, "queue": 2, "list_words": 40}),
    "five for eight": ("5x(P)D8x(M)", (33, 17), {
        "shading": "flat", "queue": "element", "list_words": 40}),
    "five for eight, two ports": ("5x(P)D8x(M)", (13, 7), {
        **VERTICES, "setup_interval": 1, "memory_ports": 2, "queue": 3, "list_words": 40}),
}
NAMES = chosen(MODELS, "three for two")


def model(name):
    """The machine of that name, and a display list in which nodes tie in many pixels."""
    cards, (width, height), options = MODELS[name]
    listed = pictures(width, height, flat=options.get("shading") == "flat")["mixed"]
    return wide_machine(listed, cards=cards, clocks_per_pixel=2, fraction_bits=36, order_bits=9,
                        **options), listed


@pytest.mark.parametrize("name", NAMES)
@pytest.mark.parametrize("stall_seed", [None, 4])
def test_every_packet_in_every_way(name, stall_seed):
    """Elements tie in many pixels, in memory as well when shares are contiguous."""
    machine, listed = model(name)
    each = [(words, shared, listed) for shared in (replace(machine, packet=packet)
                                                   for packet in PACKETS)
            for words in ways(shared, listed)]
    drawn = frames(machine, each, compiled(), memory_seed=5, stall_seed=stall_seed)
    assert all(sum(simulation.taken) == sum(work.fragments for work in simulation.work)
               for simulation in drawn)


@pytest.mark.parametrize("name", NAMES)
def test_order_matters_in_the_list(name):
    """So that the test above can fail: whoever has the least number is not always first."""
    machine, listed = model(name)
    shares = organisation_of(replace(machine, packet=1)).shares(listed)
    assert order_matters(listed, shares) == (machine.nodes > 1)


@pytest.mark.parametrize("name", NAMES)
def test_one_picture_after_another(name):
    """Of few triangles and of many; with lists that stay, until they are cleared."""
    machine, _ = model(name)
    lists = pictures(machine.width, machine.height, flat=machine.shading == "flat")
    each = [(immediate(machine, listed), machine, listed) for listed in lists.values()]
    first, second = lists["all tied"], lists["many"]
    again = redrawn(machine, first)
    each += [([CLEAR_LISTS, *loads(machine, first), *again], machine, first),
             (again, machine, first), (immediate(machine, second), machine, second),
             (again, machine, first),
             ([CLEAR_LISTS, *redrawn(machine, lists["nothing"])], machine, lists["nothing"])]
    drawn = frames(machine, each, compiled(), memory_seed=7, stall_seed=7)
    assert len({simulation.video.tobytes() for simulation in drawn}) == len(lists)


def same_pixels(elements, rounds, *, width, height):
    """In each round all elements draw the same row of pixels: nearer and nearer ones, farther ones,
    some that tie."""
    source = np.random.default_rng(elements)
    place, depth = [], []
    for number in range(rounds):
        row, left = number % height, int(source.integers(0, width - 3))
        place += [[[left + 0.1, row + 0.4], [left + 0.1, row + 0.6], [left + 3.2, row + 0.5]]
                  ] * elements
        depth += (3000 - 10 * number - source.integers(0, 5, elements)).tolist()
    color = source.integers(0, 256, (len(depth), 1, 3)).repeat(3, axis=1)
    return triangles(place, [[each] * 3 for each in depth], color, width=width, height=height)


@pytest.mark.parametrize("name", NAMES)
def test_no_update_is_lost(name):
    """Where all elements hit one pixel in consecutive clocks; the units say that it happened."""
    machine, _ = model(name)
    listed = same_pixels(machine.nodes, 24, width=machine.width, height=machine.height)
    each = [(words, machine, listed) for words in (
        immediate(machine, listed), [CLEAR_LISTS, *loads(machine, listed),
                                     *redrawn(machine, listed)])]
    _, from_lists = frames(machine, each, compiled(), memory_seed=1)
    assert (sum(from_lists.followed) > 0) == (machine.nodes > 1)


CAGES = {
    "coarser": ("PPDMM", {"words": 16, "packet": 2, "memory_ports": 2}),
    "more lines than cards": ("PPDMM", {"maximum_units": 4, "maximum_nodes": 5}),
    "no ties between elements": ("PPPDM", {"order_bits": 0, "packet": "contiguous"}),
    "the least order": ("PPPDMM", {"order_bits": 2, "packet": "contiguous", "queue": 3}),
    "observed": ("PPDMM", {"observe": True, "queue": "element"}),
}


@pytest.mark.parametrize("cage", chosen(
    CAGES, "coarser", "more lines than cards", "the least order"))
def test_other_cages(cage):
    cards, options = CAGES[cage]
    listed = joined(random_list(len(cage), 6), all_tied(4, 2, width=8, height=8))
    if options.get("order_bits") == 0:
        listed = random_list(5, 8)
    machine = wide_machine(listed, cards=cards, clocks_per_pixel=2, **options)
    simulation = simulate(machine, listed, PysimEngine(), memory_seed=2, stall_seed=3)
    check_merged(machine, listed, simulation)
