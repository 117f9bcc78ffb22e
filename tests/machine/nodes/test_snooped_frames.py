"""Nodes that merge on a bus: frames that overlap, and how many clocks merging takes."""

from dataclasses import replace

import numpy as np
import pytest
from frame_paces import cycles_of, pace, screens, values_of
from frames import expected_video, golden_picture, random_list
from node_frames import (
    CLEAR_LISTS,
    READ_COUNTERS,
    READ_DEPTH,
    all_tied,
    check_merged,
    compiled,
    frames,
    immediate,
    loads,
    model,
    redrawn,
    run,
)
from suite.cases import EVERY, chosen
from wide_machines import wide_machine

from cardcage.golden.merging.cage import merge_cage
from cardcage.golden.organisations.organisation_of import organisation_of
from cardcage.golden.specification.commands import ResponseKind
from cardcage.testbenches.frames.responses import Answers

BUSES = chosen(("bus of four, vertices", "bus of three, two ports", "bus of two of two elements"),
               "bus of four, vertices")


def seen(machine, lists, answered):
    """Which of the pictures of ``lists``, all of them different, each scan shows, from the first on
    that shows one."""
    videos = [expected_video(machine, golden_picture(machine, listed).color) for listed in lists]
    found = [next((number for number, video in enumerate(videos)
                   if (video == scan.picture).all()), None) for scan in answered.scans]
    shown = [scan.cycle for scan in answered.scans]
    first = cycles_of(answered, ResponseKind.FRAME_SHOWN)[0]
    return [number for number, cycle in zip(found, shown, strict=True) if cycle > first]


def sequence(machine, lists, retained):
    """Frames one after the other, without a word in between."""
    if retained:
        return [word for listed in lists
                for word in [CLEAR_LISTS, *loads(machine, listed), *redrawn(machine, listed)]]
    return [word for listed in lists for word in immediate(machine, listed)]


@pytest.mark.parametrize("stall_seed", [None, 1, 2])
@pytest.mark.parametrize("retained", [False, True])
@pytest.mark.parametrize("name", BUSES)
def test_frames_that_overlap(name, retained, stall_seed):
    """The next one is drawn while the last one is merged; every picture is seen, whole and in
    order, past the last tag, and the last one has its depths and counters."""
    machine, listed = model(name)
    machine = replace(machine, tag_bits=3)
    flat = machine.shading == "flat"
    lists = [random_list((seed, 9), 3 + 11 * (seed % 3), width=machine.width,
                         height=machine.height, flat=flat) for seed in range(19)]
    lists[4] = all_tied(12, 4, width=machine.width, height=machine.height)
    lists.append(listed)
    words = [*sequence(machine, lists, retained), READ_DEPTH, READ_COUNTERS]
    answered = run(machine, words, compiled(), memory_seed=7, stall_seed=stall_seed)
    pictures = seen(machine, lists, answered)
    assert None not in pictures
    assert pictures == sorted(pictures) and set(pictures) == set(range(len(lists)))
    last = Answers(machine, answered).frame(len(lists) - 1, reading=0, read_back=0)
    check_merged(machine, listed, last)
    if stall_seed is None and not retained:  # they do overlap
        drawn, merged = (cycles_of(answered, kind) for kind in (ResponseKind.FRAME_DRAWN,
                                                                ResponseKind.MERGED))
        assert any(drawn[number + 1] < shown for number, shown in enumerate(merged[:-1]))


def bar(machine, pixels):
    """Clocks in which ``pixels`` in all have to be merged, of units with two ports."""
    return 1.05 * pixels + machine.nodes * (machine.words / 4096 + 64)


@pytest.mark.parametrize("cards", chosen(
    ["3x(PMS)FF", "2x(PMMPMMS)FF", "8x(PMS)F"], "3x(PMS)FF"))
def test_a_pixel_a_clock_and_little_else(cards, record_property):
    """Whatever is hidden: nearly all, so that only node 0 sends, or nothing, so that all do."""
    lists, machine = [], wide_machine(random_list(0, 4, width=16, height=16), cards=cards,
                                      clocks_per_pixel=2, memory_ports=2, fraction_bits=40)
    for depths in ("rising", "falling"):
        lists.append(screens(machine, machine.nodes, 1, depths))
    lists += [random_list(seed, 20, width=16, height=16) for seed in range(3)]
    words = [word for listed in lists for word in [*immediate(machine, listed), READ_COUNTERS]]
    answered = run(machine, words, compiled())
    clocks = np.subtract(values_of(answered, ResponseKind.MERGED),
                         values_of(answered, ResponseKind.FRAME_DRAWN))
    traffic = [merge_cage(machine, listed)[1] for listed in lists]
    assert [traffic[0].pixels, traffic[1].pixels] == [256, 256 * machine.nodes]
    for sent, taken in zip(traffic, clocks.tolist(), strict=True):
        assert sent.pixels < taken <= bar(machine, sent.pixels)
        assert taken <= sent.pixels + machine.nodes * 22 + 8
    most = max(taken - sent.pixels for sent, taken in zip(traffic, clocks.tolist(), strict=True))
    record_property("measured", f"{cards}: {traffic[1].pixels} pixels merged in {clocks[1]} "
                    f"clocks, at most {most} more than pixels sent")


@pytest.mark.parametrize("name", BUSES)
def test_depths_are_those_of_the_picture_drawn_last(name):
    """Of a frame that is not ended yet, and of one that is shown."""
    machine, listed = model(name)
    flat = machine.shading == "flat"
    other = random_list(77, 12, width=machine.width, height=machine.height, flat=flat)
    begun = immediate(machine, other)
    words = [*immediate(machine, listed), READ_DEPTH, *begun[:-1], READ_DEPTH, begun[-1],
             READ_DEPTH, READ_DEPTH]
    answered = run(machine, words, compiled(), memory_seed=4, stall_seed=2)
    organisation = organisation_of(machine)
    depths = np.array(values_of(answered, ResponseKind.DEPTH)).reshape(
        4, organisation.depths_read_back)
    for read, drawn in zip(depths, (listed, other, other, other), strict=True):
        np.testing.assert_array_equal(organisation.depth_image(read),
                                      golden_picture(machine, drawn).depth)


#: Nodes that interlace in other ways than frame units do, and coarser ones.
OTHERS = {
    "skewed": ("2x(PMMS)F", {"skew": True, "memory_ports": 2}),
    "in squares": ("2x(PMMPMMS)FFFF", {"block": 4, "memory_ports": 2}),
    "words for a quarter": ("PMMSF", {"words": 20}),
}


@pytest.mark.parametrize("name", chosen(OTHERS))
def test_other_cages(name):
    cards, options = OTHERS[name]
    listed = random_list(5, 14, width=13, height=7)
    machine = wide_machine(listed, cards=cards, clocks_per_pixel=2, fraction_bits=36, order_bits=4,
                           **options)
    lists = [listed, all_tied(9, 2, width=13, height=7)]
    frames(machine, [(immediate(machine, each), machine, each) for each in lists], compiled(),
           stall_seed=1)


#: Cages, lists, and what a frame takes as long as.
PACES = {
    "drawing": ("2x(PMS)FF", 2, 60, "rising"),
    "merging": ("8x(PMS)F", 2, 8, "falling"),
    "a scan": ("2x(PMMPMMS)FF", 8, 2, "rising"),
}


@pytest.mark.parametrize(("bound", "retained"), [
    ("drawing", True), pytest.param("drawing", False, marks=EVERY),
    pytest.param("merging", False, marks=EVERY), pytest.param("a scan", True, marks=EVERY)])
def test_a_frame_takes_what_takes_longest(bound, retained, record_property):
    """Drawing, merging, or whole scans, of which each picture waits for one: from the second
    merged picture on to the last one, within a twentieth."""
    cards, clocks, count, depths = PACES[bound]
    size = {"width": 16, "height": 16}
    machine = wide_machine(random_list(0, 4, **size), cards=cards, clocks_per_pixel=clocks,
                           memory_ports=2, fraction_bits=40, packet=1,
                           list_words=64 if retained else 0)
    found = pace(machine, screens(machine, count, 2, depths), retained=retained)
    record_property("measured", f"{cards}{', lists' * retained}: {found}")
    assert found.frame <= 1.05 * max(found.draw, found.merge) or found.frame == found.scans
    assert found.bound == bound
