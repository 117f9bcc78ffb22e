"""What a host says and hears where regions are dealt out, and what the page says of it."""

import re
from pathlib import Path

import numpy as np
import pytest

from cardcage.golden.balancing.learnt_counts import learnt_counts
from cardcage.golden.organisations.organisation_of import organisation_of
from cardcage.golden.organisations.region_table import (
    packed_table,
    runs_table,
    slots_of,
    static_table,
)
from cardcage.golden.scene_display_list import make_display_list
from cardcage.golden.specification import commands
from cardcage.golden.specification.commands import Fault, Opcode, ResponseKind, opcode_of, unpack
from cardcage.golden.specification.configuration import MachineConfiguration
from cardcage.golden.specification.errors import InputError
from cardcage.testbenches.frames.conversation import owed_to, responses_owed
from cardcage.testbenches.frames.frame_job import frame_commands, frame_job
from cardcage.testbenches.frames.region_figures import RegionTables, sent_table
from cardcage.testbenches.frames.region_host import (
    RegionHost,
    of_regions,
    of_slots,
    region_readings,
    table_commands,
)

PAGE = Path(__file__).parents[3] / "docs" / "regions.md"
MACHINE = MachineConfiguration("3x(PM)", 20, 14, regions=(5, 4), slots=8)


def read(machine, words):
    """Regions and elements of command words."""
    layout = commands.region_layout(machine)
    found = [unpack(layout, word >> commands.BODY_OFFSET) for word in words]
    assert all(opcode_of(word) == Opcode.REGION for word in words)
    return [(each["row"], each["column"]) for each in found], [each["element"] for each in found]


def test_a_table_in_words():
    table = np.arange(20) * 7 % 3
    places, elements = read(MACHINE, table_commands(MACHINE, table))
    assert places == [(row, column) for row in range(4) for column in range(5)]
    assert elements == table.tolist()


@pytest.mark.parametrize("seed", range(5))
def test_counts_of_slots_and_of_regions(seed):
    source = np.random.default_rng(seed)
    table = source.permutation(np.arange(20) % 3)
    counts = source.integers(0, 100, 20)
    slots = of_slots(MACHINE, table, counts)
    assert slots.sum() == counts.sum() and slots.shape == (3, 8)
    for region, (element, slot) in enumerate(zip(table, slots_of(table), strict=True)):
        assert slots[element, slot] == counts[region]
    assert of_regions(MACHINE, table, slots.ravel().tolist()).tolist() == counts.tolist()


@pytest.mark.parametrize("policy", ["clocks", "learnt", None])
def test_a_host_from_picture_to_picture(policy):
    """It learns from three pictures; until then it has the last one's counts."""
    host = RegionHost(MACHINE, policy=policy)
    assert host.policy == (policy or "learnt")
    assert host.table.tolist() == static_table(20, 3).tolist() and host.commands() == []
    seen = []
    for number in range(6):
        counts = np.random.default_rng(number).integers(0, 100, 20)
        seen = [counts, *seen]
        host.counted(of_slots(MACHINE, host.table, counts).ravel())
        weighed = (learnt_counts(seen[:3], 5) if number >= 2 and policy != "clocks" else counts)
        assert host.table.tolist() == packed_table(weighed, 3, 8).tolist()
        assert host.table.tolist() != packed_table(counts, 3, 8).tolist() or weighed is counts
        assert read(MACHINE, host.commands())[1] == host.table.tolist()
        assert host.commands() == []  # it knows now


@pytest.mark.parametrize("fields", [{"balance": "static"}, {"balancer": "hardware"}], ids=str)
def test_a_host_that_sends_no_table(fields):
    host = RegionHost(MachineConfiguration("3x(PM)", 20, 14, regions=(5, 4), slots=8, **fields))
    host.counted(np.arange(24))
    assert host.commands() == []


def test_a_host_that_gives_each_element_one_run():
    """It says so before the first picture, and never again."""
    machine = MachineConfiguration("3x(PM)", 20, 14, regions=(5, 4), balance="static")
    host = RegionHost(machine, policy="runs")
    assert host.table.tolist() == runs_table(20, 3).tolist()
    assert read(machine, host.commands())[1] == host.table.tolist()
    host.counted(np.arange(60))
    assert host.commands() == []
    with pytest.raises(InputError, match=r"^balance: runs is for machines that count static"):
        RegionHost(MACHINE, policy="runs")
    listed = make_display_list("random:n=12,size=7,seed=1", width=20, height=14).display_list
    tables = RegionTables(machine, [listed] * 2, policy="runs")
    assert tables.sent(0).tolist() == host.table.tolist() and tables.sent(1) is None
    assert sent_table(machine) is None


def test_a_machine_that_makes_its_tables_of_counts_as_they_are():
    machine = MachineConfiguration("3x(PM)", 20, 14, regions=(5, 4), balancer="hardware")
    with pytest.raises(InputError, match=r"^balance: learnt is for a host"):
        RegionHost(machine, policy="learnt")
    host = RegionHost(machine)
    for number in range(4):
        counts = np.random.default_rng(number).integers(0, 100, 20)
        host.pack(counts)
        assert host.table.tolist() == packed_table(counts, 3, machine.slots).tolist()


@pytest.mark.parametrize(("fields", "owed"), [
    ({}, {Opcode.REGION: [], Opcode.READ_REGIONS: [ResponseKind.REGION_COUNT] * 24}),
    ({"balance": "static"}, {Opcode.REGION: []}),
    ({"balancer": "hardware"}, {Opcode.READ_REGIONS: [ResponseKind.REGION_COUNT] * 24,
                                Opcode.READ_TABLE: [ResponseKind.TABLE_ENTRY] * 20}),
    ({"regions": None, "slots": 0, "cards": "2x(PM)"}, {})], ids=str)
def test_what_is_owed(fields, owed):
    machine = MachineConfiguration(**{"cards": "3x(PM)", "width": 20, "height": 14,
                                      "regions": (5, 4), "slots": 8} | fields)
    organisation = organisation_of(machine)
    for opcode in (Opcode.REGION, Opcode.READ_REGIONS, Opcode.READ_TABLE):
        kinds = [(each.kind, each.value) for each in owed_to(organisation, int(opcode))]
        assert kinds == ([(kind, None) for kind in owed[opcode]] if opcode in owed else
                         [(ResponseKind.ERROR, Fault.UNKNOWN_COMMAND)])
    asked = [opcode_of(word) for word in region_readings(machine)]
    assert asked == [opcode for opcode in owed if opcode != Opcode.REGION]


def test_a_frame_with_a_table():
    listed = make_display_list("random:n=12,size=7,seed=1", width=20, height=14).display_list
    machine = MachineConfiguration("3x(PM)", 20, 14, regions=(5, 4))
    plain = frame_commands(machine, listed)
    table = static_table(20, 3)[::-1]
    words = frame_commands(machine, listed, table=table)
    assert words == [*table_commands(machine, table), *plain]
    job = frame_job(machine, listed, table=table)
    assert job.commands[:len(words)] == words
    assert [opcode_of(word) for word in job.commands[len(words):]] == [
        Opcode.READ_DEPTH, Opcode.READ_COUNTERS, Opcode.READ_REGIONS]
    assert job.responses == responses_owed(organisation_of(machine), job.commands)


def test_the_example_of_the_page():
    [example] = re.findall(r"^```python\n(.*?)^```", PAGE.read_text("utf-8"),
                           re.DOTALL | re.MULTILINE)
    exec(example, {})


def test_what_a_host_refuses():
    host = RegionHost(MACHINE_OF_HOST)
    owed = MACHINE_OF_HOST.processing_elements * MACHINE_OF_HOST.slots
    for answers in (0, owed - 1, owed + MACHINE_OF_HOST.slots):
        with pytest.raises(InputError, match=f"counts: {answers} answers to READ_REGIONS, the "
                           f"machine gives {owed}"):
            host.counted([0] * answers)
    for table, message in (([0, 1], "table: has the shape"), ([0, 1, 2, 3], "names none of the"),
                           ([1, 1, 1, 1], "more than its 3 slots")):
        host.table = np.array(table)
        with pytest.raises(InputError, match=message):
            host.commands()
    with pytest.raises(InputError, match="regions: the machine deals none out"):
        RegionHost(MachineConfiguration(cards="PM", width=8, height=8))


def test_a_table_that_is_changed_in_place_is_sent():
    host = RegionHost(MACHINE_OF_HOST)
    host.table[:2] = host.table[1::-1]
    assert len(host.commands()) == 4 and not host.commands()


#: Two elements, four regions, three slots each.
MACHINE_OF_HOST = MachineConfiguration(cards="2x(PM)", width=16, height=16, regions=(2, 2))
