"""Elements that pass objects on: whole frames, every pixel, depth and count golden's."""

import numpy as np
import pytest
from node_frames import READ_COUNTERS, READ_DEPTH, compiled, run
from region_bench.forwarded_scenes import MODELS, machine, scenes
from suite.cases import chosen

from cardcage.golden.cycles.cycle_model import predict_cycles
from cardcage.golden.objects.forwarding import forwarded_objects, made_at_elements
from cardcage.golden.objects.object_words import frame_words, mesh_words
from cardcage.golden.reference.exact import depth_complexity
from cardcage.golden.specification import commands
from cardcage.golden.specification.commands import Fault, Opcode, ResponseKind
from cardcage.testbenches.frames.compare import compare
from cardcage.testbenches.frames.frame_job import frame_commands
from cardcage.testbenches.frames.responses import Answers
from cardcage.testbenches.frames.setup_timing import setup_timing

#: All of them take minutes to compile.
SUITE = chosen(MODELS, "three strips, one port")

#: Of the clocks to draw.
ACCURACY = 0.01

CLEAR, END = (commands.command(opcode) for opcode in (Opcode.CLEAR_LISTS, Opcode.FRAME_END))


def frame(configuration, listed):
    """Of meshes that are loaded."""
    return [commands.frame_start(listed.background), *frame_words(configuration, listed), END,
            READ_DEPTH, READ_COUNTERS]


@pytest.mark.parametrize("name", SUITE)
def test_frames_of_objects(name):
    """From random memory; with and without stalls; each kind of scene after each other one, and at
    the end one of triangles that the host has prepared.  Without stalls the cycle model foretells
    the clocks."""
    configuration = machine(name)
    drawn = scenes(configuration)
    lists = [*[*drawn.values(), *drawn.values()][::2], drawn["anywhere"]]
    some = lists[0]
    load = [CLEAR, *mesh_words(configuration, some.objects)]
    prepared = frame_commands(configuration, some, configuration.fraction_bits)
    words = [*load, *(word for listed in lists[:-1] for word in frame(configuration, listed)),
             *prepared, READ_DEPTH, READ_COUNTERS]
    for stalls in (None, 6):
        answers = Answers(configuration, run(configuration, words, compiled(), memory_seed=5,
                                             stall_seed=stalls))
        for number, listed in enumerate(lists):
            simulation = answers.frame(number, reading=number)
            judged = compare(configuration, listed, simulation)
            assert judged.equal and judged.depths_compared == simulation.depth.size
            assert sum(work.fragments for work in simulation.work) == depth_complexity(listed).sum()
            if number == len(lists) - 1:
                assert not any(simulation.made) and not np.array(simulation.forwarded).any()
                continue
            made = made_at_elements(configuration, listed)
            golden = forwarded_objects(configuration, listed)
            assert list(simulation.made) == [each.made for each in made]
            assert list(simulation.dropped) == [each.dropped for each in made]
            assert list(simulation.forwarded) == list(zip(
                golden.left.tolist(), golden.right.tolist(), strict=True))
            if stalls is None and listed.triangles:
                clocks = predict_cycles(configuration, listed, setup=setup_timing(configuration))
                assert abs(clocks.cycles / simulation.draw_cycles - 1) < ACCURACY
                assert clocks.bound <= 1.001 * simulation.draw_cycles


def test_scenes_are_what_they_say():
    """Ties between objects, objects passed both ways, and dropped and clipped triangles."""
    configuration = machine("four of a grid")
    drawn = scenes(configuration)
    golden = {name: forwarded_objects(configuration, listed) for name, listed in drawn.items()}
    assert golden["all tied everywhere"].drawn.all()
    assert golden["in the first element"].drawn[:, 0].sum() > 12
    assert golden["anywhere"].left.sum() > 5 < golden["anywhere"].right.sum()
    assert golden["anywhere"].left.max() > 3
    made = made_at_elements(configuration, drawn["clipped"])
    assert made[0].sent > 10 and all(each.dropped > 0 for each in made)


def test_objects_that_are_refused():
    configuration = machine("three strips, one port")
    some = scenes(configuration)["anywhere"]
    begin, load, unknown = (commands.command(*word) for word in (
        (Opcode.MESH,), (Opcode.MESH_TRIANGLE,), (Opcode.OBJECT, configuration.meshes)))
    full = [CLEAR, begin, *[load] * (configuration.mesh_triangles + 1)]
    meshes = mesh_words(configuration, some.objects)
    start, *objects, end, _, _ = frame(configuration, some)
    whole = [word for word in objects if commands.opcode_of(word) == Opcode.OBJECT]
    region = commands.command(Opcode.REGION)
    words = [CLEAR, *meshes, start, unknown, *objects, end, *full, start, *whole, end, region,
             CLEAR, *meshes, start, *objects, end, READ_COUNTERS]
    faults = [Fault.NO_MESH, *[Fault.LIST_FULL] * len(whole), Fault.UNKNOWN_COMMAND]
    answered = run(configuration, words, compiled(), extra=len(faults) - 1)
    assert [value for kind, value, _ in answered.responses
            if kind == ResponseKind.ERROR] == faults
    shown = [cycle for kind, _, cycle in answered.responses if kind == ResponseKind.FRAME_SHOWN]
    one, nothing, other = (next(scan.picture for scan in answered.scans if scan.cycle > cycle)
                           for cycle in shown)
    np.testing.assert_array_equal(one, other)
    assert (nothing == some.background).all() and (one != nothing).any()
