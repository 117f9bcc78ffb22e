"""Machines of equal domains compiled from cores: clock for clock the machine in one piece."""

from dataclasses import replace

import numpy as np
import pytest
from suite.cases import EVERY

from cardcage.golden.planning.machine_plan import plan
from cardcage.golden.reference import exact
from cardcage.golden.scene_display_list import make_display_list
from cardcage.golden.specification.configuration import MachineConfiguration
from cardcage.testbenches.engines.domains import compile_domains, core_texts
from cardcage.testbenches.engines.domains.split_machine import split_machine
from cardcage.testbenches.engines.engine import Reset
from cardcage.testbenches.engines.verilator_engine import VerilatorEngine
from cardcage.testbenches.engines.verilator_tool import (
    ToolMissingError,
    VerilatorTool,
    find_verilator,
)
from cardcage.testbenches.export.verilog import machine_verilog
from cardcage.testbenches.frames.frame_job import frame_job
from cardcage.testbenches.frames.simulation import simulate
from cardcage.testbenches.support import cache

LIST = make_display_list("random:n=60,size=12,seed=5", width=32, height=32).display_list

try:
    find_verilator()
except ToolMissingError as missing:
    pytest.skip(f"simulator verilator: {missing}", allow_module_level=True)

MACHINES = [
    ({"cards": "16x(PM)"}, 7),
    pytest.param({"cards": "16x(PM)", "observe": True}, None, marks=EVERY),
    pytest.param({"cards": "12x(PM)", "regions": (8, 8), "memory_ports": 2}, 3, marks=EVERY),
    pytest.param({"cards": "8x(PM)PMM6x(PM)"}, 1, marks=EVERY),
    pytest.param({"cards": "16x(PM)", "lines": True}, 4, marks=EVERY),
]


@pytest.mark.parametrize(("options", "seed"), MACHINES)
def test_clock_for_clock_the_machine_in_one_piece(options, seed):
    """Two frames with a reset in the first, while the host pauses and memories hold anything, but
    zeros where regions are dealt out: what is counted there depends on it, in one piece, too."""
    configuration = plan(LIST, **options).configuration
    assert compile_domains.has_equal_domains(configuration)
    assert split_machine(configuration) is not None
    memory_seed = None if configuration.regions else seed
    job = frame_job(configuration, LIST, memory_seed=memory_seed, stall_seed=seed)
    job = replace(job, resets=(Reset(900, 0),), maximum_cycles=2 * job.maximum_cycles)
    cut, whole = (engine.run(job) for engine in (
        VerilatorEngine(), VerilatorEngine(verilog=machine_verilog(configuration))))
    assert cut.responses == whole.responses
    assert cut.cycles == whole.cycles
    np.testing.assert_array_equal(cut.accepted, whole.accepted)
    assert [record.begin for record in cut.activity] == [record.begin for record in whole.activity]
    for one, other in zip(cut.activity, whole.activity, strict=True):
        np.testing.assert_array_equal(one.counts, other.counts)
    assert [scan.cycle for scan in cut.scans] == [scan.cycle for scan in whole.scans]
    np.testing.assert_array_equal(cut.scans[-1].picture, whole.scans[-1].picture)
    picture = exact.draw(LIST)
    simulation = simulate(configuration, LIST, VerilatorEngine(), memory_seed=seed)
    np.testing.assert_array_equal(simulation.video, picture.color)
    np.testing.assert_array_equal(simulation.depth, picture.depth)


class Counted(VerilatorTool):
    """Runs nothing, and counts what would be compiled."""

    def run(self, commands, folder):
        for command in commands:
            if "-c" in command:
                unit = command[command.index("-o") + 1]
                COMPILED.append(unit.partition("/")[2] or unit)
            if "-o" in command:
                (folder / command[command.index("-o") + 1]).touch()
            if "--Mdir" in command:
                target = folder / command[command.index("--Mdir") + 1]
                name = command[command.index("--prefix") + 1] if "--prefix" in command else "Vmodel"
                (target / f"{name}.h").touch()
                (target / f"{name}.cpp").touch()


COMPILED: list[str] = []


def test_a_cage_of_known_domains_compiles_its_shell_alone(tmp_path, monkeypatch):
    monkeypatch.setenv(cache.ENVIRONMENT_VARIABLE, str(tmp_path / "cache"))
    found = find_verilator()
    tool = Counted(found.root, found.compiler)
    for number, (cards, kinds) in enumerate((
            ("PMMPMMPMPMMM", 4), ("PMPMMMPMMPMM", 0))):
        COMPILED.clear()
        configuration = MachineConfiguration(cards=cards, width=32, height=32)
        folder = tmp_path / str(number)
        folder.mkdir()
        compile_domains.compile_domains(tool, configuration, split_machine(configuration), folder)
        assert [path.name for path in folder.iterdir()] == ["machine"]
        assert COMPILED.count("unit.o") == 1
        assert COMPILED.count("core.o") == kinds, cards


@pytest.mark.parametrize(("cards", "options", "cut"), [
    ("16x(PMM)", {}, True),
    ("14x(PMM)PMPMMM", {}, True),
    ("12x(PM)", {"regions": (8, 8)}, True),
    ("8x(PMM)", {}, False),  # compiled soon enough, and simulated faster, in one piece
    ("16x(PMC)", {"memory_ports": 2}, False),  # simulated slower
    ("16x(PM)", {"setup": "hardware"}, False),  # a controller larger than all domains
    (f"12x(PM){'P'.join(['', *('M' * n for n in (2, 3, 4, 11))])}", {}, False),  # too many kinds
    (f"{'P'.join(['', *('M' * n for n in range(1, 11)), 'M' * 73])}", {}, False),  # none alike
])
def test_which_machines_are_cut(cards, options, cut):
    configuration = MachineConfiguration(cards=cards, width=32, height=32, **options)
    assert compile_domains.has_equal_domains(configuration) == cut


def test_a_verilator_whose_functions_have_other_names():
    """A core is then evaluated by what every Verilator has."""
    known = ["Vcore___024root___eval_ico(", "Vcore___024root___eval_nba(", "__VicoTriggered[0U]",
             "__VnbaTriggered[0U]"]
    assert "core.eval();" not in core_texts.step_text("Vcore", " ".join(known))
    for missing in known:
        text = core_texts.step_text("Vcore", " ".join(set(known) - {missing}))
        assert text.count("core.eval();") == 2
        assert "___024root" not in text


@EVERY
def test_equal_to_golden_with_that(tmp_path, monkeypatch):
    monkeypatch.setenv(cache.ENVIRONMENT_VARIABLE, str(tmp_path))
    step_text = core_texts.step_text
    monkeypatch.setattr(compile_domains, "step_text", lambda core, _: step_text(core, ""))
    configuration = plan(LIST, cards="16x(PM)").configuration
    simulation = simulate(configuration, LIST, VerilatorEngine(), stall_seed=1)
    np.testing.assert_array_equal(simulation.video, exact.draw(LIST).color)
