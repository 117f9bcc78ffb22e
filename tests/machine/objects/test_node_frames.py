"""Nodes that make the triangles of their objects: whole frames, several in a run of one model,
judged by golden: every pixel on the pins, every depth, and every count."""

from dataclasses import replace

import numpy as np
import pytest
from node_frames import READ_COUNTERS, READ_DEPTH, check_merged, compiled, run
from object_bench.objects import object_machine, random_objects
from object_bench.refused_objects import check_refused, refused_objects
from suite.cases import chosen

from cardcage.golden.cycles.cycle_model import predict_cycles
from cardcage.golden.objects.making import link_words, made_at_nodes
from cardcage.golden.objects.object_words import frame_words
from cardcage.golden.specification import commands
from cardcage.golden.specification.commands import Opcode
from cardcage.testbenches.frames.frame_job import frame_commands
from cardcage.testbenches.frames.responses import Answers
from cardcage.testbenches.frames.setup_timing import setup_timing

#: Machines that are compiled once for all tests.
MODELS = {
    "chain of three": ("3x(PMMC)", {"packet": 2, "shading": "flat", "setup_interval": 8}),
    "tree of two of two elements": ("2x(PMPMT)", {"packet": 1, "memory_ports": 2}),
    "bus of two": ("2x(PMS)F", {"packet": "contiguous", "shading": "flat", "order_bits": 0,
                                "setup_interval": 64}),
}
NAMES = chosen(MODELS, "chain of three")
MESHES = (0, 1, 2, 3, 7)

#: Clocks from the frame's start until its first object is broadcast, and from its last command
#: until the machine is seen to be done.
COMMANDS = 8


def machine(name):
    cards, options = MODELS[name]
    return object_machine(cards, **{"fraction_bits": 32, "clocks_per_pixel": 2} | options)


def read(each):
    """Commands of frames, with depths and counters read back after each."""
    return [word for own in each for word in [*own, READ_DEPTH, READ_COUNTERS]]


def lists(configuration):
    """Display lists of objects of the same meshes; of the second none is whole, of the third none
    is there."""
    some, clipped, none = (random_objects(configuration, count, 1, MESHES, wide=True,
                                           flat=configuration.shading == "flat")
                           for count in (30, 6, 0))
    clipped = replace(clipped, mesh=np.full(6, len(MESHES)))
    return [objects.display_list() for objects in (some, clipped, none)]


def redrawn(configuration, listed):
    """Of meshes that are there."""
    return [commands.frame_start(listed.background), *frame_words(configuration, listed),
            commands.command(Opcode.FRAME_END)]


@pytest.mark.parametrize("stall_seed", [None, 4])
@pytest.mark.parametrize("name", NAMES)
def test_frames_of_objects(name, stall_seed):
    """Meshes are loaded before the first and before the third; objects that reach out of the guard
    band come as triangles in between; then the host prepares all, and the first again."""
    configuration = machine(name)
    first, second, empty = lists(configuration)
    drawn = [first, second, empty, first, first]
    frames = [frame_commands(configuration, first), redrawn(configuration, second),
              frame_commands(configuration, empty),
              frame_commands(configuration, first, configuration.fraction_bits),
              redrawn(configuration, first)]
    assert len(frames[0]) * commands.command_words(configuration) == link_words(
        configuration, first).total
    answers = Answers(configuration, run(configuration, read(frames), compiled(),
                                         memory_seed=5, stall_seed=stall_seed))
    for number, listed in enumerate(drawn):
        simulation = answers.frame(number, reading=number)
        check_merged(configuration, listed, simulation)
        made = made_at_nodes(configuration, listed)
        if number == 3:
            assert (list(simulation.made), list(simulation.dropped)) == (
                [0] * configuration.nodes,) * 2
            continue
        assert list(simulation.made) == [each.made for each in made]
        assert list(simulation.dropped) == [each.dropped for each in made]
    assert sum(each.sent for each in made_at_nodes(configuration, second)) == second.triangles > 0


@pytest.mark.parametrize("name", NAMES)
def test_objects_that_are_refused(name):
    """Of a mesh that was not loaded, and of any while some mesh found no room, even those that were
    loaded; whole frames before and after."""
    configuration = machine(name)
    listed, *_ = lists(configuration)
    cases = refused_objects(configuration, frame_commands(configuration, listed),
                            redrawn(configuration, listed))
    words = [*(word for own, _ in cases for word in own), READ_COUNTERS]
    answered = run(configuration, words, compiled(), extra=sum(len(some) for _, some in cases))
    check_refused(answered, cases, listed.background)


@pytest.mark.parametrize("name", NAMES)
def test_drawing_takes_the_predicted_clocks(name, record_property):
    """Within 2 % and the clocks of a command or two, of which these short frames are all."""
    configuration = machine(name)
    timing = setup_timing(configuration)
    drawn = lists(configuration)[:2]
    for triangles in ((7, 7), (1, 0), (3,)):
        drawn.append(random_objects(configuration, 32, 7, triangles,
                                    flat=configuration.shading == "flat").display_list())
    answers = Answers(configuration, run(configuration, read(
        frame_commands(configuration, listed) for listed in drawn), compiled()))
    errors = []
    for number, listed in enumerate(drawn):
        found = answers.frame(number, reading=number).draw_cycles
        predicted = predict_cycles(configuration, listed, setup=timing).cycles
        errors.append(abs(predicted + COMMANDS - found) / found)
        assert abs(predicted + COMMANDS - found) <= 0.02 * found + COMMANDS
    record_property("measured", f"{configuration.cards}: objects are predicted within "
                                f"{max(errors):.1%}")
