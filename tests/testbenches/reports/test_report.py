"""The report is complete, in itself and in its figures."""

from __future__ import annotations

import json
import re
from html.parser import HTMLParser

import numpy as np
import pytest
from matplotlib.colors import to_rgb
from PIL import Image
from suite.cases import EVERY

from cardcage.golden.specification.activity import Activity
from cardcage.golden.specification.configuration import MachineConfiguration
from cardcage.golden.specification.display_list import DisplayList
from cardcage.testbenches.engines.activity_record import ACTIVITY_KINDS, activity_record
from cardcage.testbenches.frames.responses import Work
from cardcage.testbenches.reports.activity_chart import (
    activity_chart,
    timeline_chart,
    timeline_picture,
)
from cardcage.testbenches.reports.card_groups import card_groups
from cardcage.testbenches.reports.frame_pictures import DIFFERENT_COLOR, color_difference
from cardcage.testbenches.reports.frame_report import REPORT_FILES
from cardcage.testbenches.reports.work_chart import work_chart

VOID = {"meta", "img", "br", "link", "input", "hr"}


class Page(HTMLParser):
    """Collects tags and checks that they close in order."""

    def __init__(self, text: str) -> None:
        super().__init__()
        self.tags: list[tuple[str, dict]] = []
        self.open: list[str] = []
        self.feed(text)
        assert not self.open

    def handle_starttag(self, tag, attributes):
        self.tags.append((tag, dict(attributes)))
        if tag not in VOID:
            self.open.append(tag)

    def handle_startendtag(self, tag, attributes):
        self.tags.append((tag, dict(attributes)))

    def handle_endtag(self, tag):
        assert self.open.pop() == tag

    def of(self, tag: str) -> list[dict]:
        return [attributes for name, attributes in self.tags if name == tag]


def pixels(path) -> np.ndarray:
    with Image.open(path) as image:
        return np.asarray(image)


@pytest.fixture
def folder(draw, tmp_path):
    draw(out=tmp_path / "report")
    return tmp_path / "report"


@pytest.fixture
def wrong(draw, recording, tampering, tmp_path):
    """A report of a frame with a wrong colour and, further down, a wrong depth."""
    engine = tampering(recording, colors={(6, 5): (1, 2, 3)}, depths={16 * 9 + 4: 77})
    draw(engine, out=tmp_path / "wrong")
    return tmp_path / "wrong"


def test_files(folder):
    assert sorted(file.name for file in folder.iterdir()) == sorted(REPORT_FILES)
    assert DisplayList.load(folder / "display_list.npz").triangles == 12
    rtl, golden, difference = (pixels(folder / name)
                               for name in ("rtl.png", "golden.png", "difference.png"))
    assert rtl.shape == difference.shape == (16, 16, 3)
    assert np.array_equal(rtl, golden)
    assert (difference.min(axis=2) == difference.max(axis=2)).all()  # grey all over


def test_json_keys(folder):
    facts = json.loads((folder / "report.json").read_text())
    assert facts["equal"] is True
    assert facts["pixels"] == {"compared": 256, "different": 0, "orphans": 0}
    assert facts["depth"] == {"compared": 256, "different": 0, "orphans": 0, "max_error_lsb": 0}
    assert facts["color"] == {"max_error": 0}
    machine = facts["machine"]
    assert machine["cards"] == "PM"
    assert machine["memory_units"] == machine["processing_elements"] == 1
    assert (machine["sub_bits"], machine["depth_bits"]) == (8, 24)
    assert machine["fraction_bits"] == machine["exact_fraction_bits"] > 0
    assert (machine["width"], machine["height"]) == (16, 16)
    assert facts["triangles"] == 12
    assert facts["fragments"] == sum(element["fragments"] for element in facts["per_pe"]) > 0
    cycles = facts["cycles"]
    assert cycles["total"] > cycles["boot"] + cycles["draw"] > cycles["boot"] > 0
    assert facts["efficiency"] == pytest.approx(facts["fragments"] / cycles["draw"])
    assert set(facts["per_pe"][0]) == {"node", "first_unit", "units", "fragments", "busy"}
    assert facts["per_pe"][0]["busy"] <= cycles["draw"] + 20
    activity = facts["activity"]
    assert 0 < activity["clocks"] - cycles["draw"] < 8
    assert activity["per_pe"][0]["fragment"] == facts["fragments"]
    assert sum(activity["per_pe"][0].values()) == activity["clocks"]
    assert {name: sum(counts) for name, counts in activity["timeline"].items()} == (
        activity["per_pe"][0])
    assert sum(activity["shares"].values()) == pytest.approx(1)
    assert facts["engine"] == "pysim"
    assert facts["simulated_cycles_per_second"] > 0
    assert facts["wall_seconds"] > 0
    assert facts["first_difference"] is None


@pytest.mark.parametrize(("cards", "links"), [
    ("PMCPMC", 1), pytest.param("PMSPMSFF", 2, marks=EVERY),
    pytest.param("PPDMM", 2, marks=EVERY)])
def test_what_nodes_sent(draw, tmp_path, cards, links):
    rendering = draw(cards=cards, out=tmp_path / "report")
    facts = json.loads((tmp_path / "report" / "report.json").read_text())
    merging, machine = facts["merging"], facts["machine"]
    assert merging["equal"] and merging["pixels"] == merging["golden_pixels"]
    assert sum(pixels > 0 for pixels in merging["pixels"]) == links
    assert merging["total_bits"] == sum(merging["pixels"]) * merging["pixel_bits"]
    assert (machine["nodes"], machine["frame_units"]) == (2, cards.count("F"))
    assert machine["memory_units"] == machine["total_units"] == cards.count("M")
    text = (tmp_path / "report" / "report.html").read_text(encoding="utf-8")
    Page(text)
    assert ("Frame units" in text) == ("F" in cards)
    assert ("Just behind one of their pixel" in text) == ("D" in cards)
    if "S" in cards:  # all on one bus
        assert merging["busiest_link_pixels"] == sum(merging["pixels"])
    if "D" in cards:
        fragments = [element["fragments"] for element in facts["per_pe"]]
        assert merging["pixels"] == fragments and merging["taken_equal"]
        assert merging["taken"] == merging["golden_taken"] == list(rendering.simulation.taken)
        assert sum(merging["taken"]) == sum(fragments) >= sum(merging["followed"])
        assert merging["busiest_link_pixels"] == max(*fragments, *merging["taken"])
    else:
        assert "taken" not in merging


@pytest.mark.parametrize("which", ["folder", "wrong"])
def test_page_is_complete_in_itself(which, request):
    text = (request.getfixturevalue(which) / "report.html").read_text(encoding="utf-8")
    page = Page(text)
    assert not re.search(r"https?:|src=\"(?!data:)|url\((?!#)|@import|<script|<link", text)
    images = page.of("img")
    assert len(images) == 6
    assert all(image["src"].startswith("data:image/png;base64,") for image in images)
    assert all(image["alt"] for image in images)
    assert len(page.of("svg")) == 3
    assert "prefers-color-scheme: dark" in text


def test_verdicts(folder, wrong):
    good, bad = ((place / "report.html").read_text(encoding="utf-8") for place in (folder, wrong))
    assert "Equal: 256 colours and 256 depths compared" in good
    assert "first pixel that differs" not in good
    assert "Different: 1 of 256 colours" in bad
    assert "The first pixel that differs: x 6, y 5" in bad
    assert "#010203" in bad


def test_first_difference_in_json(wrong):
    facts = json.loads((wrong / "report.json").read_text())
    assert facts["equal"] is False
    assert (facts["pixels"]["different"], facts["depth"]["different"]) == (1, 1)
    first = facts["first_difference"]
    assert first["pixel"] == first["machine_pixel"] == [6, 5]
    assert first["got"]["color"] == [1, 2, 3]
    assert first["got"]["depth"] == first["expected"]["depth"]
    assert first["fragments"]
    seen = [fragment for fragment in first["fragments"]
            if fragment["primitive"] == first["expected"]["primitive"]]
    assert seen == [{"primitive": first["expected"]["primitive"],
                     "depth": first["expected"]["depth"], "color": first["expected"]["color"]}]


def test_difference_picture(wrong):
    difference = pixels(wrong / "difference.png")
    red = (difference == DIFFERENT_COLOR).all(axis=2)
    assert [tuple(place) for place in np.argwhere(red)] == [(5, 6)]


def test_difference_spreads_for_the_page(draw, recording, tampering):
    """In a picture shown smaller than it is, a lone red pixel would be lost."""
    rendering = draw(tampering(recording, colors={(0, 0): (1, 2, 3), (9, 7): (4, 5, 6)}))
    red = (color_difference(rendering, 1) == DIFFERENT_COLOR).all(axis=2)
    assert red[:2, :2].all() and red[6:9, 8:11].all()
    assert red.sum() == 4 + 9


def test_text_from_outside_is_escaped(draw, tmp_path):
    mesh = tmp_path / "<i>&.obj"
    mesh.write_text("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n")
    draw(scene=mesh, out=tmp_path / "report")
    text = (tmp_path / "report" / "report.html").read_text(encoding="utf-8")
    assert "&lt;i&gt;&amp;.obj" in text
    assert "<i>" not in text


def test_coarser_and_approximate(draw, tmp_path):
    draw(words=64, fraction_bits=2, out=tmp_path / "report")
    text = (tmp_path / "report" / "report.html").read_text(encoding="utf-8")
    assert "the picture is coarser" in text
    assert "held to its bit-true model" in text
    assert pixels(tmp_path / "report" / "rtl.png").shape == (16, 16, 3)


def test_card_groups():
    def groups(cards):
        found = card_groups(MachineConfiguration(cards, 8, 8, allow_orphans=True))
        assert all(len(group.styles) == len(group.cards) for group in found)
        return [(" ".join(f"{letter}{number}" for letter, number in group.cards), group.caption)
                for group in found]

    assert groups("MPMMPPM") == [
        ("M0", "owned by nobody"), ("P0 M1 M2", "owns 1 to 2"), ("P1", "owns none"),
        ("P2 M3", "owns 3")]
    assert groups("2x(PMMS)FF") == [
        ("P0 M0 M1", "owns 0 to 1"), ("S0", "ends node 0"), ("P1 M0 M1", "owns 0 to 1"),
        ("S1", "ends node 1"), ("F0 F1", "keep the merged picture")]
    assert groups("PPDMM") == [
        ("P0", "node 0"), ("P1", "node 1"), ("D0 M0 M1", "of all elements")]


@pytest.mark.parametrize("elements", [1, 3, 100])
def test_activity_charts(elements):
    samples = [sum(clock % 9 << 4 * element for element in range(elements))
               for clock in range(1000)]
    record = activity_record(5, samples, elements)
    for svg in (activity_chart(record), timeline_chart(record)):
        Page(svg)
        assert svg.startswith("<svg") and "http" not in svg
        assert ("PE 0" in svg) == (elements <= 24)


def test_the_timeline_shows_who_did_what_when():
    """Two elements: one draws first and then waits, the other half and half all the time."""
    fragment, scan = Activity.FRAGMENT, Activity.SCAN
    first = [fragment] * 512 + [scan] * 512
    second = [fragment, scan] * 512
    samples = [one | other << 4 for one, other in zip(first, second, strict=True)]
    picture = timeline_picture(activity_record(0, samples, 2))
    assert picture.shape == (32, 256, 4)
    draws, waits = (tuple(round(255 * part) for part in to_rgb(kind.color))
                    for kind in ACTIVITY_KINDS if kind.activity in (fragment, scan))
    assert {tuple(dot) for dot in picture[2:16, :128, :3].reshape(-1, 3)} == {draws}
    assert {tuple(dot) for dot in picture[2:16, 128:, :3].reshape(-1, 3)} == {waits}
    assert {tuple(dot) for dot in picture[24:, :, :3].reshape(-1, 3)} == {draws}
    assert {tuple(dot) for dot in picture[18:24, :, :3].reshape(-1, 3)} == {waits}
    assert not picture[[0, 1, 16, 17], :, 3].any()


@pytest.mark.parametrize("elements", [1, 3, 100])
def test_chart(elements):
    svg = work_chart([Work(0, unit, 1, 1000 * unit, 2000 * unit) for unit in range(elements)])
    Page(svg)
    assert svg.startswith("<svg") and svg.endswith("</svg>")
    assert "http" not in svg
    assert "currentColor" in svg
    assert ("PE 0" in svg) == (elements <= 24)
