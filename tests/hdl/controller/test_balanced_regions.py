"""The controller that makes the tables itself: from counts to the next frame's table."""

import random
from itertools import pairwise

import numpy as np
import pytest
from hdl_bench.region_cage import MACHINES, RegionRun, machine, placed
from suite.cases import chosen

from cardcage.golden.balancing.balancer_clocks import balancer_clocks
from cardcage.golden.organisations.region_table import packed_table, slots_of, static_table
from cardcage.golden.specification import commands
from cardcage.golden.specification.commands import Fault, Opcode, ResponseKind
from cardcage.hdl.backplane.words import Operation

REGION, END, READ_REGIONS, READ_TABLE, DRAW = (commands.command(opcode) for opcode in (
    Opcode.REGION, Opcode.FRAME_END, Opcode.READ_REGIONS, Opcode.READ_TABLE,
    Opcode.PREPARED_TRIANGLE))
START = commands.frame_start((1, 2, 3))


class Counts:
    """Numbers for all slots, time after time, which it keeps."""

    def __init__(self, seed):
        self.pick = random.Random(f"counts {seed}")
        self.sent = []

    def __call__(self, slots):
        most = self.pick.choice((0, 3, 1000, (1 << 32) - 1))
        self.sent.append([self.pick.randint(0, most) for _ in range(slots)])
        return self.sent[-1]


def expected_of(configuration, words, sent, elements=None):
    """What is answered, and the table of each frame that starts, given the counts."""
    elements = configuration.processing_elements if elements is None else elements
    regions, slots = configuration.dealt_regions.count, configuration.slots
    used = coming = static_table(regions, elements)
    answers, tables, sent, begun = [], [], iter(sent), False
    for word in words:
        opcode = commands.opcode_of(word)
        if opcode == Opcode.FRAME_START:
            used, begun = coming, True
            tables.append(placed(used))
        elif opcode == Opcode.FRAME_END:
            answers += [(ResponseKind.FRAME_DRAWN, None), (ResponseKind.FRAME_SHOWN, None)]
            if begun:
                counts = np.array(next(sent)).reshape(elements, slots)
                coming = packed_table(counts[used, slots_of(used)], elements, slots)
            begun = False
        elif opcode == Opcode.READ_REGIONS:
            answers += [(ResponseKind.REGION_COUNT, count) for count in next(sent)]
        elif opcode == Opcode.READ_TABLE:
            answers += [(ResponseKind.TABLE_ENTRY, element) for element in coming.tolist()]
        elif opcode == Opcode.REGION:
            answers.append((ResponseKind.ERROR, Fault.UNKNOWN_COMMAND))
    return answers, tables


def random_words(pick, frames):
    words = []
    for _ in range(frames):
        words += [READ_TABLE] * (pick.random() < 0.4) + [REGION] * (pick.random() < 0.2)
        frame = [START, *[DRAW] * pick.choice((0, 1, 5)), END]
        if pick.random() < 0.3:  # abandoned
            frame[-1:] = [START, DRAW, END]
        if pick.random() < 0.2:
            frame.insert(-1, pick.choice((READ_TABLE, READ_REGIONS, REGION)))
        if pick.random() < 0.2:  # never begun
            frame = [END]
        words += frame + [READ_REGIONS] * (pick.random() < 0.3)
    return [*words, READ_TABLE]


def owed(configuration, words):
    """Responses in all, whatever is counted."""
    nothing = [[0] * (configuration.processing_elements * configuration.slots)] * len(words)
    return len(expected_of(configuration, words, nothing)[0])


@pytest.mark.parametrize("name", MACHINES)
@pytest.mark.parametrize("seed", chosen([None, 0], 0))
def test_each_frame_has_the_table_packed_by_the_last_one(name, seed):
    """Also read in between, and with counts that the host reads for itself; of a frame that was
    never begun nothing is counted."""
    pick = random.Random(f"{name} {seed}")
    configuration = machine(name, balancer="hardware")
    words, counts = random_words(pick, 8), Counts(seed)
    run = RegionRun(configuration, words,
                    configuration.processing_elements + 3 + owed(configuration, words), seed=seed,
                    work=0 if seed is None else 20, period=pick.choice((30, 300)), counts=counts)
    answers, tables = expected_of(configuration, words, counts.sent)
    assert [(kind, value if expected is not None else None) for (kind, value), (_, expected)
            in zip(run.answers, answers, strict=True)] == answers
    starts = [clock for clock, operation, _ in run.cage.packets
              if operation == Operation.FRAME_START]
    for start, end, table in zip(starts, [*starts[1:], len(run.lines.drawn) - 1], tables,
                                 strict=True):
        assert set(run.lines.drawn[start + 1:end + 1]) == {table}
    swaps = [*run.scans.swaps, len(run.lines.shown) - 1]
    for swap, end in pairwise(swaps):
        begun = sum(start < swap for start in starts)
        if begun:
            assert set(run.lines.shown[swap + 1:end + 1]) == {tables[begun - 1]}


@pytest.mark.parametrize("period", [20, 2_000])
def test_the_picture_does_not_wait_for_the_table_nor_the_table_for_long(period):
    """A scan that begins meanwhile shows it.  Where the scan comes later than the table is packed,
    the next frame waits for no more than the table's being dealt."""
    configuration = machine("three", balancer="hardware")
    count = configuration.dealt_regions.count
    run = RegionRun(configuration, [START, END, START], 3 + 3 + 2, period=period,
                    counts=Counts(period))
    drawn, shown = (run.clock_of(kind) for kind in (ResponseKind.FRAME_DRAWN,
                                                    ResponseKind.FRAME_SHOWN))
    [swap] = run.scans.swaps
    assert swap == min(clock for clock in run.scans.starts if clock > drawn)
    assert shown == swap + 1
    packing = balancer_clocks(count, 3, configuration.slots)
    *_, next_frame = run.source.taken
    if period > packing + 100:
        assert next_frame == swap + count + 3
    else:
        assert swap < drawn + packing < next_frame <= drawn + packing + count + 25


@pytest.mark.parametrize("elements", [2, 3])
def test_with_boards_pulled_out(elements):
    configuration = machine("three", balancer="hardware", slots=4)
    words, counts = [READ_TABLE, START, END, READ_TABLE, START, END, READ_TABLE], Counts(elements)
    run = RegionRun(configuration, words, elements + 3 + 3 * 8 + 4, elements=elements,
                    counts=counts)
    answers, _ = expected_of(configuration, words, counts.sent, elements)
    assert [value for kind, value in run.answers if kind == ResponseKind.TABLE_ENTRY] == [
        value for kind, value in answers if kind == ResponseKind.TABLE_ENTRY]
