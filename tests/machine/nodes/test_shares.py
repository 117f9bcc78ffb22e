"""However triangles are dealt out, sent and kept: the picture of the whole list."""

from dataclasses import replace

import pytest
from frames import joined, random_list
from node_frames import (
    CLEAR_LISTS,
    NAMES,
    all_tied,
    check_merged,
    compiled,
    frames,
    immediate,
    loads,
    model,
    pictures,
    redrawn,
    ways,
)
from wide_machines import wide_machine

from cardcage.golden.merging.ties import order_matters
from cardcage.golden.organisations.organisation_of import organisation_of
from cardcage.testbenches.engines.pysim_engine import PysimEngine
from cardcage.testbenches.frames.simulation import simulate

PACKETS = (1, 3, 10, "contiguous")


@pytest.mark.parametrize("name", NAMES)
@pytest.mark.parametrize("stall_seed", [None, 4])
def test_every_packet_in_every_way(name, stall_seed):
    """Nodes tie in many pixels, and who draws there first is another one with each packet."""
    machine, listed = model(name)
    each = [(words, shared, listed) for shared in (replace(machine, packet=packet)
                                                   for packet in PACKETS)
            for words in ways(shared, listed)]
    frames(machine, each, compiled(), memory_seed=5, stall_seed=stall_seed)


@pytest.mark.parametrize("name", NAMES)
def test_order_matters_in_the_list(name):
    """So that the test above can fail."""
    machine, listed = model(name)
    found = [order_matters(listed, organisation_of(replace(machine, packet=packet)).shares(listed))
             for packet in PACKETS]
    assert found == [True, True, machine.nodes < 3, False], found


@pytest.mark.parametrize("name", NAMES)
def test_one_picture_after_another(name):
    """Empty ones, ones of fewer triangles than nodes, of few pixels, of all; with lists that stay
    from frame to frame, over frames that are sent as ever, until they are cleared."""
    machine, _ = model(name)
    lists = pictures(machine.width, machine.height, flat=machine.shading == "flat")
    each = [(immediate(machine, listed), machine, listed) for listed in lists.values()]
    first, second = lists["all tied"], lists["many"]
    again = redrawn(machine, first)
    each += [([CLEAR_LISTS, *loads(machine, first), *again], machine, first),
             (again, machine, first), (again, machine, first),
             (immediate(machine, second), machine, second), (again, machine, first),
             ([CLEAR_LISTS, *loads(machine, second), *redrawn(machine, second)], machine, second),
             ([CLEAR_LISTS, *redrawn(machine, lists["nothing"])], machine, lists["nothing"])]
    drawn = frames(machine, each, compiled(), memory_seed=7, stall_seed=7)
    assert len({simulation.video.tobytes() for simulation in drawn}) == len(lists)




CAGES = {
    "one node": ("PMMC", {"list_words": 10}),
    "two, squares": ("2x(PMPMC)", {"block": 2, "packet": 1}),
    "three, coarser": ("3x(PMC)", {"words": 32, "packet": 2, "memory_ports": 2}),
}


@pytest.mark.parametrize("cage", CAGES)
def test_other_chains(cage):
    cards, options = CAGES[cage]
    listed = joined(random_list(cage.encode()[0], 6), all_tied(4, 2, width=8, height=8))
    machine = wide_machine(listed, cards=cards, clocks_per_pixel=2, **options)
    simulation = simulate(machine, listed, PysimEngine(), memory_seed=2, stall_seed=3)
    check_merged(machine, listed, simulation)
