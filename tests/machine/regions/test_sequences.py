"""Sequences of pictures whose regions are dealt out anew for each, on compiled machines.

Every picture on every scan, every depth, every count of a region and every table that a machine
makes itself equals the golden model's.  A host learns from the clocks of three pictures.
"""

from itertools import pairwise

import numpy as np
import pytest
from suite.cases import chosen

from cardcage.golden.balancing.learnt_counts import learnt_counts
from cardcage.golden.organisations.region_table import packed_table
from cardcage.golden.planning.machine_plan import plan
from cardcage.golden.scene_display_list import make_display_list
from cardcage.testbenches.engines.verilator_tool import ToolMissingError, find_verilator
from cardcage.testbenches.sequence.sequence_run import simulate_sequence

try:
    find_verilator()
except ToolMissingError as missing:
    pytest.skip(f"simulator verilator: {missing}", allow_module_level=True)

SIZE = {"width": 44, "height": 36}


def listed(count, size, seed, shading="flat"):
    return make_display_list(f"random:n={count},size={size},seed={seed}", shading=shading,
                             **SIZE).display_list


#: Small triangles and large ones, and so many that the picture is late.
LISTS = [listed(*numbers) for numbers in ((14, 9, 1), (4200, 9, 2), (9, 60, 3), (40, 7, 4))]

#: Where elements times slots are as many as the regions, all are full whatever the table.
MACHINES = {
    "3 elements, all slots full, learnt": {"cards": "3x(PM)", "regions": (6, 5), "slots": 10},
    "4 elements, two of them empty, static": {
        "cards": "4x(PMM)", "regions": (1, 2), "slots": 1, "balance": "static"},
    "5 elements, triangles": {"cards": "5x(PM)", "regions": (6, 5), "slots": 6,
                              "balance": "triangles", "memory_ports": 2, "shading": "gouraud"},
    "7 elements, hardware": {"cards": "7x(PMM)", "regions": (6, 5), "balancer": "hardware",
                             "memory_ports": 2},
    "3 elements, triangles, hardware, all slots full": {
        "cards": "3x(PMMMM)", "regions": (11, 9), "slots": 33, "balance": "triangles",
        "balancer": "hardware"},
    "set-up in hardware": {"cards": "2x(PM)", "regions": (3, 5), "setup": "hardware",
                           "setup_interval": 32},
    "16 elements, hardware": {"cards": "16x(PM)", "regions": (11, 9), "slots": 8,
                              "balancer": "hardware", "memory_ports": 2},
}


@pytest.mark.parametrize("name", chosen(
    MACHINES, "3 elements, all slots full, learnt"))
def test_every_picture_and_every_count(name):
    configuration = plan(LISTS, clocks_per_pixel=2, **MACHINES[name]).configuration
    for options in ({"depths": "last"},
                    {"depths": "all", "stall_seed": 5, "memory_seed": 6}):
        frames = list(simulate_sequence(configuration, LISTS, "verilator", triangles=4200,
                                        **options))
        for frame in frames:
            assert frame.equal and frame.wrong_scans == 0, (frame.number, options)
            assert frame.regions.differences == [], (frame.number, options)
        everything = SIZE["width"] * SIZE["height"]
        assert frames[-1].comparison.depths_compared == everything
        assert (frames[0].comparison.depths_compared > 0) == (options["depths"] == "all")
        # The long one is late: the one before stays, by its own table.
        assert frames[1].simulation.repeated_scans >= 1 and frames[0].scans >= 2
        for one, other in pairwise(frames):
            assert one.first_scan + one.scans == other.first_scan
            same = np.array_equal(one.regions.table, other.regions.table)
            assert same == (configuration.balance == "static")
        if frames[0].regions.policy == "learnt":  # the fourth picture's table is the first such
            foretold = learnt_counts([frame.regions.counts for frame in frames[2::-1]],
                                     configuration.dealt_regions.columns)
            learnt = packed_table(foretold, configuration.processing_elements, configuration.slots)
            assert frames[3].regions.table.tolist() == learnt.tolist()
            assert not np.array_equal(learnt, packed_table(
                frames[2].regions.counts, configuration.processing_elements, configuration.slots))
        counted = [frame.regions.slot_counts is not None for frame in frames]
        assert counted == [configuration.balance != "static"] * 4
        made = [frame.regions.read_table is not None for frame in frames]
        assert made == [configuration.balancer == "hardware"] * 4
