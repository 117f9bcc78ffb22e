"""What the README and the page of the commands show is what happens."""

import os
import re
import shlex
import subprocess
import sys
from pathlib import Path

import pytest
from amaranth.sim import Simulator
from click.testing import CliRunner
from suite.cases import EVERY

from cardcage.golden.specification.configuration import MachineConfiguration
from cardcage.testbenches.command_line.cli import main
from cardcage.testbenches.export.export_files import export
from cardcage.testbenches.render import RenderOptions, prepare_render

ROOT = Path(__file__).parent.parent
README = (ROOT / "README.md").read_text(encoding="utf-8")


PAGE = (ROOT / "docs" / "commands.md").read_text(encoding="utf-8")


def blocks(language, text=README):
    return re.findall(rf"^```{language}\n(.*?)^```", text, re.DOTALL | re.MULTILINE)


#: Command → its comment, on either page.
COMMANDS = {line.partition("  #")[0]: line.partition("  #")[2]
            for block in blocks("sh", PAGE) + blocks("sh") for line in block.splitlines()
            if line.startswith("cardcage ")}
QUICK = [line for line, comment in COMMANDS.items() if "minute" not in comment]


def test_the_gate_runs_exactly_the_test_command():
    [command] = [line for block in blocks("sh") for line in block.splitlines() if "pytest" in line]
    assert command in (ROOT / ".ci" / "run").read_text().splitlines()


@pytest.mark.parametrize("page", [README, pytest.param(PAGE, marks=EVERY)],
                         ids=["README", "docs/commands.md"])
def test_the_quick_commands_do_what_they_should(tmp_path, page):
    quick = [line for line in QUICK if f"\n{line}" in page]
    assert len(quick) >= 4
    folder = str(Path(sys.executable).parent)
    environment = os.environ | {"PATH": folder + os.pathsep + os.environ["PATH"]}
    for line in quick:  # in order: one replays what another wrote
        done = subprocess.run(shlex.split(line), cwd=tmp_path, env=environment,
                              capture_output=True, text=True, timeout=300)
        assert done.returncode == 0, f"{line}: {done.stderr}"
        assert done.stdout.strip(), line
        if " render " in line:
            assert done.stdout.startswith("equal"), done.stdout


@pytest.mark.parametrize("line", [line for line in COMMANDS if line not in QUICK])
def test_the_slow_commands_parse(line):
    """Their options exist: the help of the same command names each."""
    words = shlex.split(line)
    shown = CliRunner().invoke(main, [words[1], "--help"]).output
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
    exported = export(tmp_path / "machine.v", component="id_increment", cards="PM", size=(16, 12),
                      clocks_per_pixel=3)
    assert exported.configuration == MachineConfiguration(
        cards="PM", width=16, height=12, clocks_per_pixel=3)


def test_files_it_names_exist():
    """Links from the page's own folder, sources from the root; of every page."""
    pages = [ROOT / "README.md", ROOT / "CONTRIBUTING.md", ROOT / "CHANGELOG.md",
             *(ROOT / "docs").rglob("*.md")]
    missing = []
    for page in pages:
        text = page.read_text(encoding="utf-8")
        named = [page.parent / link for link in re.findall(r"\]\(((?!http)[^)#]+)[^)]*\)", text)]
        named += [ROOT / name for name in re.findall(r"`((?:[a-z_]+/)+[\w-]+\.(?:py|md))`", text)]
        missing += [f"{page.relative_to(ROOT)}: {name}" for name in named if not name.exists()]
    assert not missing, "\n".join(missing)
