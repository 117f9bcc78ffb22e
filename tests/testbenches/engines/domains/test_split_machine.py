"""A machine cut into cores, which hold its state, and what lies between them."""

import re

import pytest
from suite.cases import EVERY

from cardcage.golden.specification.configuration import MachineConfiguration
from cardcage.testbenches.engines.domains.split_machine import split_machine
from cardcage.testbenches.engines.verilator_tool import ToolMissingError, find_verilator


def configuration(cards, **options):
    return MachineConfiguration(cards=cards, **{"width": 32, "height": 32} | options)


CUT = [
    {"cards": "PMMPMMPMPMMM"},
    pytest.param({"cards": "16x(PM)", "memory_ports": 2, "observe": True}, marks=EVERY),
    pytest.param({"cards": "12x(PM)", "regions": (8, 8)}, marks=EVERY),
    pytest.param({"cards": "16x(PM)", "setup": "hardware"}, marks=EVERY),
]

LINT = ["--lint-only", "--no-timing", "-Wno-lint", "-Wno-style", *(
    f"-Wwarn-{warning}" for warning in ("UNDRIVEN", "MULTIDRIVEN", "UNOPTFLAT", "PINMISSING"))]


@pytest.fixture(scope="module")
def machine():
    return split_machine(configuration("PMMPMMPMPMMM"))


@pytest.fixture(scope="module")
def cut(request, machine):
    if request.param == CUT[0]:
        return machine
    return split_machine(configuration(**request.param))


@pytest.fixture(scope="module")
def tool():
    try:
        return find_verilator()
    except ToolMissingError as missing:
        pytest.skip(f"simulator verilator: {missing}")


def test_equal_domains_are_one_core_each_kind_once(machine):
    assert [core.count for core in machine.cores] == [2, 1, 1, 1]  # the last: what has no slot
    assert len({core.verilog for core in machine.cores}) == 4


def test_a_core_does_not_depend_on_where_in_the_cage_it_stands(machine):
    """Nor on what else there is: at the left end of the cage, at the right end, between others."""
    other = split_machine(configuration("PMPMMMPMMPMM"))
    assert sorted(core.verilog for core in other.cores) == sorted(
        core.verilog for core in machine.cores)
    assert other.shell != machine.shell


def test_the_shell_holds_no_state(machine):
    assert "posedge" not in machine.shell
    assert "memory_" not in re.sub("memory_unit", "", machine.shell)
    for core in machine.cores:
        assert "posedge" in core.verilog


@pytest.mark.parametrize("cut", CUT, indirect=True)
def test_what_a_core_shows_depends_on_no_input(cut, tool, tmp_path):
    """Within a clock: Verilator's logic behind the inputs writes no output."""
    for number, core in enumerate(cut.cores):
        folder = tmp_path / str(number)
        folder.mkdir()
        (folder / "core.v").write_text(core.verilog)
        tool.translate(["--cc", "--top-module", "core", "-Wno-fatal", "-Wno-lint", "--no-timing",
                        "--Mdir", ".", "core.v"], folder)
        text = "".join(path.read_text() for path in folder.glob("*.cpp")
                       if not path.stem.endswith("Slow"))
        behind = "".join(re.findall(r"^void \w+___ico_\w+\(.*?^}", text, re.MULTILINE | re.DOTALL))
        assert behind and core.shown
        written = set(re.findall(r"\bvlSelfRef\.(o\d+)\b(?:\[\w+\])?\s*=[^=]", behind))
        assert not written, (number, written)


@pytest.mark.parametrize("cut", CUT, indirect=True)
def test_each_net_has_one_driver_and_none_depends_on_itself(cut, tool, tmp_path):
    """Any of these warnings is an error."""
    (tmp_path / "cut.v").write_text(cut.shell)
    tool.translate([*LINT, "--top-module", "machine", "cut.v"], tmp_path)
    for core in cut.cores:
        (tmp_path / "cut.v").write_text(core.verilog)
        tool.translate([*LINT, "--top-module", "core", "cut.v"], tmp_path)
    (tmp_path / "cut.v").write_text(cut.shell.replace("  assign i0 = ", "  assign i0 = i0 | ", 1))
    with pytest.raises(ToolMissingError, match="1 warning"):
        tool.translate([*LINT, "--top-module", "machine", "cut.v"], tmp_path)


def test_a_machine_that_cannot_be_cut():
    """RAM that is read without a clock is on a path through a board."""
    assert split_machine(configuration("2x(PMS)FF", memory_ports=2)) is None
