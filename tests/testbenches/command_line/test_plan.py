"""``cardcage plan``: what it says, that render and export build the same, how it refuses."""

from __future__ import annotations

import json
import re
import shlex
from dataclasses import replace
from pathlib import Path

import pytest
from command_bench.plan import facts, machine_of, run
from refusals import BAD_SCENES_AND_MACHINES, refusal
from suite.cases import EVERY

from cardcage.golden.scene_display_list import make_display_list
from cardcage.golden.specification.errors import InputError
from cardcage.testbenches.command_line.tables.plan_table import plan_table, plan_text
from cardcage.testbenches.command_line.tables.scene_plan import plan_facts, plan_scene
from cardcage.testbenches.render import RenderOptions, prepare_render

SCENE = "random:n=12,size=8,seed=5"
TINY = ["--cards", "PM", "--size", "16x16"]


@pytest.fixture(autouse=True)
def place(tmp_path, monkeypatch) -> Path:
    monkeypatch.chdir(tmp_path)
    return tmp_path


def test_text():
    """Every line has a number and a reason; nothing but the plan on the output."""
    result = run()
    assert result.exit_code == 0, result.output
    assert result.stderr == ""
    title, header, *lines = result.stdout.splitlines()
    assert title.startswith("teapot:tessellation=3: 552 triangles at 64x64")
    assert header.split() == ["plan", "full", "saves", "because"]
    items = [re.split(r" {2,}", line)[0] for line in lines]
    for item in ("coordinate bits", "edge column bits", "edge height bits", "fraction bits",
                 "stored depth bits", "interpolants", "lines", "words a memory unit", "FIFO depth"):
        assert item in items
    assert "each triangle broadcast" in result.stdout and "cycles" in result.stdout
    assert "draw it: cardcage render teapot:tessellation=3" in result.stdout
    assert not list(Path().iterdir())


def test_table_on_a_terminal(monkeypatch, capsys):
    monkeypatch.setenv("COLUMNS", "120")
    plan_table(plan_scene(SCENE, RenderOptions(cards="PM", size=(16, 16))))
    shown = capsys.readouterr().out
    assert f"{SCENE}: 12 triangles" in shown and "coordinate bits" in shown
    # The command is one line, to be copied.
    assert f"draw it: cardcage render {SCENE} --cards PM --size 16x16\n" in shown


def test_the_command_looks_at_the_scene_in_the_same_way():
    options = ["--view", "-20.5,90", "--zoom", 1.5, "--background", "navy", "--cull", "--light",
               "0.1,-2,3"]
    planned = facts("tetra:depth=1", *TINY, *options)
    words = shlex.split(planned["command"])
    assert "#000080" in words
    again = facts(*words[2:])
    assert again == planned
    assert facts("tetra:depth=1", *TINY)["needs"] != planned["needs"]


@pytest.mark.parametrize("options", [
    pytest.param([], marks=EVERY), ["--preset", "tiny", "--max-error", 2],
    pytest.param(["--fraction-bits", 5, "--shading", "flat", "--words", 64], marks=EVERY)])
def test_render_and_export_build_this_machine(options):
    planned = facts(SCENE, *TINY, *options)
    words = shlex.split(planned["command"])
    assert words[:3] == ["cardcage", "render", SCENE]
    machine = machine_of(planned)
    assert run(*words[2:], command="export").exit_code == 0
    exported = json.loads(Path("machine.json").read_text())
    for field in ("fraction_bits", "coordinate_bits", "edge_column_bits", "edge_height_bits",
                  "edge_fraction_bits", "depth_integer_bits", "channel_integer_bits", "shading",
                  "fifo_depth", "words"):
        assert exported["configuration"][field] == getattr(machine, field), field
    formats = {entry["name"]: entry["bits"] for entry in exported["number_formats"]}
    assert formats["edge"] == machine.edge_word_bits
    assert formats["depth_plane"] == machine.depth_plane_bits
    rendered = run(*words[2:], "--engine", "pysim", command="render")
    assert rendered.exit_code == 0, rendered.output
    assert rendered.stdout.startswith("equal")
    report = json.loads(Path("cardcage-out/report.json").read_text())
    for field in ("fraction_bits", "edge_column_bits", "edge_fraction_bits", "depth_plane_bits"):
        assert report["machine"][field] == getattr(machine, field)
    if "--max-error" in options:
        assert report["depth"]["max_error_lsb"] <= int(options[-1])


def test_json():
    planned = facts("tetra:depth=2", "--size", "32x32", "--cards", "PMM", "--max-error", 3)
    assert planned["machine"]["shading"] == "flat"
    assert planned["machine"]["channel_plane_bits"] is None
    assert planned["triangle_bits"]["planned"] < planned["triangle_bits"]["full"]
    assert planned["cells"] is None and planned["cycles"]["budget"] is None
    assert sum(planned["cycles"]["fragments"]) > 0
    needs = planned["needs"]
    listed = make_display_list("tetra:depth=2", width=32, height=32).display_list
    assert needs["triangles"] == listed.triangles
    lines = {line["item"]: line for line in planned["lines"]}
    assert lines["fraction bits"]["value"] == str(planned["machine"]["fraction_bits"])
    assert "at most 3 LSB" in lines["fraction bits"]["reason"]
    assert all(line["reason"] for line in lines.values())


def test_cards_for_cycles():
    slow, fast = (facts("sphereflake:depth=1", "--cycles", cycles) for cycles in (10**6, 6000))
    assert slow["machine"]["processing_elements"] == 1
    assert fast["cycles"]["estimated"] <= fast["cycles"]["budget"] == 6000
    assert slow["cycles"]["estimated"] > 6000
    assert "--cards" in fast["command"] and "--cycles" not in fast["command"]


def test_cells():
    planned = plan_scene("tetra:depth=1", RenderOptions(cards="PM", size=(8, 8)), count=True)
    counted = plan_facts(planned)["cells"]
    for kind in ("flip_flops", "gates", "multipliers", "memory"):
        assert 0 < counted["planned"][kind] < counted["full"][kind]
    assert (f"{counted['planned']['flip_flops']:,} instead of "
            f"{counted['full']['flip_flops']:,} flip-flops") in plan_text(planned)


def test_a_saved_list_keeps_its_size():
    make_display_list(SCENE, width=24, height=20).display_list.save("list.npz")
    machine = facts("list.npz", "--preset", "small")["machine"]
    assert (machine["width"], machine["height"]) == (24, 20)


def test_max_error_without_a_scene():
    """Export then promises it for every triangle on the screen."""
    result = run("--size", "16x16", "--cards", "PM", "--max-error", 1, command="export")
    assert result.exit_code == 0, result.output
    # (1 + 30) / 2**(F + 1) <= 1
    assert "fraction bits: 4, at most 1 LSB of depth off for every triangle" in result.stdout
    assert json.loads(Path("machine.json").read_text())["configuration"]["fraction_bits"] == 4


@pytest.mark.parametrize(("arguments", "words"), [
    *BAD_SCENES_AND_MACHINES,
    (["--max-error", "1", "--fraction-bits", "3"], "--max-error"),
    (["--max-error", "0", "--fraction-bits", "exact"], "--max-error"),
    (["--max-error", "-1"], "--max-error"),
    (["--max-error", "lots"], "--max-error"),
    (["--cycles", "0"], "--cycles"),
    (["--cycles", "10"], "too few"),
    (["--cycles", "99999", "--cards", "PM"], "leave out --cards"),
    (["--cycles", "99999", "--retain"], "leave out --retain"),
    (["--cycles", "99999", "--list-words", "9"], "--list-words"),
])
def test_refused(arguments, words):
    assert words in refusal(run, *arguments)


def test_a_list_too_wide_for_a_machine_is_refused_before_it_runs():
    """A machine of another scene: one line, which says what does not fit."""
    job = prepare_render("tetra:depth=1", RenderOptions(size=(16, 16), engine="pysim"))
    other = prepare_render("random:n=5,size=30", RenderOptions(size=(16, 16), engine="pysim"))
    with pytest.raises(InputError, match=r"display list: .* the machine is built for") as raised:
        replace(job, scene=other.scene).run()
    assert "\n" not in str(raised.value)


def test_help_teaches_by_example():
    shown = run("--help").stdout
    for example in re.findall(r"^ +(cardcage plan.*)$", shown, re.MULTILINE):
        words = shlex.split(example)
        assert words[:2] == ["cardcage", "plan"]
    assert shown.count("cardcage plan") >= 4
