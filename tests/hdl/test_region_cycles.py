"""The clocks of machines that deal regions out, predicted and counted, to the clock.

Boxes of few regions and of many, rows without a span, an element that a table gives nothing.  What
the model says of each part is in ``tests/golden/cycles/regions``.
"""

from __future__ import annotations

import numpy as np
import pytest
from cycle_lists import scene
from suite.cases import EVERY
from wide_machines import wide_machine

from cardcage.golden.cycles.cycle_model import predict_cycles
from cardcage.golden.organisations.region_table import static_table
from cardcage.golden.specification import commands
from cardcage.golden.specification.commands import Opcode
from cardcage.golden.specification.configuration import MachineConfiguration
from cardcage.golden.specification.display_list import DisplayList
from cardcage.testbenches.engines.engine import Job
from cardcage.testbenches.engines.pysim_engine import PysimEngine
from cardcage.testbenches.frames.frame_job import frame_commands
from cardcage.testbenches.frames.region_host import table_commands


def counted(configuration: MachineConfiguration, listed: DisplayList, table) -> int:
    """Clocks from the list's first triangle until the machine is done."""
    barrier = commands.command(Opcode.READ_COUNTERS)
    start, *triangles, _ = frame_commands(configuration, listed)
    before = [*table_commands(configuration, table), start, barrier]
    elements = configuration.processing_elements
    run = PysimEngine().run(Job(configuration, [*before, *triangles, barrier],
                                elements + 3 + 4 * elements, maximum_cycles=100_000))
    return int(run.accepted[len(before) + len(triangles)] - run.accepted[len(before)])


def slivers(seed: int, n: int) -> DisplayList:
    """From one side of the screen to the other, a pixel or two thick."""
    random = np.random.default_rng(seed)
    listed = scene(seed, n=n)
    begin = random.integers(0, [40 * 256, 28 * 256], (n, 2))
    end = random.integers(0, [40 * 256, 28 * 256], (n, 2))
    listed.position[:] = np.stack([begin, end, end + random.integers(-300, 300, (n, 2))], axis=1)
    return listed


def ending_large(listed: DisplayList) -> DisplayList:
    """The same, with a last triangle that covers the screen: every element that has a region ends
    with a pixel, from which on the end is counted."""
    listed.position[-1] = 256 * np.array([[0, 0], [80, 0], [0, 56]])
    return listed


def flat_bars(seed: int, n: int) -> DisplayList:
    """Long and some rows thick: where they leave a high region many rows without a pixel follow,
    while spans before these wait."""
    random = np.random.default_rng(seed)
    listed = scene(seed, n=n)
    begin = random.integers(0, [10 * 256, 28 * 256], (n, 2))
    end = np.stack([random.integers(30 * 256, 40 * 256, n),
                    (begin[:, 1] + random.integers(-14 * 256, 14 * 256, n)).clip(0, 28 * 256)],
                   axis=1)
    listed.position[:] = np.stack([begin, end, end + np.array([0, 1300])], axis=1)
    return listed


def test_rows_without_a_pixel_behind_spans_that_wait():
    listed = ending_large(flat_bars(19, 25))
    configuration = wide_machine(listed, cards="2x(PMM)", memory_ports=2, fraction_bits=40,
                                 regions=(10, 2), slots=10)
    table = np.random.default_rng(19).permutation(static_table(20, 2))
    predicted = predict_cycles(configuration, listed, table=table)
    assert counted(configuration, listed, table) == predicted.cycles


@pytest.mark.parametrize(("seed", "cards", "regions", "fifo"), [
    (1, "3x(PM)", (5, 7), 5), pytest.param(2, "2x(PMM)", (10, 4), 16, marks=EVERY)])
def test_the_machine_takes_the_predicted_clocks(seed, cards, regions, fifo):
    print(f"seed {seed}")
    random = np.random.default_rng(seed)
    listed = ending_large(scene(seed, n=30, size=5).followed_by(slivers(seed, 15)))
    configuration = wide_machine(
        listed, cards=cards, memory_ports=2, fifo_depth=fifo, fraction_bits=40, regions=regions,
        slots=-(-regions[0] * regions[1] // 2))
    elements, count = configuration.processing_elements, configuration.dealt_regions.count
    if elements > 2:  # the last one has nothing
        elements -= 1
    table = random.permutation(static_table(count, elements))
    predicted = predict_cycles(configuration, listed, table=table)
    assert predicted.cycles > 1.01 * predicted.bound, "its parts do not wait for one another"
    assert counted(configuration, listed, table) == predicted.cycles
