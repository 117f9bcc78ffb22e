"""Sequences whose regions are dealt out anew for each picture, on a machine as golden has it."""

from dataclasses import replace

import numpy as np
import pytest
from golden_machine import GoldenMachine

from cardcage.golden.balancing.learnt_counts import learnt_counts
from cardcage.golden.organisations.region_table import packed_table, static_table
from cardcage.golden.planning.machine_plan import plan
from cardcage.golden.scene_display_list import make_display_list
from cardcage.golden.specification.commands import Opcode, ResponseKind, opcode_of
from cardcage.testbenches.engines import choose_engine
from cardcage.testbenches.frames.region_figures import golden_counts
from cardcage.testbenches.sequence.sequence_run import SequenceCommands, simulate_sequence

SIZE = {"width": 20, "height": 14}
LISTS = [make_display_list(f"random:n={n},size=7,seed={n}", **SIZE).display_list
         for n in (12, 40, 11, 30)]
LISTS[2] = replace(LISTS[2], position=LISTS[2].position[:0], depth=LISTS[2].depth[:0],
                   color=LISTS[2].color[:0])


def machine(**fields):
    return plan(LISTS, **{"cards": "3x(PM)", "clocks_per_pixel": 2, "regions": (5, 4), "slots": 8}
                | fields).configuration


@pytest.fixture
def frames_of(monkeypatch):
    def frames(configuration, change=lambda kind, number, value: value, **options):
        monkeypatch.setattr(choose_engine, "ENGINES",
                            {"golden": lambda: GoldenMachine(LISTS, change)})
        return list(simulate_sequence(configuration, LISTS, "golden", triangles=40, **options))

    return frames


@pytest.mark.parametrize("depths", ["last", "all"])
@pytest.mark.parametrize(("fields", "policy"), [
    ({"balance": "static"}, None), ({"balance": "triangles"}, None), ({}, None), ({}, "clocks"),
    ({"balancer": "hardware"}, None), ({"slots": 7}, "clocks"),
    ({"cards": "4x(PMM)", "regions": (3, 2), "slots": 2}, "learnt")], ids=str)
def test_every_picture_by_the_table_of_the_counts_before(frames_of, fields, policy, depths):
    configuration = machine(**fields)
    frames = frames_of(configuration, depths=depths, policy=policy)
    assert all(frame.equal and not frame.regions.differences for frame in frames)
    everything = SIZE["width"] * SIZE["height"]
    assert [frame.comparison.depths_compared for frame in frames] == (
        [everything if depths == "all" else 0] * 3 + [everything])
    regions, elements = configuration.dealt_regions.count, configuration.processing_elements
    learns = configuration.balancer == "host" and configuration.balance == "clocks" and (
        policy != "clocks")
    tables, seen = [static_table(regions, elements)], []
    for listed in LISTS:
        seen = [golden_counts(configuration, listed), *seen][:3]
        counts = (learnt_counts(seen, configuration.dealt_regions.columns)
                  if learns and len(seen) == 3 else seen[0])
        tables.append(tables[0] if configuration.balance == "static" else packed_table(
            counts, elements, configuration.slots))
    for frame, table, following in zip(frames, tables, tables[1:], strict=False):
        figures = frame.regions
        assert figures.policy == ("learnt" if learns else configuration.balance)
        assert figures.table.tolist() == table.tolist()
        assert figures.next_table.tolist() == following.tolist()
        assert (figures.slot_counts is None) == (configuration.balance == "static")
        assert (figures.read_table is None) == (configuration.balancer == "host")
        loads = [int(figures.counts[table == element].sum()) for element in range(elements)]
        assert figures.loads.tolist() == loads and figures.busiest == np.argmax(loads)
        assert figures.utilisation == (
            sum(loads) / (elements * max(loads)) if any(loads) else 1)


def test_a_table_is_sent_where_it_is_another():
    """Of an empty picture all regions weigh as much; then there is nothing new to be said."""
    def sent(configuration, lists):
        words = [opcode_of(word) for word in SequenceCommands(
            configuration, lists, "last", policy=configuration.balance)]
        starts = [place for place, opcode in enumerate(words) if opcode == Opcode.FRAME_START]
        return [words[place - 1] == Opcode.REGION for place in starts], words.count(Opcode.REGION)

    assert sent(machine(), LISTS) == ([False, True, True, True], 60)
    assert sent(machine(), [LISTS[2], LISTS[2], LISTS[0], LISTS[0], LISTS[0]]) == (
        [False, False, False, True, False], 20)
    assert sent(machine(balance="static"), LISTS) == ([False] * 4, 0)
    assert sent(machine(balancer="hardware"), LISTS) == ([False] * 4, 0)


@pytest.mark.parametrize(("kind", "place", "line"), [
    (ResponseKind.REGION_COUNT, 24 + 1, "processing element 0 counted 1000 clocks in slot 1"),
    (ResponseKind.REGION_COUNT, 48 + 7, "processing element 0 counted 1000 clocks in slot 7"),
    (ResponseKind.TABLE_ENTRY, 20 + 6, "region 6 goes to processing element 1000 next, golden "),
])
def test_every_count_and_every_entry(frames_of, kind, place, line):
    """Also of a slot without a region."""
    def wrong(found, number, value):
        return 1000 if (found, number) == (kind, place) else value

    frames = frames_of(machine(balancer="hardware"), wrong)
    different = [frame.regions.differences for frame in frames]
    of = 2 if place == 55 else 1
    assert [len(lines) for lines in different] == [number == of for number in range(4)]
    assert different[of][0].replace("1,000", "1000").startswith(line)


def test_depths_placed_by_another_table(frames_of, monkeypatch):
    """A read-back tells pixels apart by the table alone."""
    configuration = machine()
    frames = frames_of(configuration, depths="all")
    other = np.roll(frames[1].regions.table, 1)
    monkeypatch.setattr(
        "cardcage.testbenches.frames.region_figures.RegionTables.table",
        lambda self, number: other if number == 1 else frames[min(number, 3)].regions.table)
    monkeypatch.setattr(
        "cardcage.testbenches.frames.region_figures.RegionTables.sent",
        lambda self, number: frames[number].regions.table if number else None)
    wrong = frames_of(configuration, depths="all")
    assert [frame.equal for frame in wrong] == [True, False, True, True]
