"""Boards in groups: equal ones are one text, wherever in the cage they stand."""

import re
from collections import Counter
from functools import cache

import pytest

from cardcage.golden.specification.configuration import MachineConfiguration
from cardcage.testbenches.engines.domains.machine_groups import group_boards
from cardcage.testbenches.engines.domains.netlist_text import modules_of, names_in
from cardcage.testbenches.export.verilog import machine_netlist


@cache
def grouped(cards):
    netlist, _ = machine_netlist(MachineConfiguration(cards=cards, width=32, height=32))
    return group_boards(netlist)


@pytest.mark.parametrize(("cards", "boards"), [
    ("PMPMMMPMPMMM", {("processing_element", "memory_unit"): 2,
                      ("processing_element", *["memory_unit"] * 3): 2}),
    ("PPPDMM", {("processing_element",): 3, ("direct_merge",): 1, ("memory_unit",): 2}),
])
def test_a_domain_is_an_element_and_its_units(cards, boards):
    machine = grouped(cards)
    *slots, last = machine.groups
    assert {tuple(re.findall(r"^  cell \\(\w+) \\board_", group.module, re.MULTILINE)): group.count
            for group in slots} == boards
    assert last.count == 1 and "central_broadcast_controller" in last.module
    for group in machine.groups:
        assert all(f"  cell \\{group.name} \\{group.at(place)}\n" in machine.netlist
                   for place in range(group.count))


@pytest.mark.parametrize("cards", ["PPPDMM", "PMPMMMPMPMMM"])
def test_every_wire_of_the_machine_is_driven(cards):
    """Once, and not by a board that always puts out the same, as the card of a direct merge does:
    the lines that run to all read that, too."""
    modules = modules_of(grouped(cards).netlist)
    machine = modules["\\machine"]
    driven = Counter(name for name, port in machine.ports.items() if port.direction == "input")
    driven.update(re.findall(r"^  connect (\S+) ", machine.text, re.MULTILINE))
    read = {name for name, port in machine.ports.items() if port.direction == "output"}
    for cell in machine.cells:
        for port, signal in cell.connections.items():
            if modules[cell.kind].ports[port].direction == "output":
                driven.update(names_in(signal))
            else:
                read.update(names_in(signal))
    assert not read - driven.keys()
    assert not [name for name in read if driven[name] > 1]
    assert "\n  connect \\" in machine.text


def test_cards_whose_connections_are_not_alike():
    assert grouped("4x(PMMT)") is None
