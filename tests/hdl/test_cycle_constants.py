"""The numbers that the cycle model goes by are those of the components.

Each is compared with what its component states; and since some are stated by none, the clocks of
whole lists are predicted and counted, where any of them would show.
"""

from __future__ import annotations

from dataclasses import fields, replace

import numpy as np
import pytest
from cycle_lists import scene
from wide_machines import wide_machine

from cardcage.golden.cycles.broadcast import LIST_LATENCY, SetupTiming
from cardcage.golden.cycles.cycle_model import predict_cycles
from cardcage.golden.cycles.direct.direct_work import CROSSBAR_LATENCY
from cardcage.golden.cycles.direct.unit_ports import OnePortUnits
from cardcage.golden.cycles.element_latencies import PIPELINE, Pipeline
from cardcage.golden.cycles.objects.object_setup import (
    MAKING_LATENCY,
    OBJECTS_WAITING,
    QUEUE_LATENCY,
)
from cardcage.golden.cycles.one_port.one_port_lanes import LANE_START
from cardcage.golden.cycles.received_pixels import LANE_CLOCKS
from cardcage.golden.specification import commands
from cardcage.golden.specification.commands import Opcode
from cardcage.golden.specification.configuration import MachineConfiguration
from cardcage.golden.specification.display_list import DisplayList
from cardcage.hdl.depth_test.one_port import OnePortDepthTest
from cardcage.hdl.depth_test.one_port_lane import OnePortLane
from cardcage.hdl.depth_test.two_ports import TwoPortDepthTest
from cardcage.hdl.direct.crossbar import Crossbar
from cardcage.hdl.nodes.node_gate import NodeGate
from cardcage.hdl.objects.object_reader import ObjectReader
from cardcage.hdl.objects.object_setup import ObjectSetup
from cardcage.hdl.processing_element.broadcast_queue import BroadcastQueue
from cardcage.hdl.processing_element.drawing_element import SPANS_LATENCY
from cardcage.hdl.rasteriser.fragment_stepper import FragmentStepper
from cardcage.hdl.rasteriser.interpolator import Interpolator
from cardcage.hdl.rasteriser.triangle_spans import TriangleSpans
from cardcage.hdl.triangle_setup.triangle_setup import TriangleSetup
from cardcage.testbenches.engines.engine import Job
from cardcage.testbenches.engines.pysim_engine import PysimEngine
from cardcage.testbenches.frames.frame_job import frame_commands


def test_the_pipeline():
    after_spans = FragmentStepper.latency + Interpolator.latency
    assert PIPELINE.queue == BroadcastQueue.latency
    assert PIPELINE.latency == TriangleSpans.latency + SPANS_LATENCY + after_spans
    # A span that is taken from the full queue shows in its level a clock later, and the room for
    # another one that clock after.
    assert PIPELINE.lead == after_spans - 2
    assert PIPELINE.valued == Interpolator.latency + 1


@pytest.mark.parametrize("kind", [OnePortDepthTest, TwoPortDepthTest])
def test_the_end_is_seen_a_clock_after_the_last_write(kind):
    assert PIPELINE.finish == kind.latency + 1


def test_a_lane():
    # On one unit reads and writes take turns once the first write has come; of the clocks after
    # the last read every other one has no write, and these are lost.
    assert OnePortLane.latency % 2 == 1
    assert OnePortDepthTest.waiting + (OnePortLane.latency - 1) // 2 == LANE_START
    assert OnePortDepthTest.waiting == LANE_CLOCKS


def test_a_crossbar():
    assert Crossbar.latency == CROSSBAR_LATENCY
    assert OnePortLane.latency == OnePortUnits.latency


def test_set_up():
    assert SetupTiming(interval=3).leaving == TriangleSetup.leaving


def test_objects():
    assert ObjectSetup.depth == OBJECTS_WAITING
    assert ObjectSetup.queue_latency == QUEUE_LATENCY
    assert ObjectSetup.queue_latency + ObjectReader.latency == MAKING_LATENCY


def test_lists():
    assert NodeGate.list_latency == LIST_LATENCY


def counted(configuration: MachineConfiguration, lists: list[DisplayList]) -> list[int]:
    """Clocks of each list, from its first triangle until the machine is done."""
    barrier = commands.command(Opcode.READ_COUNTERS)
    words, places = [frame_commands(configuration, lists[0])[0], barrier], []
    for listed in lists:
        triangles = frame_commands(configuration, listed)[1:-1]
        places.append((len(words), len(words) + len(triangles)))
        words += [*triangles, barrier]
    elements = configuration.processing_elements
    responses = elements + 3 + 2 * elements * (1 + len(lists))
    run = PysimEngine().run(Job(configuration, words, responses, maximum_cycles=100_000))
    return [int(run.accepted[end] - run.accepted[first]) for first, end in places]


def ending_large(seed: int, n: int, size: int) -> DisplayList:
    """Random triangles; the last one ends, in the lowest row, with a pixel of everyone's."""
    listed = scene(seed, n=n, size=size)
    listed.position[-1] = 256 * np.array([[0, 0], [40, 0], [40, 28]])
    return listed


LISTS = [ending_large(1, 1, 8), ending_large(4, 40, 2)]


def machine_of_several_blocks() -> MachineConfiguration:
    """Three units are two blocks; two triangles are few to wait, so that each waits for another."""
    return wide_machine(LISTS[1], cards="PMPMMM", memory_ports=2, fifo_depth=2, fraction_bits=40)


def predicted(pipeline: Pipeline) -> list[float]:
    return [predict_cycles(machine_of_several_blocks(), listed, pipeline).cycles
            for listed in LISTS]


def test_the_machine_takes_the_predicted_clocks():
    """With two ports, to the clock."""
    assert counted(machine_of_several_blocks(), LISTS) == predicted(PIPELINE)


@pytest.mark.parametrize("name", [field.name for field in fields(Pipeline)
                                  if field.name not in ("spans_ahead", "lead")])
@pytest.mark.parametrize("more", [-1, 1])
def test_a_wrong_constant_would_show(name, more):
    wrong = replace(PIPELINE, **{name: getattr(PIPELINE, name) + more})
    assert predicted(wrong) != predicted(PIPELINE)
