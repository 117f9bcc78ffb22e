"""What reports tell of regions that are dealt out: figures, colours, charts."""

import io
import json

import numpy as np
import pytest
from golden_machine import GoldenMachine
from PIL import Image

from cardcage.golden.specification.commands import ResponseKind
from cardcage.testbenches.command_line.tables.render_summary import frames_summary
from cardcage.testbenches.engines import choose_engine
from cardcage.testbenches.machine_options import MachineOptions
from cardcage.testbenches.render import render
from cardcage.testbenches.render_frames import render_frames
from cardcage.testbenches.reports.region_pictures import element_colors, region_picture
from cardcage.testbenches.views.scene_frames import SceneFrames

SCENE = "tetra:depth=1"
MACHINE = {"cards": "3x(PM)", "size": (16, 16), "regions": (4, 4)}
TURN = {"frames": 3, "turn": 50.0}


@pytest.fixture
def answers(monkeypatch):
    """A function: the machine answers as golden says, or so changed."""

    def use(change=lambda kind, number, value: value):
        lists = SceneFrames(SCENE, MachineOptions(**MACHINE), path=None, **TURN)
        monkeypatch.setattr(choose_engine, "ENGINES",
                            {"golden": lambda: GoldenMachine(lists, change)})

    use()
    return use


def test_one_picture(answers, tmp_path):
    rendering = render(SCENE, out=tmp_path, engine="golden", **MACHINE)
    assert rendering.comparison.equal and not rendering.warnings
    regions = json.loads((tmp_path / "report.json").read_text())["regions"]
    assert (regions["columns"], regions["rows"], regions["region_width"]) == (4, 4, 4)
    assert regions["slots"] == 7 and regions["table"] == [region % 3 for region in range(16)]
    assert (regions["counted"], regions["balance"]) == ("clocks", "learnt") and regions["read"]
    assert regions["equal"] and not regions["table_read"] and regions["differences"] == []
    assert sum(regions["counts"]) == regions["total"] == sum(regions["per_pe"]) > 0
    assert regions["busiest"] == np.argmax(regions["per_pe"])
    assert regions["utilisation"] == regions["total"] / (3 * max(regions["per_pe"])) < 1
    assert regions["moved"] == sum(one != other for one, other in zip(
        regions["table"], regions["next_table"], strict=True)) > 0
    page = (tmp_path / "report.html").read_text()
    assert f"{100 * regions['utilisation']:.1f} %" in page and "entry by entry" in page
    assert "none: regions" in page and "clocks that it foretells from the last three" in page


def test_a_sequence(answers, tmp_path):
    rendering = render_frames(SCENE, out=tmp_path, engine="golden", **TURN, **MACHINE,
                              balancer="hardware")
    assert rendering.equal
    facts = json.loads((tmp_path / "report.json").read_text())
    told = [frame["regions"] for frame in facts["frames"]]
    assert [each["utilisation"] for each in told] == [frame.regions.utilisation
                                                      for frame in rendering.frames]
    assert all(each["equal"] and each["table_read"] for each in told)
    assert "table" not in told[0]  # there may be ten thousand pictures
    assert facts["regions"]["table"] == rendering.frames[-1].regions.table.tolist()
    page = (tmp_path / "report.html").read_text()
    assert page.count('alt="Regions of picture') == 3 and "Utilisation of the" in page
    assert facts["regions"]["balance"] == "clocks" and "clocks of the picture before" in (
        " ".join(page.split()))


def test_a_count_that_is_not_goldens(answers, tmp_path):
    """No fault of a picture: it is warned of, and not all is equal."""
    answers(lambda kind, number, value: value + (kind == ResponseKind.REGION_COUNT
                                                 and number == 21 + 3))
    rendering = render_frames(SCENE, out=tmp_path, engine="golden", **TURN, **MACHINE)
    assert all(frame.equal for frame in rendering.frames) and not rendering.equal
    [line] = rendering.shown.warnings
    assert line.startswith("picture 1: processing element 0 counted ")
    assert "; COUNTS DIFFER in 1 picture\n" in frames_summary(rendering)
    facts = json.loads((tmp_path / "report.json").read_text())
    assert [frame["regions"]["equal"] for frame in facts["frames"]] == [True, False, True]


def test_without_regions(tmp_path):
    rendering = render(SCENE, cards="PM", size=(16, 16), engine="pysim", out=tmp_path)
    assert rendering.regions is None
    assert json.loads((tmp_path / "report.json").read_text())["regions"] is None
    assert "dealt out" not in (tmp_path / "report.html").read_text()


def test_colours(answers):
    figures = render(SCENE, engine="golden", **MACHINE).regions
    white = np.full((16, 16, 3), 255, np.uint8)
    shown = region_picture(figures, white)
    colors = np.rint(255 * element_colors(3)).astype(np.uint8)
    for (row, column), region in np.ndenumerate(np.arange(16).reshape(4, 4)):
        inside = shown[4 * row + 1:4 * row + 4, 4 * column + 1:4 * column + 4]
        assert (inside == colors[figures.table[region]]).all()
    # The sides between regions are darker, those of the screen are not.
    assert (shown[4, 1:4].sum(axis=-1) < shown[5, 1:4].sum(axis=-1)).all()
    assert (shown[0, 1:4] == shown[1, 1:4]).all()
    assert len({tuple(color) for color in element_colors(64).round(3)}) == 64
    Image.fromarray(region_picture(figures, white // 3)).save(io.BytesIO(), "PNG")
