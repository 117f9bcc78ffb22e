"""The report of several pictures: files, figures, the page; and the command that writes it."""

import io
import json
from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest
from click.testing import CliRunner
from PIL import Image
from refusals import refusal

from cardcage.golden.scenes.camera import View
from cardcage.testbenches.command_line.cli import main
from cardcage.testbenches.engines import choose_engine
from cardcage.testbenches.engines.pysim_engine import PysimEngine
from cardcage.testbenches.render_frames import render_frames
from cardcage.testbenches.reports.sequence_facts import sequence_facts
from cardcage.testbenches.reports.sequence_report import (
    SEQUENCE_FILES,
    animated_png,
    strip_places,
    write_sequence_report,
)

TINY = ["--cards", "PM", "--size", "16x16", "--engine", "pysim"]


def run(*arguments):
    return CliRunner().invoke(main, [str(argument) for argument in arguments])


@pytest.fixture(scope="module")
def rendering():
    return render_frames("tetra:depth=1", frames=3, turn=50.0, cards="PM", size=(16, 16),
                         engine="pysim", depth="all")


def test_figures(rendering):
    facts = sequence_facts(rendering.shown, rendering.frames, [View((1.0, 2.0))] * 3)
    assert facts["equal"] and facts["picture"] == 2
    assert facts["pixels"]["compared"] == facts["depth"]["compared"] == 3 * 256
    assert [frame["number"] for frame in facts["frames"]] == [0, 1, 2]
    for frame, drawn in zip(facts["frames"], rendering.frames, strict=True):
        assert frame["draw"] == drawn.simulation.draw_cycles
        assert frame["fragments"] == drawn.simulation.work[0].fragments > 0
        assert 0 < frame["efficiency"] <= 1
    assert facts["frames"][0]["clocks"] is None and facts["frames"][1]["clocks"] > 0
    assert facts["frames"][1]["a_picture_a_scan"] == (rendering.frames[0].scans == 1)
    for one, other in pairwise(facts["frames"]):
        assert one["first_scan"] + one["scans"] == other["first_scan"]
    json.dumps(facts)


def test_scans_that_the_machine_does_not_count(rendering, tmp_path):
    first, *others = rendering.frames
    views = [View((1.0, 2.0))] * 3
    pages = []
    for waited in (0, 3):
        frames = [replace(first, scans=first.scans + waited, scans_before_next_start=waited),
                  *others]
        write_sequence_report(rendering.shown, frames, views, tmp_path)
        pages.append(" ".join((tmp_path / "report.html").read_text("utf-8").split()))
        facts = json.loads((tmp_path / "report.json").read_text("utf-8"))
        assert [each["scans_before_next_start"] for each in facts["frames"]] == [waited, 0, None]
    assert "not yet begun" not in pages[0]
    assert ("1 picture stayed while the next one was not yet begun, for 3 scans in all" in pages[1]
            and "leaves these out: 0." in pages[1])


def test_the_animation_is_what_left_the_pins(rendering):
    with Image.open(io.BytesIO(animated_png(rendering.frames))) as picture:
        assert picture.is_animated and picture.n_frames == 3
        for number, frame in enumerate(rendering.frames):
            picture.seek(number)
            np.testing.assert_array_equal(np.asarray(picture.convert("RGB")),
                                          frame.simulation.video)


@pytest.mark.parametrize(("frames", "places"), [
    (1, [0]), (2, [0, 1]), (12, list(range(12))),
    (80, [0, 7, 14, 22, 29, 36, 43, 50, 57, 65, 72, 79])])
def test_the_strip_has_the_first_and_the_last(frames, places):
    assert strip_places(frames) == places


def test_the_command(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    result = run("render", "tetra:depth=1", *TINY, "--frames", 2, "--turn", 30, "--out", "report")
    assert result.exit_code == 0, result.output
    assert result.stdout.startswith("equal: 2 pictures, 512 colours and 256 depths compared, 0 d")
    assert sorted(path.name for path in (tmp_path / "report").iterdir()) == sorted(SEQUENCE_FILES)
    facts = json.loads((tmp_path / "report/report.json").read_text())
    (azimuth, elevation), second = (frame["view"] for frame in facts["frames"])
    assert second == [azimuth + 30, elevation]
    page = (tmp_path / "report/report.html").read_text()
    assert "2 pictures, one after another" in page and "http" not in page.replace("http-equiv", "")


def test_a_path(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "views.csv").write_text("azimuth,elevation,zoom\n0,0,1\n90,45,2\n")
    result = run("render", "tetra:depth=1", *TINY, "--path", "views.csv", "--depth", "all")
    assert result.exit_code == 0, result.output
    facts = json.loads((tmp_path / "cardcage-out/report.json").read_text())
    views = [(*frame["view"], frame["zoom"]) for frame in facts["frames"]]
    assert views == [(0, 0, 1), (90, 45, 2)]
    assert facts["depth"]["compared"] == 512


def test_a_picture_that_differs(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)

    class Wrong(PysimEngine):
        def run(self, job, progress=None):
            found = super().run(job, progress)
            found.scans[-1].picture[3, 4] ^= 255
            return found

    monkeypatch.setattr(choose_engine, "ENGINES", {"pysim": Wrong})
    result = run("render", "tetra:depth=1", *TINY, "--frames", 3)
    assert result.exit_code == 1
    assert result.stdout.startswith("DIFFERENT: 1 of 3 pictures, first picture 2\n")
    facts = json.loads((tmp_path / "cardcage-out/report.json").read_text())
    assert [frame["equal"] for frame in facts["frames"]] == [True, True, False]
    assert facts["equal"] is False and facts["picture"] == 2
    assert "<b>1 differ</b>" in (tmp_path / "cardcage-out/report.html").read_text()


@pytest.mark.parametrize(("options", "message"), [
    (["--turn", 3], "--turn: is for several pictures; give --frames as well"),
    (["--depth", "all"], "--depth: is for several pictures; give --frames as well"),
    (["--frames", 2, "--waveform", "w.vcd"], "--waveform: is of one picture; leave out --frames"),
    (["--frames", 0], "--frames"),
    (["--path", "none.csv"], "--path: none.csv: No such file or directory"),
    (["--frames", 2, "--out", "/dev/null/x"], "--out"),
])
def test_bad_input(tmp_path, monkeypatch, options, message):
    monkeypatch.chdir(tmp_path)
    assert message in refusal(run, "render", "tetra:depth=0", *TINY, *options)
