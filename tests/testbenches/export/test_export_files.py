"""``cardcage export``: what it writes, that it is the same every time, and how it refuses."""

from __future__ import annotations

import json
import os
import re
import subprocess
import sys
from pathlib import Path

import pytest
from click.testing import CliRunner
from refusals import BAD_SCENES_AND_MACHINES, listing, refusal
from suite.cases import EVERY

from cardcage.golden.planning.presets import PRESETS
from cardcage.golden.reference.triangle_setup import scene_fraction_bits
from cardcage.golden.scene_display_list import make_display_list
from cardcage.golden.specification.configuration import MachineConfiguration
from cardcage.golden.specification.fixed_point import on_screen_fraction_bits
from cardcage.testbenches.command_line.cli import main

SCENE = "random:n=12,size=8,seed=5"
TINY = ["--cards", "PM", "--size", "16x16"]
COMMAND = [sys.executable, "-c", "from cardcage.testbenches.command_line.cli import main; main()"]


@pytest.fixture(autouse=True)
def place(tmp_path, monkeypatch) -> Path:
    monkeypatch.chdir(tmp_path)
    return tmp_path


def run(*arguments):
    return CliRunner().invoke(main, ["export", *map(str, arguments)])


def test_export():
    """Without a scene: three files, formats for any triangle on the screen."""
    result = run(*TINY, "-o", "machine.v")
    assert result.exit_code == 0, result.output
    assert result.stderr == ""
    assert sorted(listing()) == ["machine.json", "machine.v", "machine.vlt"]
    bits = on_screen_fraction_bits(16, 16, 8)
    assert f"fraction bits: {bits}, exact for every triangle" in result.stdout
    facts = json.loads(Path("machine.json").read_text())
    assert facts["top"] == "machine"
    assert facts["configuration"]["fraction_bits"] == bits
    assert facts["configuration"]["shading"] == "gouraud"
    text = Path("machine.v").read_text()
    header = text[:text.index("module ")]
    assert all(line.startswith("//") for line in header.strip().splitlines())
    for word in ("Cardcage 0.", "cardcage export --cards PM --size 16x16", f"fraction_bits {bits}"):
        assert word in header
    assert str(Path.cwd()) not in text and not re.search(r"\b20\d\d-", text)


def test_formats_of_a_scene():
    assert run(SCENE, *TINY).exit_code == 0
    facts = json.loads(Path("machine.json").read_text())
    listed = make_display_list(SCENE, width=16, height=16).display_list
    assert facts["configuration"]["fraction_bits"] == scene_fraction_bits(listed)
    assert facts["precision"].endswith(f"exact for {SCENE}")
    assert facts["configuration"]["shading"] == ("flat" if listed.flat else "gouraud")


@pytest.mark.parametrize("size", [(16, 16), (64, 48), (5, 7)])
def test_on_screen_bits_are_enough_and_needed(size):
    """The largest triangle on the screen needs exactly them."""
    width, height = size
    listed = make_display_list("tetra", width=width, height=height).display_list
    position = listed.position[:1] * 0
    position[0, 1, 0], position[0, 2, 1] = width << 8, height << 8
    largest = type(listed)(width=width, height=height, position=position, depth=listed.depth[:1],
                           color=listed.color[:1])
    assert scene_fraction_bits(largest) == on_screen_fraction_bits(width, height, 8)


def test_a_preset_keeps_its_formats():
    assert run("--preset", "tiny", "--shading", "flat").exit_code == 0
    configuration = json.loads(Path("machine.json").read_text())["configuration"]
    assert configuration["fraction_bits"] == MachineConfiguration(**PRESETS["tiny"]).fraction_bits
    assert configuration["shading"] == "flat"


def test_a_component():
    """In a folder that is made for it."""
    place = Path("some/new/folder")
    assert run(*TINY, "--component", "memory_unit", "-o", place / "unit.v").exit_code == 0
    assert sorted(file.name for file in place.iterdir()) == ["unit.json", "unit.v", "unit.vlt"]
    assert list(Path().iterdir()) == [Path("some")]
    assert "\nmodule memory_unit(" in (place / "unit.v").read_text()
    facts = json.loads((place / "unit.json").read_text())
    assert facts["top"] == "memory_unit" and "left__id" in [port["name"] for port in facts["ports"]]
    assert list(facts["timing"]) == ["memory_unit"]
    assert [memory["words"] for memory in facts["memories"]] == [256]


def test_memory_ports():
    """Three RAMs a unit where it has two ports, one where it has one."""
    for ports, memories in (("1", [(84, 1)]), ("2", [(28, 3)])):
        assert run(*TINY, "--memory-ports", ports, "-o", "machine.v").exit_code == 0
        facts = json.loads(Path("machine.json").read_text())
        assert facts["configuration"]["memory_ports"] == int(ports)
        assert [(memory["bits"], memory["instances"]) for memory in facts["memories"]
                if memory["words"] == 256] == memories


def test_the_interlace_is_described():
    for options, block, reads in ((["--block", "1"], 1, 8), (["--block", "4"], 4, 4),
                                  (["--skew"], 1, 4), (["--lines"], 1, 8)):
        assert run("--cards", "4x(PMM)", "--size", "16x16", "--fraction-bits", 28, *options,
                   "--component", "memory_unit", "-o", "unit.v").exit_code == 0
        configuration = json.loads(Path("unit.json").read_text())["configuration"]
        assert (configuration["block"], configuration["skew"]) == (block, "--skew" in options)
        assert configuration["lines"] == ("--lines" in options)
        assert configuration["scan_reads_per_line"] == reads
        assert f" {' '.join(options)} " in Path("unit.v").read_text()


@pytest.mark.parametrize("arguments", [
    [*TINY, "--component", "survey"], pytest.param([*TINY], marks=EVERY),
    pytest.param([SCENE, *TINY], marks=EVERY)])
def test_deterministic(arguments):
    """In this process and in one that hashes differently."""
    assert run(*arguments, "-o", "a.v").exit_code == 0
    subprocess.run([*COMMAND, "export", *arguments, "-o", "b.v"], check=True,
                   env=os.environ | {"PYTHONHASHSEED": "1"}, stdout=subprocess.DEVNULL)
    for suffix in ("v", "json", "vlt"):
        assert Path(f"a.{suffix}").read_bytes() == Path(f"b.{suffix}").read_bytes()


@pytest.mark.parametrize(("arguments", "words"), [
    *BAD_SCENES_AND_MACHINES,
    (["--component", "toaster"], "memory_unit"),
    (["-o", "machine.vhdl"], ".v"),
    (["-o", f"{os.devnull}/machine.v"], f"{os.devnull} is a file"),
    (["nothing.obj", "-o", "new/folder/machine.v"], "nothing.obj"),
    (["-o", "folder.v"], "folder.v"),
])
def test_refused(arguments, words):
    Path("folder.v").mkdir()
    assert words in refusal(run, *arguments)
    assert list(Path().iterdir()) == [Path("folder.v")]


def test_a_failure_leaves_the_last_export(monkeypatch):
    assert run(*TINY).exit_code == 0
    before = listing()
    monkeypatch.setattr("cardcage.testbenches.export.export_files.json.dumps",
                        lambda *_, **__: 1 / 0)
    result = run(*TINY, "--shading", "flat")
    assert result.exit_code == 2 and "ZeroDivisionError" in result.stderr
    assert listing() == before


def test_coarser_pictures_are_said():
    result = run(*TINY, "--words", 64)
    assert result.exit_code == 0
    assert "coarser" in result.stderr
    assert json.loads(Path("machine.json").read_text())["configuration"]["picture_width"] == 8
