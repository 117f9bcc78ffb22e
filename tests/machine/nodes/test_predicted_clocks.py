"""What nodes on a bus take to merge, and elements that share all units to draw: by the machine and
by the cycle model, whose traffic is the machine's to the pixel."""

from __future__ import annotations

import pytest
from frame_paces import first_line
from node_frames import (
    CLEAR_LISTS,
    READ_COUNTERS,
    READ_DEPTH,
    check_merged,
    compiled,
    frames,
    immediate,
    loads,
    redrawn,
    run,
)
from suite.cases import chosen
from wide_machines import wide_machine

from cardcage.golden.cycles.cycle_model import predict_cycles
from cardcage.golden.cycles.merge_clocks import predict_merge
from cardcage.golden.merging.cage import merge_cage
from cardcage.golden.scene_display_list import make_display_list
from cardcage.golden.specification.commands import ResponseKind
from cardcage.testbenches.frames.responses import Answers

#: Of the clocks to merge, or to draw.
ACCURACY = 0.02

BUSES = {
    "units with one port": ("4x(PMMS)FF", {"memory_ports": 1}),
    "a run of the list for each of five": ("5x(PMS)F", {"memory_ports": 2,
                                                        "packet": "contiguous"}),
}

CROSSBARS = {
    "four for two": ("4xP D 2xM", {"memory_ports": 2, "queue": 2}),
    "one queue for each element": ("3xP D 4xM", {"memory_ports": 2, "queue": "element",
                                                 "packet": "contiguous"}),
}

#: Crossbars before units with one port, where the model is told where the scan is.
SCANNED = {
    "one of each, half of whose clocks are the scan's": ("PDM", {}),
    "four for four, one queue for each element": ("4xP D 4xM", {"queue": "element"}),
    "a coarser picture": ("3xP D 4xM", {"words": 256, "queue": 2}),
}


def scenes():
    """Of few large triangles and many small ones by turns."""
    for seed, (n, size) in enumerate(((500, 8), (120, 24), (150, 12))):
        yield make_display_list(f"random:n={n},size={size},seed={seed}", width=64,
                                height=64).display_list


def machine_of(cards, listed, **options):
    return wide_machine(listed, cards=cards, fraction_bits=44, order_bits=14,
                        **{"clocks_per_pixel": 2} | options)


def accuracy(predicted, clocks):
    print(f"{clocks} clocks, predicted {predicted:.0f}, {predicted / clocks - 1:+.2%}")
    return abs(predicted / clocks - 1)


@pytest.mark.parametrize("cage", chosen(BUSES, "units with one port"))
def test_a_merge_on_a_bus(cage, record_property):
    cards, options = BUSES[cage]
    lists = list(scenes())
    machine = machine_of(cards, lists[0], **options)
    drawn = frames(machine, [(immediate(machine, listed), machine, listed) for listed in lists],
                   compiled())
    errors = []
    for simulation, listed in zip(drawn, lists, strict=True):
        clocks = simulation.merge_cycles - simulation.draw_cycles
        pixels = merge_cage(machine, listed)[1].pixels
        assert clocks <= 1.05 * pixels + machine.nodes * (machine.words / 4096 + 64)
        errors.append(accuracy(predict_merge(machine, listed), clocks))
    record_property("measured", f"{cards}, {cage}: merges on a bus are predicted within "
                                f"{max(errors):.1%}")
    assert max(errors) <= ACCURACY


@pytest.mark.parametrize("cage", chosen(CROSSBARS, "one queue for each element"))
def test_drawing_through_a_crossbar(cage, record_property):
    cards, options = CROSSBARS[cage]
    lists = list(scenes())
    machine = machine_of(cards, lists[0], list_words=500, **options)
    ways = [(retained, listed) for listed in lists for retained in (False, True)]
    drawn = frames(machine, [
        ([CLEAR_LISTS, *loads(machine, listed), *redrawn(machine, listed)] if retained
         else immediate(machine, listed), machine, listed) for retained, listed in ways],
        compiled())
    errors = []
    for simulation, (retained, listed) in zip(drawn, ways, strict=True):
        assert list(simulation.taken) == merge_cage(machine, listed)[1].taken.sum(axis=0).tolist()
        predicted = predict_cycles(machine, listed, retained=retained).cycles
        errors.append(accuracy(predicted, simulation.draw_cycles))
        assert simulation.merge_cycles == simulation.draw_cycles
    record_property("measured", f"{cards}, {cage}: drawing through a crossbar is predicted within "
                                f"{max(errors):.1%}")
    assert max(errors) <= ACCURACY


def frame_words(machine, listed, retained):
    return ([CLEAR_LISTS, *loads(machine, listed), *redrawn(machine, listed)] if retained
            else immediate(machine, listed))


@pytest.mark.parametrize("cage", chosen(SCANNED, "a coarser picture"))
def test_drawing_into_units_that_the_scan_reads(cage, record_property):
    """Wherever the scan is as a frame begins: right after the last one was shown, in blanking, or
    some lines further."""
    cards, options = SCANNED[cage]
    *_, many = lists = [*scenes()][1:]
    lists.append(many.chosen(range(40)))
    machine = machine_of(cards, many, list_words=200, memory_ports=1, **options)
    # Depths that are read between frames put the next one off.
    ways = [(retained, asks, listed) for listed in lists
            for retained, asks in ((False, []), (True, [READ_DEPTH]), (False, [READ_DEPTH] * 2))]
    words = [word for retained, asks, listed in ways
             for word in [*asks, *frame_words(machine, listed, retained)]]
    answered = run(machine, [*words, READ_DEPTH, READ_COUNTERS], compiled())
    last = Answers(machine, answered).frame(
        len(ways) - 1, reading=sum(asks.count(READ_COUNTERS) for _, asks, _ in ways),
        read_back=sum(asks.count(READ_DEPTH) for _, asks, _ in ways))
    check_merged(machine, lists[-1], last)
    drawn = [(clocks, cycle) for kind, clocks, cycle in answered.responses
             if kind == ResponseKind.FRAME_DRAWN]
    errors, begins = [], []
    for (clocks, cycle), (retained, _, listed) in zip(drawn, ways, strict=True):
        begins.append((cycle - clocks - first_line(machine)) % machine.cycles_per_scan)
        predicted = predict_cycles(machine, listed, retained=retained, begin=begins[-1]).cycles
        errors.append(accuracy(predicted, clocks))
    assert len(set(begins)) > 2
    record_property("measured", f"{cards}, {cage}: drawing into units with one port is predicted "
                                f"within {max(errors):.1%}")
    assert max(errors) <= ACCURACY
