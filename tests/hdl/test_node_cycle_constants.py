"""What the cycle model knows of nodes is what they take: clocks of whole lists, and of a merge."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from counted_lists import list_of
from cycle_lists import scene
from suite.cases import EVERY, chosen
from wide_machines import wide_machine

from cardcage.golden.cycles.cycle_model import predict_cycles
from cardcage.golden.cycles.merge_clocks import predict_merge
from cardcage.golden.merging.cage import merge_cage
from cardcage.golden.organisations.organisation_of import organisation_of
from cardcage.golden.specification import commands
from cardcage.golden.specification.commands import Opcode, ResponseKind
from cardcage.golden.specification.configuration import MachineConfiguration
from cardcage.golden.specification.display_list import DisplayList
from cardcage.testbenches.engines.engine import Job
from cardcage.testbenches.engines.pysim_engine import PysimEngine
from cardcage.testbenches.frames.conversation import responses_owed
from cardcage.testbenches.frames.frame_job import frame_commands


def run(configuration: MachineConfiguration, words: list[int], unread: int = 0):
    """Until all responses are there but so many."""
    responses = responses_owed(organisation_of(configuration), words) - unread
    return PysimEngine().run(Job(configuration, words, responses, maximum_cycles=100_000))


def counted(configuration: MachineConfiguration, listed: DisplayList) -> int:
    """Clocks from the first triangle, or the command to draw the lists, until all is done."""
    barrier = commands.command(Opcode.READ_COUNTERS)
    words = [barrier, *frame_commands(configuration, listed)[:-1], barrier]
    start = [commands.opcode_of(word) for word in words].index(Opcode.FRAME_START)
    accepted = run(configuration, words).accepted
    return int(accepted[-1] - accepted[start + 1])


@pytest.mark.parametrize(("cards", "retained"), [
    ("2x(PMC)", True), pytest.param("2x(PMPMMMC)", False, marks=EVERY)])
def test_nodes_take_the_predicted_clocks(cards, retained):
    """With two ports, to the clock, where the last triangle of each node ends in the lowest row
    with a pixel of everyone's; with queues that fill."""
    listed = scene(1, n=40, size=4)
    machine = wide_machine(listed, cards=cards, memory_ports=2, fifo_depth=4,
                           list_words=20 if retained else 0)
    shares = organisation_of(machine).shares(list_of(40))
    for node in range(machine.nodes):
        listed.position[shares.of_node(node)[-1]] = 256 * np.array([[0, 0], [40, 0], [40, 28]])
    machine = replace(machine, fraction_bits=40)
    assert counted(machine, listed) == predict_cycles(machine, listed, retained=retained).cycles


@pytest.mark.parametrize("cards", chosen(["2x(PMT)", "3x(PMMT)"], "3x(PMMT)"))
def test_a_merge_takes_the_predicted_clocks(cards):
    """With two ports, to the clock; ``tests/machine/nodes/test_one_port_merges.py`` has one."""
    listed = scene(5, n=30, size=12)
    machine = wide_machine(listed, cards=cards, memory_ports=2)
    # The scan that shows it is not waited for.
    responses = run(machine, frame_commands(machine, listed), unread=1).responses
    took = {kind: value for kind, value, *_ in responses}
    assert min(merge_cage(machine, listed)[1].steps) > 50
    assert (took[ResponseKind.MERGED] - took[ResponseKind.FRAME_DRAWN]
            == predict_merge(machine, listed))
