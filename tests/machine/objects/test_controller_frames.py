"""A controller that makes the triangles of all objects: whole frames, several in a run of one
model, judged by golden: every pixel on the pins, every depth, and every count."""

from dataclasses import replace

import numpy as np
import pytest
from node_frames import READ_COUNTERS, READ_DEPTH, compiled, run
from object_bench.objects import object_machine, random_objects
from object_bench.refused_objects import check_refused, refused_objects
from suite.cases import chosen

from cardcage.golden.cycles.cycle_model import predict_cycles
from cardcage.golden.objects.making import link_words, made_at_controller
from cardcage.golden.objects.object_words import frame_words
from cardcage.golden.reference import exact
from cardcage.golden.specification import commands
from cardcage.golden.specification.commands import Opcode, ResponseKind
from cardcage.testbenches.frames.frame_job import frame_commands
from cardcage.testbenches.frames.responses import Answers
from cardcage.testbenches.frames.setup_timing import setup_timing

#: Machines that are compiled once for all tests.
MODELS = {
    "squares": ("2x(PMM)", {"block": 2, "shading": "flat", "setup_interval": 3}),
    "lines": ("4x(PM)", {"lines": True, "memory_ports": 2, "setup_interval": 64}),
    "three strips": ("3x(PM)", {"regions": (1, 3), "balance": "static", "shading": "flat",
                                "setup_interval": 64}),
    "regions that the machine deals out": ("2x(PMM)", {
        "regions": (4, 3), "balancer": "hardware", "shading": "flat", "setup_interval": 64}),
}
MESHES = (0, 1, 2, 3, 7)


def machine(name):
    cards, options = MODELS[name]
    return object_machine(cards, **{"fraction_bits": 32, "clocks_per_pixel": 2,
                                    "objects": "controller", "order_bits": 0} | options)


def objects(configuration, count, seed=1):
    return random_objects(configuration, count, seed, MESHES, wide=True,
                          flat=configuration.shading == "flat")


def lists(configuration):
    """Display lists of objects of the same meshes; of the second none is whole, of the third none
    is there."""
    some, clipped, none = (objects(configuration, count) for count in (30, 6, 0))
    clipped = replace(clipped, mesh=np.full(6, len(MESHES)))
    return [each.display_list() for each in (some, clipped, none)]


def redrawn(configuration, listed):
    """Of meshes that are there."""
    return [commands.frame_start(listed.background), *frame_words(configuration, listed),
            commands.command(Opcode.FRAME_END)]


def compare(configuration, listed, simulation):
    picture = exact.draw(listed, shading=configuration.shading)
    np.testing.assert_array_equal(simulation.video, picture.color)
    if configuration.balancer == "host":  # who else deals regions out knows where depths lie
        np.testing.assert_array_equal(simulation.depth, picture.depth)


@pytest.mark.parametrize("stall_seed", [None, 4])
@pytest.mark.parametrize("name", chosen(MODELS, "three strips"))
def test_frames_of_objects(name, stall_seed):
    """Meshes are loaded before the first and before the third; objects that reach out of the guard
    band come as triangles in between; then the host prepares all, and the first again."""
    configuration = machine(name)
    first, second, empty = lists(configuration)
    drawn = [first, second, empty, first, first]
    frames = [frame_commands(configuration, first), redrawn(configuration, second),
              frame_commands(configuration, empty),
              frame_commands(configuration, first, configuration.fraction_bits),
              frame_commands(configuration, first)]
    assert len(frames[0]) * commands.command_words(configuration) == link_words(
        configuration, first).total
    words = [word for own in frames for word in [*own, READ_DEPTH, READ_COUNTERS]]
    answers = Answers(configuration, run(configuration, words, compiled(), memory_seed=5,
                                         stall_seed=stall_seed))
    for number, listed in enumerate(drawn):
        simulation = answers.frame(number, reading=number)
        compare(configuration, listed, simulation)
        made = made_at_controller(configuration, listed)
        counted = (0, 0) if number == 3 else (made.made, made.dropped)
        assert (simulation.made, simulation.dropped) == ([counted[0]], [counted[1]])
    assert made_at_controller(configuration, second).sent == second.triangles > 0
    assert min(made_at_controller(configuration, first).made, counted[1]) > 10


@pytest.mark.parametrize("name", chosen(
    ["squares", "lines", "three strips"], "three strips"))
def test_clocks_are_predicted(name):
    """From the first object's command until all is drawn, with clipped objects among the others."""
    configuration = machine(name)
    listed = objects(configuration, 60, seed=7).display_list()
    words = frame_commands(configuration, listed)
    answered = run(configuration, words, compiled())
    opcodes = [commands.opcode_of(word) for word in words]
    start = opcodes.index(Opcode.FRAME_START)
    [drawn] = [value for kind, value, _ in answered.responses if kind == ResponseKind.FRAME_DRAWN]
    clocks = drawn - int(answered.accepted[start + 1] - answered.accepted[start])
    predicted = predict_cycles(configuration, listed, setup=setup_timing(configuration))
    # The end of the frame is taken, and all is found done, some clocks later.
    assert clocks == pytest.approx(predicted.cycles, rel=0.01, abs=10)


@pytest.mark.parametrize("name", ["lines", "three strips"])
def test_objects_that_are_refused(name):
    """Of a mesh that was not loaded, and of any while some mesh found no room, even those that were
    loaded; whole frames before and after."""
    configuration = machine(name)
    listed, *_ = lists(configuration)
    again = redrawn(configuration, listed)
    cases = [*refused_objects(configuration, frame_commands(configuration, listed), again),
             ([again[0], again[-1]], [])]
    words = [word for own, _ in cases for word in own]
    answered = run(configuration, words, compiled(), extra=sum(len(some) for _, some in cases))
    check_refused(answered, cases, listed.background)
