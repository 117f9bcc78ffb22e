"""What the README shows is what happens."""

import os
import re
import shlex
import subprocess
import sys
from pathlib import Path

import pytest
from amaranth.sim import Simulator

from cardcage.golden.specification.configuration import MachineConfiguration
from cardcage.testbenches.export.export_files import export
from cardcage.testbenches.machine_options import MachineOptions
from cardcage.testbenches.render import RenderOptions, prepare_render

ROOT = Path(__file__).parent.parent
README = (ROOT / "README.md").read_text(encoding="utf-8")


def blocks(language):
    return re.findall(rf"^```{language}\n(.*?)^```", README, re.DOTALL | re.MULTILINE)


COMMANDS = [line for block in blocks("sh") for line in block.splitlines()
            if line.startswith("cardcage ")]
QUICK = [line for line in COMMANDS if "minute" not in line.partition("#")[2]]


def test_the_gate_runs_exactly_the_test_command():
    [command] = [line for block in blocks("sh") for line in block.splitlines() if "pytest" in line]
    assert command in (ROOT / ".ci" / "run").read_text().splitlines()


def test_the_quick_commands_do_what_they_should(tmp_path):
    assert len(QUICK) >= 4
    folder = str(Path(sys.executable).parent)
    environment = os.environ | {"PATH": folder + os.pathsep + os.environ["PATH"]}
    for line in QUICK:  # in order: one replays what another wrote
        done = subprocess.run(shlex.split(line, comments=True), cwd=tmp_path, env=environment,
                              capture_output=True, text=True, timeout=300)
        assert done.returncode == 0, f"{line}: {done.stderr}"
        assert done.stdout.strip(), line
        if " render " in line:
            assert done.stdout.startswith("equal"), done.stdout


@pytest.mark.parametrize("line", [line for line in COMMANDS if line not in QUICK])
def test_the_slow_commands_parse(line):
    """Their options exist: the help of the same command names each."""
    words = shlex.split(line, comments=True)
    shown = subprocess.run([str(Path(sys.executable).parent / "cardcage"), words[1], "--help"],
                           capture_output=True, text=True, timeout=60, check=True).stdout
    for word in words:
        if word.startswith("--"):
            assert word in shown


def test_the_python_example_builds_the_machine_of_the_command_beside_it():
    [example] = blocks("python")
    names = {}
    exec(example, names)
    assert len(names["machine"].memory_units) == 8
    Simulator(names["machine"])
    [line] = re.findall(r"^`(cardcage render teapot [^`]*)` simulates:", README, re.MULTILINE)
    _, _, scene, *words = shlex.split(line)
    options = dict(zip(words[::2], words[1::2], strict=True))
    assert set(options) == {"--cards", "--size"}
    width, height = map(int, options["--size"].split("x"))
    job = prepare_render(scene, RenderOptions(cards=options["--cards"], size=(width, height)))
    assert job.configuration == names["planned"].configuration


def test_a_machine_without_a_scene_is_the_one_that_export_writes(tmp_path):
    options = MachineOptions(cards="PM", size=(16, 12), clocks_per_pixel=3)
    exported = export(tmp_path / "machine.v", options=options, component="id_increment")
    assert exported.configuration == MachineConfiguration(
        cards="PM", width=16, height=12, clocks_per_pixel=3)


def test_files_it_names_exist():
    links = re.findall(r"\]\(((?!http)[^)]+)\)", README)
    sources = re.findall(r"`([a-z]+/[\w-]+\.(?:py|md))`", README)
    assert links and sources
    for name in links + sources:
        assert (ROOT / name).is_file(), name
