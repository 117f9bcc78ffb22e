"""Nodes that merge in a tree when all is drawn: pixels, what is sent, and how long it takes."""

from dataclasses import replace

import numpy as np
import pytest
from frames import PIXEL, SCREEN, check, joined, random_list, triangles
from suite.cases import EVERY, chosen
from wide_machines import wide_machine

from cardcage.golden.cycles.frame_clocks import most_frame_clocks
from cardcage.golden.merging.node_picture import node_pictures
from cardcage.golden.merging.traffic import Traffic
from cardcage.golden.merging.tree import merge_tree
from cardcage.golden.organisations.organisation_of import organisation_of
from cardcage.golden.specification import commands
from cardcage.golden.specification.commands import Opcode
from cardcage.testbenches.engines.engine import Job
from cardcage.testbenches.engines.pysim_engine import PysimEngine
from cardcage.testbenches.frames.conversation import responses_owed
from cardcage.testbenches.frames.frame_job import frame_commands
from cardcage.testbenches.frames.responses import Answers


def traffic_of(configuration, display_list):
    """What golden says that the nodes send."""
    organisation = organisation_of(configuration)
    _, traffic = merge_tree(node_pictures(
        display_list, organisation.shares(display_list),
        order_bits=configuration.order_bits, **organisation.resolution.shifts))
    return traffic


def sent_by_node(traffic):
    sent = [0] * traffic.nodes
    for send in traffic.sends:
        sent[send.sender] += send.pixels
    return sent


def same_depths(count, seed):
    """Whole screens of few depths, so that nodes tie in most pixels."""
    source = np.random.default_rng(seed)
    return triangles([SCREEN] * count, source.integers(7, 9, (count, 1)).repeat(3, axis=1),
                     source.integers(0, 256, (count, 1, 3)).repeat(3, axis=1))


def machine(display_list, cards, **options):
    """Whose scans are short."""
    return wide_machine(display_list, cards=cards, clocks_per_pixel=2, **options)


CAGES = {
    "two of one unit, in turn": ("2x(PMT)", {"packet": 1}),
    "three of two, a run each": ("3x(PMMT)", {"packet": "contiguous"}),
    "four, two ports": ("4x(PMMT)", {"packet": 2, "memory_ports": 2}),
    "three of two elements, two ports": ("3x(PMPMT)", {"packet": 3, "memory_ports": 2}),
    "unequal shares of a node": ("2x(PMPMMMT)", {"packet": 1}),
    "coarser, words for a quarter": ("2x(PMMT)", {"packet": 1, "words": 8}),
    "one node, which merges with nobody": ("PMMT", {}),
}


@pytest.mark.parametrize("cage", chosen(
    CAGES, "three of two elements, two ports"))
def test_whole_frames(cage):
    """From random memory, with a host that stalls; ties between nodes in half of it."""
    cards, options = CAGES[cage]
    seed = list(CAGES).index(cage)
    listed = joined(random_list(seed, 24), same_depths(6, seed))
    configuration = machine(listed, cards, **options)
    [(simulation, traffic)] = frames(configuration, [listed], seed=seed)
    assert bool(traffic.pixels) == (configuration.nodes > 1)
    assert simulation.merge_cycles > simulation.draw_cycles


def frames(configuration, lists, *, abandoned=(), seed=1, stall=True):
    """All lists one after another through one machine, each checked; those ``abandoned`` are not
    ended.  The ``Simulation`` and the golden traffic of each of the others."""
    words = []
    for number, listed in enumerate(lists):
        words += frame_commands(configuration, listed)
        if number in abandoned:
            words.pop()
        else:
            words += [commands.command(Opcode.READ_DEPTH), commands.command(Opcode.READ_COUNTERS)]
    job = Job(configuration, commands=words, memory_seed=seed, stall_seed=seed if stall else None,
              responses=responses_owed(organisation_of(configuration), words),
              maximum_cycles=most_frame_clocks(configuration, len(words)))
    answers = Answers(configuration, PysimEngine().run(job))
    finished = [listed for number, listed in enumerate(lists) if number not in abandoned]
    assert answers.frames == len(finished)
    for number, listed in enumerate(finished):
        simulation = answers.frame(number, reading=number)
        check(configuration, listed, simulation)
        traffic = traffic_of(configuration, listed)
        assert list(simulation.sent) == sent_by_node(traffic)
        yield simulation, traffic


@pytest.mark.parametrize("ports", chosen([1, 2], 2))
def test_many_frames(ports):
    """Past the last tag; nothing of a frame that was sent, or that nobody ended, is sent again."""
    kinds = (lambda n: random_list((7, n), 9), lambda n: triangles([], [], [], background=(n,) * 3),
             lambda n: same_depths(5, n),
             lambda n: triangles([PIXEL] * 3, [[n] * 3] * 3, [[[n, 1, k]] * 3 for k in range(3)]))
    lists = [kinds[number % 4](number) for number in range(10)]
    configuration = max((machine(listed, "3x(PMT)", tag_bits=2, memory_ports=ports,
                                 shading="gouraud") for listed in lists),
                        key=lambda wide: wide.fraction_bits)
    assert len(list(frames(configuration, lists, abandoned=(2, 4, 8)))) == 7


def bar(traffic: Traffic, words: int) -> float:
    """Clocks in which all has to be merged, of units with two ports."""
    steps = traffic.steps
    return 1.05 * sum(steps) + sum(64 + 4 * 2**step + words / 4096 for step in range(len(steps)))


@EVERY
def test_a_pixel_a_clock_and_little_else(record_property):
    """The longest list of each step, and a few clocks for the step and for each unit."""
    lists = [same_depths(4, 1), triangles([PIXEL] * 4, [[5] * 3] * 4, [[[1, 2, 3]] * 3] * 4),
             triangles([], [], [])]
    lists = [replace(listed, width=16, height=16, position=2 * listed.position)
             for listed in lists]
    configuration = machine(lists[0], "3x(PMMT)", memory_ports=2)
    merged = list(frames(configuration, lists, stall=False))
    assert [traffic.steps for _, traffic in merged][::2] == [[256, 256], [0, 0]]
    for name, (simulation, traffic) in zip(("all", "some", "no"), merged, strict=True):
        clocks = simulation.merge_cycles - simulation.draw_cycles
        assert clocks <= bar(traffic, configuration.words)
        overhead = clocks - sum(traffic.steps)
        assert overhead <= 2 * 25
        record_property("measured", f"3x(PMMT), {name} pixels drawn: {clocks} clocks to merge, "
                                    f"{overhead} more than pixels sent in turn")


def test_nodes_send_nothing_more_than_was_drawn():
    """The first two nodes draw a pixel each, the last one the whole screen."""
    listed = triangles([PIXEL, PIXEL, SCREEN], [[9] * 3, [8] * 3, [4] * 3],
                       [[[7, 8, 9]] * 3] * 3)
    [(simulation, _)] = frames(machine(listed, "3x(PMT)", packet="contiguous"), [listed])
    assert list(simulation.sent) == [0, 1, 64]
    assert [work.fragments for work in simulation.work] == [1, 1, 64]
