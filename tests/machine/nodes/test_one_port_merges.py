"""What a tree of nodes of one-port units takes to merge, by the machine and by the cycle model."""

from __future__ import annotations

import pytest
from frame_paces import first_line
from suite.cases import chosen
from wide_machines import wide_machine

from cardcage.golden.cycles.merge_clocks import predict_merge
from cardcage.golden.merging.cage import merge_cage
from cardcage.golden.organisations.organisation_of import organisation_of
from cardcage.golden.scene_display_list import make_display_list
from cardcage.golden.specification.commands import ResponseKind
from cardcage.testbenches.engines.choose_engine import make_engine
from cardcage.testbenches.engines.engine import Job
from cardcage.testbenches.frames.conversation import responses_owed
from cardcage.testbenches.frames.frame_job import frame_commands

#: Of the clocks of a merge.
ACCURACY = 0.02

SEEDS = range(4)

CAGES = {
    "one unit": ("2x(PMT)", {}),
    "units that alternate along rows": ("4x(PMMT)", {"skew": True}),
    "two elements": ("4x(PMPMT)", {}),
    "four units, a run of the list for each": ("3x(PMMMMT)", {"packet": "contiguous"}),
}


def scene(seed):
    """Of few large triangles and many small ones by turns."""
    n, size = ((300, 12), (120, 24))[seed % 2]
    return make_display_list(f"random:n={n},size={size},seed={seed}", width=64,
                             height=64).display_list


def merges(configuration, lists):
    """Frame after frame of one run: clocks from a scan's first line to the end of drawing, and
    from there until all is merged."""
    words = [word for listed in lists for word in frame_commands(configuration, listed)]
    run = make_engine().run(Job(configuration, words,
                                responses_owed(organisation_of(configuration), words)))
    drawn, merged = ([(value, cycle) for kind, value, cycle in run.responses if kind == wanted]
                     for wanted in (ResponseKind.FRAME_DRAWN, ResponseKind.MERGED))
    for (before, cycle), (after, _) in zip(drawn, merged, strict=True):
        begin = cycle - first_line(configuration)
        yield begin % configuration.cycles_per_scan, after - before


@pytest.mark.parametrize("cage", chosen(
    CAGES, "units that alternate along rows"))
def test_a_merge_takes_the_predicted_clocks(cage, record_property):
    cards, options = CAGES[cage]
    lists = [scene(seed) for seed in SEEDS]
    configuration = max((wide_machine(listed, cards=cards, memory_ports=1, **options)
                         for listed in lists), key=lambda machine: machine.fraction_bits)
    errors = []
    for seed, listed, (begin, clocks) in zip(SEEDS, lists, merges(configuration, lists),
                                             strict=True):
        assert sum(merge_cage(configuration, listed)[1].steps) > 500
        predicted = predict_merge(configuration, listed, begin)
        print(f"seed {seed}, begun at {begin} of {configuration.cycles_per_scan}: {clocks} clocks, "
              f"predicted {predicted}, {predicted / clocks - 1:+.2%}")
        errors.append(abs(predicted / clocks - 1))
    record_property("measured", f"{cards}, {cage}: merges of units with one port are predicted "
                                f"within {max(errors):.1%}")
    assert max(errors) <= ACCURACY
