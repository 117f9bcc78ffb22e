"""The compiled model: the same machine as pysim's, clock for clock; built once and kept."""

import json
import os
import re
import shutil
import subprocess
import sys
import tempfile
import time
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from click.testing import CliRunner
from refusals import assert_one_line

from cardcage.golden.planning.machine_plan import plan
from cardcage.golden.reference import exact
from cardcage.golden.scene_display_list import make_display_list
from cardcage.golden.specification.commands import Opcode, ResponseKind
from cardcage.golden.specification.errors import InputError
from cardcage.testbenches.command_line.cli import main
from cardcage.testbenches.engines import choose_engine as engines
from cardcage.testbenches.engines import model_runtime, verilator_engine
from cardcage.testbenches.engines.engine import Reset
from cardcage.testbenches.engines.model_constants import model_constants
from cardcage.testbenches.engines.pysim_engine import PysimEngine
from cardcage.testbenches.engines.verilator_engine import VerilatorEngine
from cardcage.testbenches.engines.verilator_tool import ToolMissingError, find_verilator
from cardcage.testbenches.export import verilog
from cardcage.testbenches.frames.compare import compare
from cardcage.testbenches.frames.frame_job import frame_job
from cardcage.testbenches.frames.responses import Answers
from cardcage.testbenches.frames.simulation import simulate
from cardcage.testbenches.support import cache as kept

LIST = make_display_list("random:n=25,size=9,seed=3", width=16, height=12).display_list
CONFIGURATION = plan(LIST, cards="PMPMMM", clocks_per_pixel=2).configuration

try:
    find_verilator()
except ToolMissingError as missing:
    pytest.skip(f"simulator verilator: {missing}", allow_module_level=True)


@pytest.fixture(scope="module", autouse=True)
def cache(tmp_path_factory):
    """An own cache, so that building is tested and no test finds an old model, in a folder of an
    odd name; and of all programs only a compiler, no make and no perl."""
    folder, commands = tmp_path_factory.mktemp("my cäche"), tmp_path_factory.mktemp("commands")
    for program in (*find_verilator().compiler, "as", "ld"):
        (commands / Path(program).name).symlink_to(shutil.which(program))
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("PATH", str(commands))
        patch.setenv(kept.ENVIRONMENT_VARIABLE, str(folder))
        yield folder


@pytest.fixture(scope="module")
def engine(cache, tmp_path_factory):
    """Installed where the name of the folder is odd, too."""
    tool, home = find_verilator(), tmp_path_factory.mktemp("my $home")
    shutil.copytree(tool.root, home / "verilator")
    engine = VerilatorEngine(replace(tool, root=home / "verilator"))
    engine.build(CONFIGURATION)
    return engine


def test_clock_for_clock_the_same_as_pysim(engine):
    job = frame_job(CONFIGURATION, LIST, memory_seed=4)
    compiled, interpreted = engine.run(job), PysimEngine().run(job)
    assert compiled.cycles == interpreted.cycles
    assert compiled.responses == interpreted.responses  # kind, value and clock of each
    np.testing.assert_array_equal(compiled.accepted, interpreted.accepted)
    assert len(compiled.accepted) == len(job.commands)
    assert [scan.cycle for scan in compiled.scans] == [scan.cycle for scan in interpreted.scans]
    for one, other in zip(compiled.scans[1:], interpreted.scans[1:], strict=True):
        np.testing.assert_array_equal(one.picture, other.picture)


def test_resets_in_mid_run_are_the_same_in_both_engines(engine):
    """While it boots, in the clock after, and while it draws; then the frame is exact."""
    whole = frame_job(CONFIGURATION, LIST, memory_seed=4)
    drawing = PysimEngine().run(whole).accepted[4]
    resets = [Reset(37, 2), Reset(38, 0), Reset(38 + int(drawing), 0)]
    job = replace(whole, resets=resets)
    compiled, interpreted = engine.run(job), PysimEngine().run(job)
    assert compiled.cycles == interpreted.cycles
    assert compiled.responses == interpreted.responses
    np.testing.assert_array_equal(compiled.accepted, interpreted.accepted)
    assert [scan.cycle for scan in compiled.scans] == [scan.cycle for scan in interpreted.scans]
    assert len(compiled.accepted) >= 4 + len(job.commands)  # some of them twice
    last = [item for item in compiled.responses if item[2] > resets[-1].cycle]
    assert len(last) == job.responses
    for run in (compiled, interpreted):
        frame = Answers(CONFIGURATION, replace(run, responses=last)).frame(0, reading=0)
        assert compare(CONFIGURATION, LIST, frame).equal


@pytest.mark.parametrize("seed", range(4))
def test_equal_to_golden_whatever_the_memory_and_the_stalls(engine, seed):
    simulation = simulate(CONFIGURATION, LIST, engine, memory_seed=seed, stall_seed=seed)
    picture = exact.draw(LIST)
    np.testing.assert_array_equal(simulation.video, picture.color)
    np.testing.assert_array_equal(simulation.depth, picture.depth)
    [*_, (_, _, last)] = engine.run(frame_job(CONFIGURATION, LIST, stall_seed=seed)).responses
    [*_, (_, _, unhurried)] = engine.run(frame_job(CONFIGURATION, LIST)).responses
    assert last > unhurried, "the host paused"


def test_memories_are_random_at_power_on():
    """Seen in a machine that initialises no colour, and shows every word, whatever its tag."""
    text = verilog.machine_verilog(CONFIGURATION)
    text, count = re.subn(r"(write_enable\[[12]\])(\) words\S+:(28|56)\])",
                          r"\1 && write_data[\3 +: 4] != 0\2", text)
    text, also = re.subn(r"(assign current\[[12]\]) = [^;]*;", r"\1 = 1'h1;", text)
    assert (count, also) == (2, 2)
    engine = VerilatorEngine(verilog=text)
    first, second, zero = (simulate(CONFIGURATION, LIST, engine, memory_seed=seed).video
                           for seed in (1, 2, None))
    drawn = exact.depth_complexity(LIST) > 0
    color = exact.draw(LIST).color
    assert not zero[~drawn].any()
    for video in (first, second, zero):
        np.testing.assert_array_equal(video[drawn], color[drawn])
    assert (first[~drawn] != second[~drawn]).any() and first[~drawn].any()


def test_a_model_is_built_once(engine, cache):
    reports = []
    run = engine.run(frame_job(CONFIGURATION, LIST), lambda *now: reports.append(now))
    assert run.build_seconds == 0
    assert not [now for now in reports if now == (0, 0)]
    program, fresh = engine.build(CONFIGURATION)
    assert not fresh and program.parent.parent == cache
    assert not [path for path in cache.iterdir() if path.name.startswith(".")]


def test_the_main_program_is_told_every_code(monkeypatch):
    """Those of commands and responses; where any changes the model is built anew."""
    header = model_constants()
    for name, codes in (("Opcode", Opcode), ("ResponseKind", ResponseKind)):
        [listed] = re.findall(rf"namespace {name} {{(.*?)}}", header, re.DOTALL)
        found = re.findall(r"constexpr uint8_t (\w+) = (\d+);", listed)
        assert found == [(code.name, str(int(code))) for code in codes]

    keys = []
    monkeypatch.setattr(verilator_engine, "cached", lambda key, build: (
        keys.append(key) or (Path(), False)))
    VerilatorEngine().build(CONFIGURATION)
    monkeypatch.setattr(model_runtime, "model_constants", lambda: header
                        .replace("FRAME_DRAWN = 5", "FRAME_DRAWN = 15"))
    VerilatorEngine().build(CONFIGURATION)
    assert len(set(keys)) == 2


def patched(right, wrong):
    """An engine for the machine's Verilog with one thing changed, wherever a module has it."""
    text = verilog.machine_verilog(CONFIGURATION)
    assert right in text
    return VerilatorEngine(verilog=text.replace(right, wrong))


def test_a_netlist_whose_units_do_not_answer_is_found_out():
    with pytest.raises(TimeoutError, match="responses"):  # what nobody owns is not sent
        patched("[27:0] <= write_data[27:0];", "[27:0] <= 28'd0;").run(
            frame_job(CONFIGURATION, LIST))


def test_a_wrong_pixel_is_named():
    """The engines disagree on purpose: the comparison says so and names the first pixel."""
    simulation = simulate(CONFIGURATION, LIST, patched(" < nearest;", " > nearest;"))
    comparison = compare(CONFIGURATION, LIST, simulation)
    assert not comparison.equal
    picture = exact.draw(LIST)
    wrong = (simulation.video != picture.color).any(axis=-1) | (simulation.depth != picture.depth)
    y, x = np.argwhere(wrong)[0]
    assert tuple(comparison.first_difference.pixel) == (x, y)
    assert comparison.first_difference.fragments


BUILD = """
import time
from cardcage.testbenches.support.cache import cached
def build(folder):
    time.sleep(0.5)
    (folder / "machine").write_text("whole")
path, _ = cached("0" * 32, build)
print((path / "machine").read_text())
"""


def test_two_processes_at_once_do_not_harm_the_cache(tmp_path):
    environment = os.environ | {kept.ENVIRONMENT_VARIABLE: str(tmp_path)}
    running = [subprocess.Popen([sys.executable, "-c", BUILD], env=environment, text=True,
                                stdout=subprocess.PIPE) for _ in range(4)]
    assert [process.communicate(timeout=60)[0] for process in running] == ["whole\n"] * 4
    assert [path.name for path in tmp_path.iterdir()] == ["0" * 32]


def test_an_interrupted_build_leaves_nothing(tmp_path, monkeypatch):
    monkeypatch.setenv(kept.ENVIRONMENT_VARIABLE, str(tmp_path))

    def interrupted(folder):
        (folder / "half").touch()
        raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        kept.cached("key", interrupted)
    assert not list(tmp_path.iterdir())


def test_a_cache_that_cannot_be_written_is_replaced(tmp_path, monkeypatch):
    (tmp_path / "file").touch()  # a folder inside a file: nobody may, not even the superuser
    monkeypatch.setenv(kept.ENVIRONMENT_VARIABLE, str(tmp_path / "file" / "cache"))
    path, fresh = kept.cached("key", lambda folder: (folder / "machine").touch())
    assert fresh and (path / "machine").exists()
    assert tmp_path not in path.parents


def render(folder, *arguments):
    return CliRunner().invoke(main, ["render", "random:n=5,size=6", "--size", "8x8",
                                     "--cards", "PM", "--out", str(folder), *arguments])


def test_without_a_compiler_auto_says_so_and_takes_pysim(tmp_path, monkeypatch):
    monkeypatch.setattr(engines, "ENGINES", {"verilator": VerilatorEngine, "pysim": PysimEngine})
    monkeypatch.setenv("CXX", "no-such-compiler")
    result = render(tmp_path / "out")
    assert result.exit_code == 0, result.output
    assert "no C++ compiler: no-such-compiler is not on PATH; simulated with pysim" in result.stderr
    assert json.loads(Path(tmp_path, "out/report.json").read_text())["engine"] == "pysim"


def test_without_a_compiler_verilator_by_name_is_an_error(tmp_path, monkeypatch):
    monkeypatch.setattr(engines, "ENGINES", {"verilator": VerilatorEngine, "pysim": PysimEngine})
    monkeypatch.setenv("CXX", "no-such-compiler")
    result = render(tmp_path / "out", "--engine", "verilator")
    assert result.exit_code == 2
    assert result.stderr.count("\n") == 1 and "no-such-compiler" in result.stderr
    assert not (tmp_path / "out").exists()


def test_a_compiler_that_fails_is_named(tmp_path, monkeypatch):
    monkeypatch.setattr(engines, "ENGINES", {"verilator": VerilatorEngine, "pysim": PysimEngine})
    failing = "as"  # there, and no compiler
    monkeypatch.setenv("CXX", failing)
    result = render(tmp_path / "out")
    assert result.exit_code == 0, result.output
    assert f"{failing} cannot build the model" in result.stderr
    result = render(tmp_path / "named", "--engine", "verilator")
    assert result.exit_code == 2 and result.stderr.count("\n") == 1


@pytest.mark.parametrize("program", [None, b"#!/no/such/program\n", b"\x7fELF no program", b""])
def test_a_model_that_cannot_be_started(tmp_path, monkeypatch, program):
    """As in a cache on a file system that executes nothing: auto says so and takes pysim."""
    monkeypatch.setattr(engines, "ENGINES", {"verilator": VerilatorEngine, "pysim": PysimEngine})
    monkeypatch.setattr(verilator_engine, "cached", lambda key, build: (tmp_path, False))
    (tmp_path / "machine").write_bytes(b"#!/bin/sh\n" if program is None else program)
    (tmp_path / "machine").chmod(0o644 if program is None else 0o755)
    result = render(tmp_path / "out")
    assert result.exit_code == 0, result.output
    assert result.stderr.count("\n") == 1
    assert f"{tmp_path / 'machine'}" in result.stderr and "simulated with pysim" in result.stderr
    result = render(tmp_path / "named", "--engine", "verilator")
    assert result.exit_code == 2
    assert_one_line(result.stderr)
    assert not (tmp_path / "named").exists()


class Later(Sequence):
    """Commands that are made when they are asked for, of which one may fail."""

    def __init__(self, words, fails_at=None):
        self.words, self.fails_at = words, fails_at

    def __len__(self):
        return len(self.words)

    def __getitem__(self, place):
        if place == self.fails_at:
            raise InputError("the list of a later frame is no list")
        time.sleep(0.001)
        return self.words[place]


def test_commands_may_come_late(engine):
    """The machine's time stands still meanwhile."""
    job = frame_job(CONFIGURATION, LIST)
    at_once = engine.run(job)
    run = engine.run(replace(job, commands=Later(list(job.commands))))
    assert run.responses == at_once.responses and run.cycles == at_once.cycles
    np.testing.assert_array_equal(run.accepted, at_once.accepted)


def test_commands_that_cannot_be_made_end_the_run(engine):
    job = frame_job(CONFIGURATION, LIST)
    with pytest.raises(InputError, match=r"^the list of a later frame is no list$"):
        engine.run(replace(job, commands=Later(list(job.commands), fails_at=7)))


def test_no_room_for_the_results(engine, tmp_path):
    """The program says so: results that are cut short would look like a machine that hangs."""
    program, _ = engine.build(CONFIGURATION)
    done = subprocess.run([program, "/dev/full", "0", "-1", "-1", "100"], stdin=subprocess.DEVNULL,
                          capture_output=True, text=True)
    assert done.returncode == 2
    assert done.stderr == "/dev/full: No space left on device\n"


def test_no_folder_for_temporary_files(engine, tmp_path, monkeypatch):
    monkeypatch.setattr(tempfile, "tempdir", str(tmp_path / "none"))
    with pytest.raises(ToolMissingError, match=r"none.*No such file.*TMPDIR"):
        engine.run(frame_job(CONFIGURATION, LIST))


def test_the_report_tells_the_engine_and_its_times(engine, tmp_path, monkeypatch):
    monkeypatch.setattr(engines, "ENGINES", {"verilator": VerilatorEngine, "pysim": PysimEngine})
    LIST.save(tmp_path / "list.npz")
    for _ in range(2):  # the second time the model is there
        result = CliRunner().invoke(main, ["render", str(tmp_path / "list.npz"), "--cards",
                                           "PMPMMM", "--out", str(tmp_path / "out")])
        assert result.exit_code == 0, result.output
    facts = json.loads((tmp_path / "out/report.json").read_text())
    assert facts["equal"] and facts["engine"] == "verilator"
    assert facts["cycles"]["total"] > 1000 and facts["simulated_cycles_per_second"] > 0
    assert facts["build_seconds"] == 0 and facts["run_seconds"] > 0
