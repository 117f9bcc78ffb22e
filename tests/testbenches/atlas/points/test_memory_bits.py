"""Bits of memory by the configuration alone, against those of the machine's Verilog."""

import pytest

from cardcage.golden.planning.machine_plan import plan
from cardcage.testbenches.atlas.points.memory_bits import memory_bits, word_bits
from cardcage.testbenches.comparison.cage import Cage
from cardcage.testbenches.export.machine_json import memories
from cardcage.testbenches.export.verilog import machine_verilog
from cardcage.testbenches.machine_options import MachineOptions, load_scene

#: A hundredth: queues are some bits off.
ALIKE = 0.01

CAGES = ((Cage("2x(PMM)", regions=(4, 4)), 1),
         (Cage("2x(PMC)", retained=True), 1), (Cage("2x(PMT)", retained=True), 2),
         (Cage("2x(PMMS)F"), 1), (Cage("2xPD2xM", retained=True), 2))


@pytest.mark.parametrize(("cage", "ports"), CAGES, ids=str)
def test_as_many_as_in_the_verilog(cage, ports):
    options = cage.options(MachineOptions(size=(64, 64), memory_ports=ports))
    listed = load_scene("teapot:tessellation=3", options).display_list
    configuration = plan(listed, **options.for_plan()).configuration
    found = memories(machine_verilog(configuration))
    parts = memory_bits(configuration)
    everything = sum(each["words"] * each["bits"] * each["instances"] for each in found)
    assert abs(sum(parts.values()) - everything) < ALIKE * everything
    # The large ones to the bit.
    lanes = word_bits(configuration)
    pictures = sum(each["words"] * each["bits"] * each["instances"] for each in found
                   if each["words"] == configuration.words and each["bits"] <= lanes
                   and each["bits"] >= configuration.rank_bits)
    assert pictures == parts["pictures"] + (parts["frame_units"] if configuration.snoops and
                                            configuration.frame.words == configuration.words else 0)
    lists = sum(each["words"] * each["bits"] * each["instances"] for each in found
                if configuration.list_words and each["words"] == configuration.list_words)
    assert lists == parts["lists"]
