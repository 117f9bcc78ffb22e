"""Frames of machines that deal regions out: tables and triangles in, pixels on the pins."""

import random

import numpy as np
import pytest
from frames import golden_picture
from hdl_bench.region_tables import table_words
from node_frames import compiled
from region_bench.models import BALANCERS, MODELS, machine, random_table, some_list
from suite.cases import chosen

from cardcage.golden.organisations.organisation_of import organisation_of
from cardcage.golden.organisations.region_table import packed_table, slots_of
from cardcage.golden.specification import commands
from cardcage.golden.specification.commands import Fault, Opcode, ResponseKind
from cardcage.testbenches.engines.engine import Job
from cardcage.testbenches.frames.frame_job import frame_commands

READ_DEPTH, READ_REGIONS, READ_TABLE = (commands.command(opcode) for opcode in (
    Opcode.READ_DEPTH, Opcode.READ_REGIONS, Opcode.READ_TABLE))

def run(configuration, words, responses, **options):
    engine = compiled()
    return engine.run(Job(configuration, commands=words, maximum_cycles=2_000_000,
                          responses=configuration.processing_elements + 3 + responses, **options))


def values_of(answered, kind):
    return [value for found, value, _ in answered.responses if found == kind]


def check(configuration, lists, tables, answered):
    """Each picture whole on the pins, scan after scan, and its depths where its table puts them."""
    organisation = organisation_of(configuration)
    pictures = [golden_picture(configuration, listed) for listed in lists]
    words = organisation.depths_read_back
    depths = np.array(values_of(answered, ResponseKind.DEPTH)).reshape(len(lists), words)
    for number, (read, picture, table) in enumerate(zip(depths, pictures, tables, strict=True)):
        wrong = np.argwhere(organisation.dealt(table).depth_image(read) != picture.depth)
        assert not len(wrong), f"frame {number}: {len(wrong)} depths differ, first {wrong[0]}"
    shown = [cycle for kind, _, cycle in answered.responses if kind == ResponseKind.FRAME_SHOWN]
    repeated = values_of(answered, ResponseKind.FRAME_SHOWN)
    seen = []
    for scan in answered.scans:
        number = sum(cycle < scan.cycle for cycle in shown) - 1
        if number >= 0:  # before that the boot's black picture
            wrong = np.argwhere((scan.picture != pictures[number].color).any(axis=-1))
            assert not len(wrong), (f"frame {number}: {len(wrong)} colours differ, first "
                                    f"{wrong[0]}, cycle {scan.cycle}")
            seen.append(number)
    assert sorted(set(seen)) == list(range(len(lists)))
    return repeated


def of_every_kind(configuration, pick, frames):
    """Commands of frames, with a table of its own before some, and what is wrong with others;
    tables, how many responses, and the faults among these."""
    words, tables, faults = [], [], []
    table = organisation_of(configuration).table
    lists = [some_list(configuration, pick.randrange(1 << 30), pick.choice((1, 9, 25)))
             for _ in range(frames)]
    for listed in lists:
        kind = pick.choice(("same", "new", "new", "new", "wrong", "late", "abandoned"))
        new = random_table(pick, configuration)
        if kind in ("new", "abandoned"):
            words += table_words(configuration, new)
            table = new
        frame = list(frame_commands(configuration, listed))
        if kind == "wrong":  # it ends too soon
            words += table_words(configuration, new)[:-1]
            faults.append(Fault.REGION_TO_NOBODY)
        elif kind == "late":
            frame[-1:-1] = table_words(configuration, new)
            faults.append(Fault.TABLE_LATE)
        elif kind == "abandoned":
            other = some_list(configuration, pick.randrange(1 << 30), 9)
            frame[:0] = frame_commands(configuration, other)[:-1]
        tables.append(table)
        words += [*frame, READ_DEPTH]
    return lists, tables, words, faults


@pytest.mark.parametrize("stall_seed", [None, 1])
@pytest.mark.parametrize("name", chosen(
    MODELS, "three, two ports"))
def test_frames_by_tables_of_the_host(name, stall_seed):
    """From random memory; each table is used from its frame on, a refused one never."""
    configuration = machine(MODELS, name)
    pick = random.Random(f"{name} {stall_seed}")
    frames = 14
    lists, tables, words, faults = of_every_kind(configuration, pick, frames)
    depths = organisation_of(configuration).depths_read_back
    answered = run(configuration, words, frames * (2 + depths) + len(faults), memory_seed=7,
                   stall_seed=stall_seed)
    assert values_of(answered, ResponseKind.ERROR) == faults
    check(configuration, lists, tables, answered)


@pytest.mark.parametrize("name", chosen(["three, two ports", "four, full"], "three, two ports"))
def test_a_late_picture(name):
    """While one is drawn by its own table the one before is shown by its own, for many scans."""
    configuration = machine(MODELS, name)
    pick = random.Random(name)
    lists = [some_list(configuration, number, count) for number, count in
             enumerate((3, 400, 3, 400, 3))]
    tables = [random_table(pick, configuration) for _ in lists]
    words = [word for listed, table in zip(lists, tables, strict=True) for word in [
        *table_words(configuration, table), *frame_commands(configuration, listed), READ_DEPTH]]
    depths = organisation_of(configuration).depths_read_back
    answered = run(configuration, words, len(lists) * (2 + depths), memory_seed=1)
    repeated = check(configuration, lists, tables, answered)
    assert min(repeated[1], repeated[3]) > 2


@pytest.mark.parametrize("stall_seed", [None, 1])
@pytest.mark.parametrize("name", chosen(BALANCERS, "three, two ports"))
def test_frames_by_tables_of_the_machine(name, stall_seed):
    """Each is packed of what the last frame counted; host and machine read the same counts."""
    configuration = machine(BALANCERS, name, balancer="hardware")
    organisation = organisation_of(configuration)
    frames = 10
    lists = [some_list(configuration, (3, number), 3 + 4 * (number % 4))
             for number in range(frames)]
    words = [word for listed in lists for word in [
        *frame_commands(configuration, listed), READ_DEPTH, READ_REGIONS, READ_TABLE]]
    elements, slots = configuration.processing_elements, configuration.slots
    count = configuration.dealt_regions.count
    answered = run(configuration, words,
                   frames * (2 + organisation.depths_read_back + elements * slots + count),
                   memory_seed=2, stall_seed=stall_seed)
    counts = np.array(values_of(answered, ResponseKind.REGION_COUNT)).reshape(
        frames, elements, slots)
    packed = np.array(values_of(answered, ResponseKind.TABLE_ENTRY)).reshape(frames, count)
    tables = [organisation.table, *packed[:-1]]
    for counted, table, following in zip(counts, tables, packed, strict=True):
        np.testing.assert_array_equal(
            packed_table(counted[table, slots_of(table)], elements, slots), following)
    assert len({tuple(table) for table in packed}) > frames / 2
    check(configuration, lists, tables, answered)
