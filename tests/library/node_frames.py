"""Frames of cages of nodes, several in a run of one model, judged by golden."""

from dataclasses import replace

import numpy as np
import pytest
from frames import PIXEL, SCREEN, check, joined, random_list, triangles
from suite.cases import chosen
from wide_machines import wide_machine

from cardcage.golden.merging.cage import merge_cage
from cardcage.golden.organisations.organisation_of import organisation_of
from cardcage.golden.specification import commands
from cardcage.golden.specification.commands import Opcode
from cardcage.testbenches.engines.engine import Job
from cardcage.testbenches.engines.verilator_engine import VerilatorEngine
from cardcage.testbenches.engines.verilator_tool import ToolMissingError
from cardcage.testbenches.frames.conversation import responses_owed
from cardcage.testbenches.frames.frame_job import frame_commands
from cardcage.testbenches.frames.responses import Answers

READ_DEPTH, READ_COUNTERS, DRAW_LISTS, CLEAR_LISTS = (commands.command(opcode) for opcode in (
    Opcode.READ_DEPTH, Opcode.READ_COUNTERS, Opcode.DRAW_LISTS, Opcode.CLEAR_LISTS))


#: The depth of all that ties.
TIED = 3000

#: Machines that are compiled once for all tests: cards, size, and the rest.
MODELS = {
    "chain of three, vertices": ("3x(PMMC)", (33, 17), {
        "setup": "hardware", "setup_interval": 40, "shading": "flat", "list_words": 40}),
    "tree of five, vertices, two ports": ("5x(PMT)", (13, 7), {
        "setup": "hardware", "setup_interval": 9, "shading": "flat", "list_words": 40,
        "memory_ports": 2}),
    "chain of two of two elements, two ports": ("2x(PMMPMMC)", (13, 7), {
        "list_words": 40, "memory_ports": 2}),
    "bus of four, vertices": ("4x(PMMS)FFFF", (33, 17), {
        "setup": "hardware", "setup_interval": 40, "shading": "flat", "list_words": 40}),
    "bus of three, two ports": ("3x(PMS)FF", (13, 7), {"list_words": 40, "memory_ports": 2}),
    "bus of two of two elements": ("2x(PMMPMMS)FF", (13, 7), {"list_words": 40}),
}
#: As parameters.
NAMES = chosen(MODELS, "chain of three, vertices", "bus of four, vertices")


def compiled():
    """The engine of compiled models; the test is skipped where none can be compiled."""
    try:
        return VerilatorEngine()
    except ToolMissingError as missing:
        pytest.skip(f"simulator verilator: {missing}")


def model(name):
    """The machine of that name, and a display list in which nodes tie in many pixels."""
    cards, (width, height), options = MODELS[name]
    listed = pictures(width, height, flat=options.get("shading") == "flat")["mixed"]
    return wide_machine(listed, cards=cards, clocks_per_pixel=2, fraction_bits=36, order_bits=6,
                        **options), listed


def pictures(width, height, *, flat=False):
    """Display lists of all kinds, of up to 30 triangles."""
    corners = np.array([(0, 0), (5, 2), (width - 4, height - 5), (1, 3)])
    places = np.array(PIXEL) + corners[:, np.newaxis]
    seed = {33: 2, 13: 24}[width]  # with these the order matters for packets of 1 and of 3
    tied = all_tied(14, seed, width=width, height=height)
    return {
        "mixed": joined(random_list(seed, 16, width=width, height=height, flat=flat), tied),
        "nothing": triangles([], [], [], width=width, height=height, background=(9, 8, 7)),
        "one triangle": random_list(3, 1, width=width, height=height, flat=flat),
        "a few pixels": triangles(places, [[5] * 3, [6] * 3, [4094] * 3, [0] * 3],
                                  [[[k, 1, 2]] * 3 for k in range(4)], width=width,
                                  height=height),
        "all tied": tied,
        "many": random_list(5, 30, width=width, height=height, flat=flat),
    }


def immediate(configuration, display_list, *, prepared=False):
    """The commands of a frame whose triangles are sent one by one, whether nodes have lists or
    not; ``prepared`` by the host, whatever the machine's set-up."""
    if prepared:  # which lists of vertices do not take
        assert configuration.setup == "hardware"
        return frame_commands(configuration, display_list, configuration.fraction_bits)
    return frame_commands(replace(configuration, list_words=0), display_list)


def ways(configuration, display_list):
    """The commands of one frame: triangles sent one by one, prepared or as vertices, or loaded."""
    both = (False, True) if configuration.setup == "hardware" else (False,)
    return [*(immediate(configuration, display_list, prepared=prepared) for prepared in both),
            frame_commands(configuration, display_list)]


def loads(configuration, display_list):
    """Those that load a display list into the nodes' lists, after what is there."""
    clear, *words, _start, _draw, _end = frame_commands(configuration, display_list)
    assert clear == CLEAR_LISTS
    return words


def redrawn(configuration, display_list):
    """Those of a frame of the lists as they are."""
    start, *_, end = immediate(configuration, display_list)
    return [start, DRAW_LISTS, end]


def run(configuration, words, engine, *, memory_seed=3, stall_seed=None, extra=0):
    """Whatever a machine answers to ``words``; ``extra``: faults that it answers besides."""
    return engine.run(Job(
        configuration, words, responses_owed(organisation_of(configuration), words) + extra,
        memory_seed=memory_seed, stall_seed=stall_seed,
        maximum_cycles=200 * len(words) + 400 * configuration.cycles_per_scan * (
            1 + words.count(READ_DEPTH))))


def frames(configuration, each, engine, **seeds):
    """Draws frame after frame, each with depths and counters read back, and checks every one.

    ``each``: (commands, configuration as the host shares triangles out, display list) of a frame.
    Returns the ``Simulation`` of each.
    """
    words = [word for own, _, _ in each for word in [*own, READ_DEPTH, READ_COUNTERS]]
    answers = Answers(configuration, run(configuration, words, engine, **seeds))
    assert answers.frames == len(each)
    simulations = []
    for number, (_, shared, display_list) in enumerate(each):
        simulation = answers.frame(number, reading=number)
        check_merged(shared, display_list, simulation)
        simulations.append(simulation)
    return simulations


def check_merged(configuration, display_list, simulation):
    """Colours on the pins, merged depths, fragments, and what each node says that it sent."""
    check(configuration, display_list, simulation)
    picture, traffic = merge_cage(configuration, display_list)
    np.testing.assert_array_equal(simulation.depth, picture.picture.depth)
    assert list(simulation.sent) == sent_by_node(configuration, traffic)
    if configuration.merges_directly:
        assert simulation.taken == traffic.taken.sum(axis=0).tolist()


def sent_by_node(configuration, traffic):
    """Of a chain, whose last node sends to the pins what the others send to the next one."""
    sent = [0] * configuration.nodes
    if configuration.scans_rank:
        sent[-1] = configuration.width * configuration.height
    for send in traffic.sends:
        sent[send.sender] += send.pixels
    return sent


def all_tied(count, seed, *, width, height):
    """Triangles of one plane, the last one over the whole screen: only the order says which is
    seen."""
    anywhere = random_list(seed, count - 1, width=width, height=height, flat=True)
    screen = triangles(np.array(SCREEN) * [width / 8, height / 8], [TIED] * 3, [[[255, 0, 9]] * 3],
                       width=width, height=height)
    return joined(replace(anywhere, depth=np.full_like(anywhere.depth, TIED)), screen)
