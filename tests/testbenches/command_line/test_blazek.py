"""``cardcage figures blazek``: what it says, what it writes, and how it ends."""

from __future__ import annotations

import json
from types import SimpleNamespace

import pytest
from click.testing import CliRunner
from refusals import refusal

from cardcage.golden.cycles.broadcast import SetupTiming
from cardcage.testbenches.command_line.cli import main
from cardcage.testbenches.figures.blazek.blazek import BlazekOptions
from cardcage.testbenches.figures.blazek.facts import PAPER
from cardcage.testbenches.figures.blazek.his_machine import sensitivity, times
from cardcage.testbenches.figures.blazek.his_machine.methods import Frame
from cardcage.testbenches.figures.blazek.our_machine import clocks, decompositions, in_rtl
from cardcage.testbenches.figures.blazek.page import FIGURE_FILES, SECTIONS
from cardcage.testbenches.figures.blazek.scenes.spheres import NODES, SPHERES

FACTS = ["paper", "command_line", "size", "equal", "differences", "nodes", "spheres", "his", "ours",
         "costs", "sensitivity", "points", "claims", "claims_by_spheres", "claims_of_all", "slips",
         "findings", "wall_seconds"]

SMALL = (PAPER, "--size", "64x64")


def frame(scene, nodes):
    """In place of his methods, which their own tests look at."""
    drawn = scene.spheres / nodes
    return Frame(drawn + nodes / 10, drawn, 0.9 * scene.spheres, 0.5 * drawn, scene.spheres)


@pytest.fixture(autouse=True)
def place(tmp_path, monkeypatch):
    """Few spheres, and no other processes, which would not see that."""
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("CARDCAGE_CACHE", str(tmp_path / "cache"))
    monkeypatch.setattr("cardcage.testbenches.support.processes.cores", lambda: 1)
    methods = dict.fromkeys(times.METHODS, frame)
    monkeypatch.setattr(times, "METHODS", methods)
    monkeypatch.setattr(sensitivity, "METHODS", methods)
    monkeypatch.setattr(decompositions, "FOLLOWED", 2)
    # As that of all these machines is; to ask each takes half a second.
    monkeypatch.setattr(decompositions, "setup_timing", lambda machine: SetupTiming(
        interval=3, latency=131, inside=45))
    monkeypatch.setattr(clocks, "merging_clocks", lambda *asked: [1000] * len(SPHERES))
    monkeypatch.setattr(in_rtl, "POINTS", ("broadcast, lines",))
    monkeypatch.setattr(in_rtl, "simulate_frame", lambda machine, listed, engine: SimpleNamespace(
        draw_cycles=12_345, merge_cycles=None))
    monkeypatch.setattr(in_rtl, "compare", lambda *compared: SimpleNamespace(equal=False))
    return tmp_path


def run(*arguments):
    return CliRunner().invoke(main, ["figures", *map(str, arguments)])


def test_files_and_facts(place):
    """The machine shows another picture than golden."""
    result = run(*SMALL, "--engine", "pysim", "--out", "out/page")
    assert result.exit_code == 1, result.output
    assert result.stdout.splitlines()[-1] == "page: out/page/blazek.html"
    assert result.stdout.startswith(
        "DIFFERENT: broadcast, lines on 4 nodes, 4 spheres: the picture differs")
    assert {path.name for path in (place / "out/page").iterdir()} == set(FIGURE_FILES)
    facts = json.loads((place / "out/page/blazek.json").read_text("utf-8"))
    assert list(facts) == FACTS
    assert facts["paper"] == PAPER and not facts["equal"]
    assert [point["drawing"] for point in facts["points"]] == [12_345, 12_345]
    for machine in ("his", "ours"):
        for name, curves in facts[machine].items():
            assert len(curves["time"]) == len(SPHERES) == len(curves["efficiency"])
            for time, speed_up, efficiency in zip(
                    curves["time"], curves["speed_up"], curves["efficiency"], strict=True):
                assert speed_up == pytest.approx([time[0] / each for each in time]), name
                assert efficiency == pytest.approx([each / nodes for each, nodes in zip(
                    speed_up, NODES, strict=True)])
        begins = {section.begins for section in SECTIONS}
        assert all(any(name.startswith(begin) for begin in begins) for name in facts[machine])
    page = (place / "out/page/blazek.html").read_text("utf-8")
    # Two charts a method, one of several places, one of costs.
    assert page.count("<svg") == 2 * len(SECTIONS) + 2
    assert "http" not in page.replace("http-equiv", "")
    assert "12,345" in page and "every picture as golden" not in page
    assert (place / "out/page/blazek.png").read_bytes().startswith(b"\x89PNG")
    for machine in ("his", "ours"):
        for claim in facts["claims"][machine]:
            assert claim["claim"] in result.stdout
    for line in facts["findings"]:
        assert line in result.stdout
    assert any("ms or more: of 0.03 pixels here." in line for line in facts["findings"])


@pytest.mark.parametrize(("arguments", "word"), [
    (["--size", "32x32"], "--size: 32x32 is not cut into 32 equal strips and rectangles; take"),
    (["--size", "96x128"], "take powers of two from 64 on, such as 512x512"),
    (["--frames", "3"], "--frames: is not for blazek; leave it out"),
    (["--cells"], "--cells: is not for blazek"),
])
def test_bad_input(arguments, word):
    assert word in refusal(run, PAPER, "--no-rtl", *arguments)


def test_every_part_is_a_job():
    jobs = BlazekOptions(simulate=False).jobs()
    assert len(BlazekOptions().jobs()) == len(jobs) + len(in_rtl.POINTS)
    assert len({repr(job) for job in jobs}) == len(jobs)
