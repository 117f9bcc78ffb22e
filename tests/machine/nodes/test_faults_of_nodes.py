"""Lists that are too long, cages that are refused, and what is asked before there is a picture."""

from dataclasses import replace

import numpy as np
import pytest
from frames import SCREEN, random_list, triangles
from node_frames import (
    CLEAR_LISTS,
    DRAW_LISTS,
    NAMES,
    READ_COUNTERS,
    READ_DEPTH,
    check_merged,
    compiled,
    immediate,
    loads,
    model,
    pictures,
    redrawn,
    run,
    sent_by_node,
)
from suite.cases import EVERY
from wide_machines import wide_machine

from cardcage.golden.merging.cage import merge_cage
from cardcage.golden.organisations.organisation_of import organisation_of
from cardcage.golden.specification.commands import Fault, ResponseKind, response_fields
from cardcage.testbenches.engines.engine import Job
from cardcage.testbenches.engines.pysim_engine import PysimEngine
from cardcage.testbenches.frames.conversation import owed_at_boot, owed_to, responses_owed
from cardcage.testbenches.frames.responses import Answers
from cardcage.testbenches.frames.simulation import simulate


def values(answered, kind):
    return [value for found, value, _ in answered.responses if found == kind]


def whole_screens(count, width, height):
    """Triangles of which set-up drops none, ever nearer."""
    color = np.random.default_rng(count).integers(0, 256, (count, 1, 3)).repeat(3, axis=1)
    return triangles(np.array([SCREEN] * count) * [width / 8, height / 8],
                     [[4000 - place] * 3 for place in range(count)], color, width=width,
                     height=height)


@pytest.mark.parametrize("name", NAMES)
@pytest.mark.parametrize("stall_seed", [None, 2])
def test_a_list_that_is_too_long(name, stall_seed):
    """A fault and nothing drawn, not even by nodes whose lists had room; once it is cleared, a
    list that just fits."""
    machine, _ = model(name)
    room = machine.list_words
    # One more for node 0 than there is room for; all others have less.
    count = room * machine.nodes + 1
    visible = whole_screens(count, machine.width, machine.height)
    ample = replace(machine, list_words=room + 1)
    fits = visible.chosen(np.arange(count - 1))
    words = [CLEAR_LISTS, *loads(ample, visible), *redrawn(machine, visible), READ_DEPTH,
             READ_COUNTERS, DRAW_LISTS, CLEAR_LISTS, *loads(machine, fits),
             *redrawn(machine, fits), READ_DEPTH, READ_COUNTERS]
    organisation = organisation_of(machine)
    answered = compiled().run(Job(
        machine, words, responses_owed(organisation, words) + 2, memory_seed=1,
        stall_seed=stall_seed, maximum_cycles=400 * machine.cycles_per_scan + 400 * count))
    assert values(answered, ResponseKind.ERROR) == [Fault.LIST_FULL] * 2
    kinds = [kind for kind, *_ in answered.responses]
    assert kinds.index(ResponseKind.ERROR) < kinds.index(ResponseKind.FRAME_DRAWN)
    elements = machine.processing_elements
    assert values(answered, ResponseKind.FRAGMENTS)[:elements] == [0] * elements
    depths = organisation.depths_read_back
    assert values(answered, ResponseKind.DEPTH)[:depths] == [machine.depth_background] * depths
    answers = Answers(machine, replace(answered, responses=[
        response for response in answered.responses if response[0] != ResponseKind.ERROR]))
    check_merged(machine, fits, answers.frame(1, reading=1))


@pytest.mark.parametrize("name", NAMES)
def test_depths_before_any_frame(name):
    """Background, from memory that is random at power-on; then a frame as ever."""
    machine, listed = model(name)
    words = [READ_DEPTH, READ_COUNTERS, *immediate(machine, listed), READ_DEPTH, READ_COUNTERS]
    answered = run(machine, words, compiled())
    depths = organisation_of(machine).depths_read_back
    assert values(answered, ResponseKind.DEPTH)[:depths] == [machine.depth_background] * depths
    later = replace(answered, responses=[
        response for place, response in enumerate(answered.responses)
        if response[0] != ResponseKind.DEPTH or sum(
            kind == ResponseKind.DEPTH for kind, *_ in answered.responses[:place]) >= depths])
    check_merged(machine, listed, Answers(machine, later).frame(0, reading=1))


@pytest.mark.parametrize("name", NAMES)
def test_what_was_sent_is_known_as_soon_as_the_picture_is_shown(name):
    """Of a first picture too, and of one that is empty."""
    machine, listed = model(name)
    empty = pictures(machine.width, machine.height)["nothing"]
    for lists in ([listed, empty], [empty, listed]):
        words = [word for each in lists for word in [*immediate(machine, each), READ_COUNTERS]]
        sent = values(run(machine, words, compiled()), ResponseKind.SENT)
        assert sent == [pixels for each in lists for pixels in sent_by_node(
            machine, merge_cage(machine, each)[1])]


LIST = random_list(11, 8)


def cage(cards, **options):
    """Boards for up to 4 units in a node, of 16 words, and up to 5 nodes."""
    return wide_machine(LIST, cards=cards, words=16, maximum_units=4, maximum_nodes=5,
                        clocks_per_pixel=2, allow_orphans=True, **options)


@pytest.mark.parametrize(("cards", "nodes", "fault"), [
    ("PMMMMC PMMC", [4, 2], Fault.NODES_DIFFER),
    pytest.param("PMMMT PMMT", [3, 2], Fault.UNITS_UNSUPPORTED, marks=EVERY),
    ("PMMC PC PMMC", [2, 0, 2], Fault.UNITS_UNSUPPORTED),
    pytest.param("PMMS PMMS FFF", [2, 2], Fault.UNITS_UNSUPPORTED, marks=EVERY),
    ("PMMS PMS FFF", [2, 1], Fault.UNITS_UNSUPPORTED),
    ("PPDMMM", [3, 3], Fault.UNITS_UNSUPPORTED),
])
def test_boards_pulled_out_of_one_node_only(cards, nodes, fault):
    """The cage is refused: it says so at boot and to every command, and does not hang."""
    machine = cage(cards, fraction_bits=20)
    organisation = organisation_of(machine)
    assert organisation.fault == fault
    words = [*range(1, 10)]
    owed = [*owed_at_boot(organisation), *(one for word in words for one in owed_to(
        organisation, word))]
    answered = PysimEngine().run(Job(machine, words, len(owed), memory_seed=2,
                                     maximum_cycles=4000))
    assert [kind for kind, *_ in answered.responses] == [one.kind for one in owed]
    assert values(answered, ResponseKind.ERROR) == [fault] * (1 + len(words))
    reports = [response_fields(ResponseKind.NODE, value)
               for value in values(answered, ResponseKind.NODE)]
    assert reports == [{"units": units, "node": node} for node, units in enumerate(nodes)]
    for (kind, value, _), one in zip(answered.responses, owed, strict=True):
        assert one.value in (None, value), kind


@pytest.mark.parametrize(("cards", "resolution"), [
    ("PMMMMC PMMMMC", (8, 8)),  # of five nodes
    pytest.param("PMMT PPMMT PMMPT", (8, 4), marks=EVERY),  # and two units of each
    pytest.param("PMMS PPMMS PMMPS FF", (8, 4), marks=EVERY),
    pytest.param("PMS PMS PMS FFFF", (4, 4), marks=EVERY),
    ("PPPDMM", (8, 4)),
])
def test_whole_nodes_pulled_out(cards, resolution):
    """Those that are left are numbered anew and draw all."""
    machine = cage(cards)
    simulation = simulate(machine, LIST, PysimEngine(), memory_seed=5)
    check_merged(machine, LIST, simulation)
    assert simulation.resolution == resolution
    assert simulation.total == machine.cards.count("M") == simulation.owned
