"""The table of boards: what is placed, what is counted, and what the command prints."""

import json
import re
from pathlib import Path

import pytest
from click.testing import CliRunner
from refusals import refusal

from cardcage.golden.specification.fixed_point import exact_fraction_bits
from cardcage.testbenches.command_line.boards_command import BOARD_NAMES
from cardcage.testbenches.command_line.cli import main
from cardcage.testbenches.export.verilog import component_verilog
from cardcage.testbenches.fpga import board_figures, place_and_route
from cardcage.testbenches.fpga.boards import BOARDS
from cardcage.testbenches.fpga.outside_ram import OutsideRam
from cardcage.testbenches.fpga.place_and_route import Part, Placement, missing_tools

TINY = ["--cards", "PM", "--size", "16x16"]


@pytest.fixture(autouse=True)
def own_cache(tmp_path, monkeypatch):
    monkeypatch.setenv("CARDCAGE_CACHE", str(tmp_path / "cache"))
    monkeypatch.chdir(tmp_path)


@pytest.fixture
def placed(monkeypatch):
    """Tools that take no time: the parts that were placed."""
    parts = []

    def place(part, seeds, step):
        parts.append(part)
        for seed in seeds:
            step(f"seed {seed}")
        return Placement({"LUT4": 1000 + len(parts), "CCU2C": 20, "TRELLIS_FF": 3,
                          "MULT18X18D": 4, "TRELLIS_DPR16X4": 5},
                         tuple(100.0 + 10 * (seed % 3) for seed in seeds))

    monkeypatch.setattr(board_figures, "place_and_route", place)
    return parts


def run(*arguments):
    return CliRunner().invoke(main, ["boards", *(str(argument) for argument in arguments)])


def needs_tools():
    if missing := missing_tools():
        pytest.skip(f"place and route {missing}")


def netlist_of(name, folder, **size):
    """Cells of a board alone, and the netlist of the bench around it, which is routed."""
    part = BOARDS[name].part(**{"cards": "PM", "width": 16, "height": 16} | size)
    place_and_route._synthesise(part.texts(), folder)
    return (place_and_route.cell_counts(json.loads((folder / "cells.json").read_text())),
            json.loads((folder / "netlist.json").read_text())["modules"])


def test_the_command_lines_names_are_the_boards():
    assert tuple(BOARDS) == BOARD_NAMES


@pytest.mark.parametrize(("name", "storages"), [("unit-1-port", 1), ("unit-2-ports", 3),
                                                ("domain", 3 * 2), ("domain-gouraud", 3 * 2)])
def test_every_ram_is_outside(name, storages):
    part = BOARDS[name].part("PMM", 512, 512)
    text = part.texts()["component.v"]
    assert text.startswith(f"module {part.name}(")
    assert len(re.findall(r"^  ram_ports #\(", text, re.MULTILINE)) == storages
    assert "memory_131072x" not in text
    # Those of the FIFOs are on the board.
    assert bool(re.search(r"^module memory_\d", text, re.MULTILINE)) == name.startswith("domain")


def test_other_rams_stay_and_the_members_are_the_boards_own():
    part = BOARDS["unit-2-ports"].part("PM", 16, 16)
    unit = place_and_route.Part(part.configuration, "memory_unit")
    inside = unit.texts()["component.v"]
    from cardcage.hdl.memory_unit.memory_unit import MemoryUnit

    board = MemoryUnit(configuration=part.configuration)
    kept = OutsideRam(component=board, storages=board.memory.storages[1:])
    assert kept.signature == board.signature
    text = component_verilog(kept, "memory_unit")
    assert text.count("ram_ports #(") == 2 and inside.count("ram_ports #(") == 0
    assert text.count("module memory_256x28_no_rw_check(") == 1


def test_registers_of_the_ram_are_no_cells_of_the_board(tmp_path):
    needs_tools()
    cells, modules = netlist_of("unit-2-ports", tmp_path)
    part = BOARDS["unit-2-ports"].part("PM", 16, 16)
    inside = tmp_path / "inside"
    inside.mkdir()
    place_and_route._synthesise(Part(part.configuration, "memory_unit").texts(), inside)
    with_ram = place_and_route.cell_counts(json.loads((inside / "cells.json").read_text()))
    assert cells["ram_ports"] == 3 and "DP16KD" not in cells
    assert with_ram["DP16KD"] == 3 and "ram_ports" not in with_ram
    assert cells["TRELLIS_FF"] == with_ram["TRELLIS_FF"]
    # The RAM's own delays shift the balance of LUTs and wide multiplexers a little.
    assert cells["LUT4"] == pytest.approx(with_ram["LUT4"], rel=0.3)
    # In the bench each has a register for every bit in and out, folding them apart.
    [ports] = [module for name, module in modules.items() if "ram_ports" in name]
    registers = [cell for cell in ports["cells"].values() if cell["type"] == "TRELLIS_FF"]
    inputs, words = 1 + 1 + 8 + 28 + 8, 28
    assert len(registers) == 2 * inputs + words
    instances = [cell for module in modules.values() for cell in module["cells"].values()
                 if "ram_ports" in cell["type"]]
    assert len(instances) == 3


def test_machines_are_exact_for_every_triangle(placed):
    assert run("--seeds", 1).exit_code == 0
    machines = {name: part.configuration for name, part in zip(BOARDS, placed, strict=True)}
    for name, machine in machines.items():
        merge = {"chain": "C", "tree": "T", "snoop": "S", "frame": "S"}.get(
            name.removeprefix("unit-of-").split("-")[0])
        cards = ("PPPPDMMMM" if "direct" in name else "PMM" * 16 if machine.regions else
                 "PMM" if merge is None else f"PMM{merge}" * 2 + "FF" * (merge == "S"))
        assert (machine.width, machine.height, machine.cards) == (512, 512, cards)
        assert machine.order_bits == machine.node_order_bits
        assert (machine.sub_bits, machine.depth_bits, machine.fifo_depth) == (8, 24, 16)
        assert machine.fraction_bits == exact_fraction_bits(512 * 512 << 16, 1022)
        assert machine.edges_on_screen and machine.stays_in_range
        assert not machine.observe
    assert [name for name, machine in machines.items() if machine.memory_ports == 1] == [
        "unit-1-port"]
    assert [name for name, machine in machines.items() if machine.shading == "gouraud"] == [
        "domain-gouraud"]
    assert machines["setup-fast"].setup_interval == 1 < machines["setup-small"].setup_interval
    assert len({part.origin for part in placed}) == len(BOARDS)


@pytest.mark.skipif(missing_tools() is not None, reason=str(missing_tools()))
def test_table_and_json(placed):
    done = run("--boards", "domain,setup-fast", *TINY, "--json", "boards.json")
    assert done.exit_code == 0, done.output
    assert done.stdout.startswith("PM at 16x16, ECP5-85k, speed grade 6")
    assert re.search(r"^processing element, memory units, flat +1,001 +20 +1,041 +3 +4 +5 "
                     r"+110.0 +120.0 +100.0 +110.0$", done.stdout, re.MULTILINE), done.stdout
    assert [part.name for part in placed] == ["domain", "triangle_setup"]
    facts = json.loads(Path("boards.json").read_text())
    assert [board["name"] for board in facts["boards"]] == ["domain", "setup-fast"]
    [_, setup] = facts["boards"]
    assert setup["luts"] == 1002 + 2 * 20 and setup["mhz"]["median"] == 110.0
    assert setup["configuration"]["setup"] == "hardware"
    assert facts["target_mhz"] == place_and_route.TARGET_MHZ and facts["tools"]


@pytest.mark.parametrize(("arguments", "message"), [
    (["--boards", "domian"], "'domian' is not one of"),
    (["--cards", "PMQ"], "'Q' at position 3 is no card"),
    (["--size", "0x16"], "width 0 is not from 1"),
    (["--seeds", "0"], "--seeds"),
    (["--json", "/dev/null/boards.json"], "--json: /dev/null/boards.json cannot be written"),
])
def test_refuses(placed, arguments, message):
    assert message in refusal(run, *arguments)
    assert not placed and list(Path().iterdir()) == []


def test_without_the_tools(monkeypatch):
    monkeypatch.setattr(place_and_route.importlib.util, "find_spec", lambda name: None)
    assert "needs pip install 'cardcage[fpga]'" in refusal(
        run, "--boards", "unit-1-port", *TINY, "--json", "boards.json")
    assert list(Path().iterdir()) == []


def test_one_real_run():
    needs_tools()
    done = run("--boards", "unit-1-port", *TINY, "--seeds", 1, "--json", "boards.json")
    assert done.exit_code == 0, done.output
    print(done.stdout)
    [board] = json.loads(Path("boards.json").read_text())["boards"]
    assert 50 < board["luts"] < 500 and 20 < board["flip_flops"] < 200
    assert 30 < board["mhz"]["median"] < 900 and board["cells"]["ram_ports"] == 1
