"""What the README shows is what happens."""

import os
import re
import shlex
import subprocess
import sys
from pathlib import Path

import pytest
from amaranth.sim import Simulator

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


def test_the_python_example_builds_a_machine():
    [example] = blocks("python")
    names = {}
    exec(example, names)
    assert len(names["machine"].memory_units) == 8
    Simulator(names["machine"])


def test_files_it_names_exist():
    links = re.findall(r"\]\(((?!http)[^)]+)\)", README)
    sources = re.findall(r"`([a-z]+/[\w-]+\.(?:py|md))`", README)
    assert links and sources
    for name in links + sources:
        assert (ROOT / name).is_file(), name
