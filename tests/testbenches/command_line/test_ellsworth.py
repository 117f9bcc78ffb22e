"""``cardcage figures ellsworth``: what it says, what it writes, and how it ends."""

from __future__ import annotations

import json
import re

import numpy as np
import pytest
from click.testing import CliRunner
from golden_machine import GoldenMachine
from PIL import Image, ImageColor
from refusals import refusal

from cardcage.golden.specification.commands import ResponseKind
from cardcage.testbenches.command_line.cli import main
from cardcage.testbenches.figures.ellsworth import in_rtl, overlap
from cardcage.testbenches.figures.ellsworth.charts import POINT_COLOR
from cardcage.testbenches.figures.ellsworth.claims import SQUARE
from cardcage.testbenches.figures.ellsworth.dealing.cures import CURES
from cardcage.testbenches.figures.ellsworth.dealing.models import FigureModel
from cardcage.testbenches.figures.ellsworth.ellsworth import EllsworthOptions, redraw_ellsworth
from cardcage.testbenches.figures.ellsworth.facts import PAPER
from cardcage.testbenches.figures.ellsworth.page import FIGURE_FILES

FACTS = ["paper", "command_line", "size", "equal", "differences", "processors", "ratios", "models",
         "costs", "timed_ratios", "sending", "overlaps", "cures", "best_cure",
         "best_cure_of_counters", "points", "claims", "overlap_claims", "findings", "wall_seconds"]

SCENE = "teapot:tessellation=3"
SMALL = (PAPER, "--frames", "2", "--size", "64x48", "--model", SCENE)


@pytest.fixture(autouse=True)
def place(tmp_path, monkeypatch):
    """Small machines, few triangles, and no other processes, which would not see them."""
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("CARDCAGE_CACHE", str(tmp_path / "cache"))
    monkeypatch.setattr("cardcage.testbenches.support.processes.cores", lambda: 1)
    monkeypatch.setattr(overlap, "COUNT", 500)
    monkeypatch.setattr(in_rtl, "POINT_PROCESSORS", (2, 4))
    return tmp_path


@pytest.fixture
def machine(monkeypatch):
    """Answers as the golden models say, unless it is told to be wrong."""
    def put(**changes):
        lists = list(FigureModel(SCENE, SCENE, 4, 4.5).lists((64, 48), 0, 4, lit=True))
        monkeypatch.setattr("cardcage.testbenches.engines.choose_engine.ENGINES",
                            {"pysim": lambda: GoldenMachine(lists, **changes)})
    return put


def run(*arguments):
    return CliRunner().invoke(main, ["figures", *map(str, arguments)])


def squares(path):
    """Whether the picture has any in the colour of what was measured."""
    with Image.open(path) as picture:
        pixels = np.asarray(picture.convert("RGB"))
    return (pixels == ImageColor.getrgb(POINT_COLOR)).all(axis=2).any()


def test_files_and_facts(place):
    result = run(*SMALL, "--model", "tetra", "--no-rtl", "--out", "out/page")
    assert result.exit_code == 0, result.output
    assert result.stdout.splitlines()[-1] == "page: out/page/ellsworth.html"
    assert {path.name for path in (place / "out/page").iterdir()} == set(FIGURE_FILES)
    facts = json.loads((place / "out/page/ellsworth.json").read_text("utf-8"))
    assert list(facts) == FACTS
    assert facts["paper"] == PAPER and facts["size"] == [64, 48] and facts["equal"]
    assert facts["processors"] == [2, 4, 8, 16] and facts["points"] == []
    assert [each["scene"] for each in facts["models"]] == [SCENE, "tetra"]
    for each in facts["models"]:
        assert each["frames"] == 2 and each["turn"] == 4.5 and each["claims"]
        for curves in each["utilisation"].values():
            assert list(curves) == ["1", "2", "3", "4", "6", "8", "12"]
            assert all(len(curve) == 4 and 0 < min(curve) <= max(curve) <= 1
                       for curve in curves.values())
        assert each["best_ratio"] in facts["timed_ratios"]
    assert [each["name"] for each in facts["cures"]] == [cure.name for cure in CURES]
    assert facts["best_cure"] in {cure.name for cure in CURES}
    page = (place / "out/page/ellsworth.html").read_text("utf-8")
    assert page.count("<svg") == 4 and "http" not in page.replace("http-equiv", "")
    assert "in RTL" not in page and SQUARE in page
    assert not squares(place / "out/page/ellsworth.png")
    for claim in (*facts["claims"], *facts["overlap_claims"]):
        assert claim["claim"] in result.stdout
    for line in facts["findings"]:
        assert line in result.stdout


def test_with_machines(place, machine):
    machine()
    result = run(*SMALL, "--engine", "pysim", "--json")
    assert result.exit_code == 0, result.output
    facts = json.loads(result.stdout)
    assert facts == json.loads((place / "cardcage-out/ellsworth.json").read_text("utf-8"))
    assert [point["processors"] for point in facts["points"]] == [2, 4]
    assert all(point["equal"] and point["utilisation"] == point["golden"]
               for point in facts["points"])
    page = (place / "cardcage-out/ellsworth.html").read_text("utf-8")
    assert "in RTL" in page and "every count as golden" in page
    assert squares(place / "cardcage-out/ellsworth.png")
    # Of one model as well, no chart is so narrow that the page blows its type up.
    assert min(map(float, re.findall(r'viewBox="0 0 ([0-9.]+) ', page))) > 500


def test_a_difference_is_status_1(machine):
    machine(change=lambda kind, number, value: value + (kind == ResponseKind.REGION_COUNT))
    result = run(*SMALL, "--engine", "pysim")
    assert result.exit_code == 1
    assert result.stdout.startswith(f"DIFFERENT: {SCENE} on 2 processors, frame 0: processing")


@pytest.mark.parametrize(("arguments", "word"), [
    (["--frames", "0"], "--frames: must be 1 to 1,000, not 0"),
    (["--frames", "1001"], "not 1001"),
    (["--size", "31x20"], "--size: 31x20 is too small for regions of 4x4 pixels; take 32x32"),
    (["--model", "random"], "--model: random is no mesh and cannot be turned; take a mesh"),
    (["--model", "teapott"], "did you mean teapot?"),
    (["--model", "tetra", "--model", "tetra"], "--model: the same scene twice"),
    (["--cells"], "--cells: is not for ellsworth"),
    (["--engine", "icarus"], "icarus"),
])
def test_bad_input(arguments, word):
    assert word in refusal(run, PAPER, "--no-rtl", *arguments)


def test_every_step_is_told():
    told = []
    options = EllsworthOptions(size=(32, 32), frames=13, models=["tetra"], simulate=False)
    found = redraw_ellsworth(options, step=told.append)
    assert len(told) == len(options.jobs()) + 1 == 2 + 4 + 1
    [model] = found.models
    assert len(model.found["drawn"]) == 13 and model.processors == [2, 4]
    assert len(options.jobs()) < len(EllsworthOptions(size=(32, 32), models=["tetra"]).jobs())
