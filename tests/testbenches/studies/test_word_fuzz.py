"""After any sequence of words, with resets in between, the machine answers and draws on exactly.

Longer: ``python -m testbenches.studies.word_fuzz --minutes 10``.
"""

import random
from dataclasses import replace

import pytest
from frames import random_list
from hdl_bench.bench import simulate
from hdl_bench.streams import Sink, Source
from suite.cases import chosen
from wide_machines import wide_machine

from cardcage.golden.organisations.organisation_of import organisation_of
from cardcage.golden.reference import exact
from cardcage.golden.specification import commands
from cardcage.golden.specification.commands import Opcode, ResponseKind
from cardcage.hdl.machine import Machine
from cardcage.testbenches.engines.pysim_engine import PysimEngine
from cardcage.testbenches.engines.verilator_engine import VerilatorEngine
from cardcage.testbenches.engines.verilator_tool import ToolMissingError
from cardcage.testbenches.frames.compare import compare
from cardcage.testbenches.frames.frame_job import frame_commands, frame_job
from cardcage.testbenches.frames.responses import Answers
from testbenches.studies.word_fuzz import LARGER, MACHINES, machine, run_trial


@pytest.mark.parametrize("name", chosen([name for name in MACHINES if name not in LARGER],
                                        "skew", "bus", "regions, hardware"))
def test_a_good_frame_after_stray_words_is_exact(name):
    seed = 1
    print(f"machine {name}, seed {seed}")
    run = run_trial(name, seed, PysimEngine(), resets=1, rounds=1)
    assert len(run.accepted) > 40


def test_a_good_frame_after_stray_words_is_exact_on_a_larger_machine():
    """Compiled, once, for many seeds."""
    try:
        engine = VerilatorEngine()
    except ToolMissingError as missing:
        pytest.skip(f"simulator verilator: {missing}")
    for seed in range(10):
        print(f"machine larger, seed {seed}")
        run_trial("larger", seed, engine, resets=seed % 4)


@pytest.mark.parametrize("name", ["PMPM", "4x(PM)", "PMPMMM"])
def test_a_bottom_past_the_picture_does_not_hang(name):
    top = 1
    configuration, (display_list, *_) = machine(name)
    layout = commands.prepared_triangle_layout(configuration)
    whole = {"start": 0, "step": 0}
    right = {"start": 8 << configuration.edge_fraction_bits, "step": 0}
    planes = {name: {"start": 0, "step_x": 0, "step_y": 0} for name in layout["planes"]}
    word = commands.command(Opcode.PREPARED_TRIANGLE, commands.pack(layout, {
        "top": top, "middle": 15, "bottom": 15, "left": 0, "right": 8, "long_edge_left": 1,
        "long": whole, "upper": right, "lower": right, "planes": planes}))
    background = commands.frame_start(display_list.background)
    stray = [background, word, commands.command(Opcode.READ_DEPTH)]
    frame = frame_job(configuration, display_list)
    organisation = organisation_of(configuration)
    depths = organisation.depths_read_back
    job = replace(frame, commands=[*stray, *frame.commands],
                  responses=frame.responses + depths,
                  maximum_cycles=frame.maximum_cycles)
    run = PysimEngine().run(job)
    boot = len(organisation.domains) + 3
    drawn = organisation.depth_image([value for _, value, _ in run.responses[boot:boot + depths]])
    assert (drawn[:top] == configuration.depth_background).all() and not drawn[top:].any()
    alone = replace(run, responses=[*run.responses[:boot], *run.responses[boot + depths:]])
    comparison = compare(configuration, display_list, Answers(configuration, alone).frame(0, 0))
    assert comparison.equal, comparison.first_difference


def test_a_host_that_does_not_take_its_responses_is_waited_for():
    source = random.Random("patient")
    display_list = random_list(5, 6, width=4, height=4)
    configuration = wide_machine(display_list, cards="PMPM")
    words = [*frame_commands(configuration, display_list), commands.command(Opcode.READ_DEPTH)]
    dut = Machine(configuration=configuration)
    responses = 2 + 3 + 2 + 16
    sink = Sink(dut.responses, responses, lambda: source.choice([0] * 4 + [700]))
    simulate(dut, Source(dut.commands, words), sink, after=50)
    assert len(sink.items) == responses and max(sink.clocks) > 2000
    depths = [item.value for item in sink.items if item.kind == ResponseKind.DEPTH]
    image = organisation_of(configuration).depth_image(depths)
    assert (image == exact.draw(display_list).depth).all()
