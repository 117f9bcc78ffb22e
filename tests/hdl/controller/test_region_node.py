"""The controller where regions are dealt out: tables between frames, and every fault of one."""

import random
from itertools import pairwise

import pytest
from hdl_bench.cage import Run
from hdl_bench.pictures import small_machine
from hdl_bench.region_cage import MACHINES, RegionRun, machine, placed
from hdl_bench.region_tables import Tables, region_word, table_words

from cardcage.golden.organisations.region_table import runs_table, static_table
from cardcage.golden.specification import commands
from cardcage.golden.specification.commands import Fault, Opcode, ResponseKind
from cardcage.hdl.backplane.words import Operation

END, READ_REGIONS, READ_TABLE, DRAW, READ_DEPTH = (commands.command(opcode) for opcode in (
    Opcode.FRAME_END, Opcode.READ_REGIONS, Opcode.READ_TABLE, Opcode.PREPARED_TRIANGLE,
    Opcode.READ_DEPTH))
START = commands.frame_start((1, 2, 3))

def random_table(pick, configuration, elements=None):
    """One that fills slots to the last, now and then."""
    elements = configuration.processing_elements if elements is None else elements
    places = [element for element in range(elements) for _ in range(configuration.slots)]
    if pick.random() < 0.5:
        pick.shuffle(places)
    table = places[:configuration.dealt_regions.count]
    pick.shuffle(table)
    return table


def spoilt(pick, configuration, words):
    """A table with something wrong in it, mostly."""
    regions, words = configuration.dealt_regions, list(words)
    place, kind = pick.randrange(len(words)), pick.randrange(7)
    if kind == 0:
        del words[place]
    elif kind == 1:
        words.insert(place, words[pick.randrange(len(words))])
    elif kind == 2:
        words[place] = region_word(configuration, place, configuration.processing_elements)
    elif kind == 3:
        words[place:] = [region_word(configuration, number, 0)
                         for number in range(place, len(words))]
    elif kind == 4:
        del words[place:]
    elif kind == 5:
        words[place] = region_word(configuration, (pick.randrange(2 * regions.columns),
                                                   pick.randrange(2 * regions.rows)), 0)
    else:
        words.insert(place, pick.choice((READ_DEPTH, READ_REGIONS, DRAW, 15)))
    return words


def random_words(pick, configuration, frames):
    words = []
    for _ in range(frames):
        for _ in range(pick.choice((0, 1, 1, 1, 2))):
            table = table_words(configuration, random_table(pick, configuration))
            words += table if pick.random() < 0.5 else spoilt(pick, configuration, table)
        frame = [START, *[DRAW] * pick.choice((0, 1, 5)), END]
        if pick.random() < 0.3:  # abandoned
            frame[-1:] = [START, DRAW, END]
        if pick.random() < 0.3:  # tables that come too late
            place = pick.randrange(1, len(frame))
            frame[place:place] = table_words(configuration, random_table(pick, configuration))[
                pick.randrange(2):]
        if pick.random() < 0.1:  # never begun
            frame = [END]
        words += frame + [READ_REGIONS] * (pick.random() < 0.3)
    return words


def expected_of(configuration, words):
    """Kinds and faults that are answered, and the table of each frame that starts."""
    tables, answers, used = Tables(configuration), [], []
    counts = configuration.processing_elements * configuration.slots
    for word in words:
        fault, opcode = tables.take(word), commands.opcode_of(word)
        if fault is not None:
            answers.append((ResponseKind.ERROR, fault))
        answers += {
            Opcode.FRAME_END: [(ResponseKind.FRAME_DRAWN, None), (ResponseKind.FRAME_SHOWN, None)],
            Opcode.READ_REGIONS: [(ResponseKind.REGION_COUNT, count) for count in range(counts)],
            Opcode.READ_DEPTH: [(ResponseKind.DEPTH, None)] * 3,
            15: [(ResponseKind.ERROR, Fault.UNKNOWN_COMMAND)],
        }.get(opcode, [])
        if opcode == Opcode.FRAME_START:
            used.append(placed(tables.used))
    return answers, used


def check(run, configuration, words):
    """Every answer, the table of every frame, and that no picture loses its own."""
    answers, used = expected_of(configuration, words)
    assert [(kind, value if owed is not None else None) for (kind, value), (_, owed)
            in zip(run.answers, answers, strict=True)] == answers
    starts = [clock for clock, operation, _ in run.cage.packets
              if operation == Operation.FRAME_START]
    assert len(starts) == len(used)
    # From the clock after a frame's start is broadcast, to that of the next one.
    for start, end, table in zip(starts, [*starts[1:], len(run.lines.drawn) - 1], used,
                                 strict=True):
        assert set(run.lines.drawn[start + 1:end + 1]) == {table}
    # A picture is shown by the table that it was drawn by, in every clock.
    swaps = [*run.scans.swaps, len(run.lines.shown) - 1]
    for swap, end in pairwise(swaps):
        begun = [number for number, start in enumerate(starts) if start < swap]
        table = used[begun[-1]] if begun else placed(Tables(configuration).used)
        assert set(run.lines.shown[swap + 1:end + 1]) == {table}
    # Front and table change in one clock, or the table stays.
    changes = {clock for clock, (before, after) in enumerate(zip(
        run.lines.banks, run.lines.banks[1:], strict=False)) if before[1] != after[1]}
    assert changes <= set(swaps)


@pytest.mark.parametrize("name", MACHINES)
def test_boot(name):
    """Regions are dealt out in turn before the boot is over; whoever has few words waits for it."""
    configuration = machine(name)
    elements = configuration.processing_elements
    run = RegionRun(configuration, [START, END], elements + 5, depth=1)
    assert [kind for kind, _ in run.responses] == [
        *[ResponseKind.DOMAIN] * elements, ResponseKind.UNITS, ResponseKind.PICTURE,
        ResponseKind.BOOTED, ResponseKind.FRAME_DRAWN, ResponseKind.FRAME_SHOWN]
    booted = run.clock_of(ResponseKind.BOOTED)
    static = placed(static_table(configuration.dealt_regions.count, elements))
    assert set(run.lines.drawn[booted:]) == {static}
    [began] = run.units.initialised
    assert dict(run.responses)[ResponseKind.BOOTED] == began + max(
        2, configuration.dealt_regions.count + 2)


@pytest.mark.parametrize("elements", [None, 1])
@pytest.mark.parametrize(("name", "cards"), [
    ("three", "3x(PMM)"), ("four, full", "8x(PM)"), ("one slot", "5x(PM)"), ("a row", "3x(PMM)"),
    ("one element", "PMM"), ("one region", "2x(PMM)")])
def test_boot_of_elements_that_pass_objects_on(name, cards, elements):
    """Each has a run of regions, some none, however many there are; no later table is heard."""
    configuration = machine(name, cards=cards, slots=0, objects="elements", mesh_triangles=4,
                            meshes=2, setup="hardware", balance="static", order_bits=2)
    if elements is None or elements * configuration.slots < configuration.dealt_regions.count:
        elements = configuration.processing_elements
    run = RegionRun(configuration, [region_word(configuration, 0, 0), START, END], elements + 6,
                    elements=elements)
    booted = run.clock_of(ResponseKind.BOOTED)
    runs = placed(runs_table(configuration.dealt_regions.count, elements))
    assert set(run.lines.drawn[booted:]) == {runs}
    assert run.answers[0] == (ResponseKind.ERROR, Fault.UNKNOWN_COMMAND)


@pytest.mark.parametrize("name", MACHINES)
@pytest.mark.parametrize("seed", [None, 0])
def test_tables_between_frames(name, seed):
    """Good ones, and ones with something wrong; frames that are abandoned, and late."""
    pick = random.Random(f"{name} {seed}")
    configuration = machine(name)
    words = random_words(pick, configuration, 12)
    answers, _ = expected_of(configuration, words)
    run = RegionRun(configuration, words, configuration.processing_elements + 3 + len(answers),
                    seed=seed, work=0 if seed is None else 20, period=pick.choice((30, 90)))
    check(run, configuration, words)


def test_random_words_have_every_fault():
    """Or else the test before this one would not test them."""
    found = set()
    for name in MACHINES:
        for seed in (None, 0):
            pick = random.Random(f"{name} {seed}")
            answers, _ = expected_of(machine(name), random_words(pick, machine(name), 12))
            found |= {value for kind, value in answers if kind == ResponseKind.ERROR}
    assert found == {Fault.UNKNOWN_COMMAND, Fault.REGION_TO_NOBODY, Fault.REGION_TWICE,
                     Fault.NO_SLOT, Fault.TABLE_LATE}


GOOD = [2, 1, 0, 0, 1, 2, 2, 1]
OTHER = [0, 0, 1, 1, 2, 2, 0, 1]


def table(*elements):
    return table_words(machine("three"), elements)


def region(place, element):
    return [region_word(machine("three"), place, element)]


#: Words of a machine of 4 x 2 regions with room for four in each of three elements; what is
#: answered, and the table that the frame after them is drawn by.
CASES = {
    "whole": (table(*GOOD), [], GOOD),
    "the later of two": ([*table(*GOOD), *table(*OTHER)], [], OTHER),
    "begun anew": ([*table(*GOOD)[:5], *table(*OTHER)], [], OTHER),
    "none": ([], [], None),
    "unfinished": (table(*GOOD)[:7], [Fault.REGION_TO_NOBODY], None),
    "begun over a whole one": ([*table(*GOOD), *table(*OTHER)[:1]], [Fault.REGION_TO_NOBODY], None),
    "left out": ([*table(*GOOD)[:3], *table(*GOOD)[4:]], [Fault.REGION_TO_NOBODY], None),
    "first left out": (table(*GOOD)[1:], [Fault.REGION_TO_NOBODY], None),
    "no such element": (table(2, 1, 3, 0, 1, 2, 2, 1), [Fault.REGION_TO_NOBODY], None),
    "no such region": ([*table(*GOOD)[:4], *region((4, 0), 0)], [Fault.REGION_TWICE], None),
    "no such row": ([*table(*GOOD)[:4], *region((0, 3), 0)], [Fault.REGION_TO_NOBODY], None),
    "twice": ([*table(*GOOD)[:3], *table(*GOOD)[2:]], [Fault.REGION_TWICE], None),
    "twice, after all": ([*table(*GOOD), *region(7, 0)], [Fault.REGION_TWICE], None),
    "no slot": (table(0, 0, 0, 0, 0, 1, 1, 1), [Fault.NO_SLOT], None),
    "slots to the last": (table(0, 0, 0, 0, 1, 1, 1, 1), [], [0] * 4 + [1] * 4),
    "one of a table": (table(0, 3, 3, 3, 0, 0, 0, 0), [Fault.REGION_TO_NOBODY], None),
    "wrong, then good": ([*table(3, 0), *table(*GOOD)], [Fault.REGION_TO_NOBODY], GOOD),
    "too late": ([START, *table(*GOOD)], [Fault.TABLE_LATE], None),
    "too late, then in time": ([START, *table(*GOOD), END, *table(*OTHER)],
                               [Fault.TABLE_LATE, None, None], OTHER),
    "partly too late": ([START, *table(*GOOD)[:3], END, *table(*GOOD)[3:]],
                        [Fault.TABLE_LATE, None, None], None),
    "twice too late": ([START, *table(*GOOD), *table(*GOOD)], [Fault.TABLE_LATE] * 2, None),
    "none, in between a good one": ([*table(*GOOD), START, END, *table(*OTHER)[:2]],
                                    [None, None, Fault.REGION_TO_NOBODY], GOOD),
}


@pytest.mark.parametrize("name", CASES)
@pytest.mark.parametrize("seed", [None, 1])
def test_what_is_wrong_with_a_table(name, seed):
    configuration = machine("three", slots=4)
    words, faults, used = CASES[name]
    words = [*words, START, DRAW, END]
    run = RegionRun(configuration, words, 6 + len(faults) + 2, seed=seed, work=9)
    kinds = [value if kind == ResponseKind.ERROR else None for kind, value in run.answers]
    assert kinds == [*faults, None, None]
    last = placed(static_table(8, 3) if used is None else used)
    assert run.lines.drawn[-1] == run.lines.shown[-1] == last
    check(run, configuration, words)


def test_a_region_a_clock():
    configuration = machine("three")
    run = RegionRun(configuration, table(*GOOD), 6)
    taken = run.source.taken
    assert taken == list(range(taken[0], taken[0] + len(GOOD)))


def test_a_late_picture_leaves_the_old_one_with_its_table():
    """Scan after scan."""
    configuration = machine("three")
    words = [*table(*GOOD), START, DRAW, END, *table(*OTHER), START, *[DRAW] * 9, END]
    run = RegionRun(configuration, words, 6 + 4, seed=3, work=60, period=30)
    first, second = run.scans.swaps
    assert [value for kind, value in run.answers if kind == ResponseKind.FRAME_SHOWN][1] > 2
    assert set(run.lines.shown[first + 1:second + 1]) == {placed(GOOD)}
    assert set(run.lines.shown[second + 1:]) == {placed(OTHER)}
    # The other one was drawn by long before.
    assert placed(OTHER) in run.lines.drawn[first:second - 60]


@pytest.mark.parametrize(("name", "elements", "draws"), [
    ("three", 2, True), ("three", 1, False), ("four, full", 3, False), ("one element", 1, True)])
def test_a_cage_without_some_boards(name, elements, draws):
    """It draws while it has room for all regions, and deals them to those that are there."""
    configuration = machine(name, **({"slots": 4} if name == "three" else {}))
    count = configuration.dealt_regions.count
    run = RegionRun(configuration, [START, END], elements + (5 if draws else 4), elements=elements)
    if draws:
        assert run.lines.drawn[-1] == placed(static_table(count, elements))
        return
    fault = (ResponseKind.ERROR, Fault.UNITS_UNSUPPORTED)
    assert run.responses[elements + 1:] == [fault] * 3
    assert run.lines.drawn[-1] is None


@pytest.mark.parametrize("domains", [[(0, 2), (2, 1), (3, 1)], [(0, 1), (1, 3)], [(2, 2), (4, 2)],
                                     [(0, 2), (2, 2), (4, 0)], [(0, 4), (4, 2)]])
def test_other_shares_than_those_that_regions_lie_in_are_refused(domains):
    configuration = machine("three", slots=8)
    total = domains[-1][0] + domains[-1][1]
    run = Run(configuration, [START], len(domains) + 3, total=total, domains=domains)
    assert run.responses[-2:] == [(ResponseKind.ERROR, Fault.UNITS_UNSUPPORTED)] * 2


@pytest.mark.parametrize(("changes", "unknown"), [
    ({"balance": "static"}, [READ_REGIONS, READ_TABLE]),
    ({"balance": "triangles"}, [READ_TABLE]), ({}, [READ_TABLE])])
def test_what_a_machine_does_not_have(changes, unknown):
    configuration = machine("three", **changes)
    words = [READ_REGIONS, READ_TABLE]
    known = [word for word in words if word not in unknown]
    run = RegionRun(configuration, words,
                    6 + len(unknown) + len(known) * 3 * configuration.slots)
    errors = [answer for answer in run.answers if answer[0] == ResponseKind.ERROR]
    assert errors == [(ResponseKind.ERROR, Fault.UNKNOWN_COMMAND)] * len(unknown)


@pytest.mark.parametrize("opcode", [Opcode.REGION, Opcode.READ_REGIONS, Opcode.READ_TABLE])
def test_machines_without_regions_know_none_of_it(opcode):
    run = Run(small_machine("PM"), [commands.command(opcode)], 5)
    assert run.responses[4:] == [(ResponseKind.ERROR, Fault.UNKNOWN_COMMAND)]
