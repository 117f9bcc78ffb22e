"""``cardcage figures``: what it says, what it writes, and how it ends."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path

import pytest
from click.testing import CliRunner
from refusals import refusal
from suite.cases import EVERY

from cardcage.testbenches.command_line.cli import main
from cardcage.testbenches.command_line.figures_command import PAPERS
from cardcage.testbenches.figures import cox_hanrahan, figure_scenes, papers
from cardcage.testbenches.figures.cox_hanrahan import FiguresOptions, redraw_cox_hanrahan
from cardcage.testbenches.figures.cox_hanrahan_facts import PAPER
from cardcage.testbenches.figures.cox_hanrahan_page import FIGURE_FILES
from cardcage.testbenches.figures.figure_scenes import FigureScene
from cardcage.testbenches.figures.merge_costs import MergeCage
from cardcage.testbenches.figures.paper_table import paper_rows

FACTS = ["paper", "command_line", "size", "equal", "differences", "table", "paper_table",
         "contradictions", "nodes", "traffic", "area_of_equation_4", "claims", "assignments",
         "merges", "points", "wall_seconds"]


@pytest.fixture(scope="module")
def kept(tmp_path_factory):
    return tmp_path_factory.mktemp("cache")


@pytest.fixture(autouse=True)
def place(tmp_path, kept, recording, monkeypatch) -> Path:
    """Small meshes, small cages, and no other processes, which would not see them."""
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("CARDCAGE_CACHE", str(kept))
    monkeypatch.setattr("cardcage.testbenches.support.processes.cores", lambda: 1)
    monkeypatch.setattr("cardcage.testbenches.engines.choose_engine.ENGINES",
                        {"pysim": lambda: recording})
    monkeypatch.setattr(figure_scenes, "MESHES", {"teapot": "random:n=12,size=5,seed=5"})
    monkeypatch.setattr(figure_scenes, "paper_rows", lambda: tuple(
        replace(row, triangles=60 * row.triangles) for row in paper_rows()))
    monkeypatch.setattr(cox_hanrahan, "CAGES", (
        MergeCage("T", "2x(PMT)", {"P": "element", "M": "unit-of-tree", "T": "tree-merge"}),))
    monkeypatch.setattr(cox_hanrahan, "POINT_SCENE", FigureScene("few", "random:n=9,size=5,seed=5"))
    monkeypatch.setattr(cox_hanrahan, "POINT_SIZE", (8, 8))
    monkeypatch.setattr(cox_hanrahan, "POINT_NODES", (2,))
    return tmp_path


def run(*arguments):
    return CliRunner().invoke(main, ["figures", *map(str, arguments)])


def test_files_and_facts(place):
    result = run("cox-hanrahan", "--no-rtl", "--size", "24x16", "--out", "out/page")
    assert result.exit_code == 0, result.output
    assert result.stdout.splitlines()[-1] == "page: out/page/cox-hanrahan.html"
    assert {path.name for path in (place / "out/page").iterdir()} == set(FIGURE_FILES)
    facts = json.loads((place / "out/page/cox-hanrahan.json").read_text("utf-8"))
    assert list(facts) == FACTS
    assert facts["paper"] == PAPER and facts["size"] == [24, 16]
    assert facts["equal"] and facts["merges"] == [] == facts["points"]
    assert facts["command_line"].startswith("cardcage figures cox-hanrahan --no-rtl")
    names = [row["scene"] for row in facts["table"]]
    assert names == [each["scene"] for each in facts["traffic"]]
    assert {"teapot", "random as Cube", "background first", "background last"} <= set(names)
    for each in facts["traffic"]:
        assert set(each["observed"]) == {"round robin", "contiguous", "shuffled"}
        for observed in each["observed"].values():
            assert len(observed["sent"]) == len(observed["busiest_node_share"]) == 7
            assert observed["sent"][0] == each["least"] <= max(observed["sent"]) <= each["maximum"]
        assert each["claims"]
    assert {each["scene"] for each in facts["assignments"]["maps"]} == {
        "teapot", "background first", "random as Wash.ht"}
    assert len(facts["contradictions"]) == 3
    assert (place / "out/page/cox-hanrahan.png").read_bytes().startswith(b"\x89PNG")
    page = (place / "out/page/cox-hanrahan.html").read_text("utf-8")
    assert page.count("<svg") == len(names) + 1 and "http" not in page.replace(
        "http-equiv", "")
    assert "Came out" in page and "10.0 times more than printed" in page
    assert "All merges" not in page
    for claim in facts["claims"]:
        assert claim["claim"] in result.stdout


@EVERY
def test_with_machines(place):
    result = run("cox-hanrahan", "--size", "12x12", "--engine", "pysim", "--json")
    assert result.exit_code == 0, result.output
    facts = json.loads(result.stdout)
    assert facts == json.loads((place / "cardcage-out/cox-hanrahan.json").read_text("utf-8"))
    [merge] = facts["merges"]
    assert merge["cards"] == "2x(PMT)" and merge["scene"] == "teapot"
    assert merge["cage"]["equal"] and merge["cage"]["cycles"]["merge"] > 0
    assert merge["merge_card"] is None
    assert [(point["cards"], point["nodes"], point["assignment"]) for point in facts["points"]] == [
        ("2x(PMMS)FF", 2, "round robin"), ("2x(PMMS)FF", 2, "contiguous")]
    assert all(point["equal"] and point["sent"] == point["golden"] for point in facts["points"])
    page = (place / "cardcage-out/cox-hanrahan.html").read_text("utf-8")
    assert "All merges" in page and "--cells" in page and "Measured in RTL: few" in page


def test_a_difference_is_status_1(recording, monkeypatch):
    class Miscounting:
        name = "pysim"

        def run(self, job, progress=None):
            found = recording.run(job, progress)
            return replace(found, scans=[replace_scan(scan) for scan in found.scans])

    def replace_scan(scan):
        return scan._replace(picture=scan.picture // 2) if hasattr(scan, "_replace") else replace(
            scan, picture=scan.picture // 2)

    monkeypatch.setattr("cardcage.testbenches.engines.choose_engine.ENGINES",
                        {"pysim": Miscounting})
    monkeypatch.setattr("cardcage.testbenches.figures.merge_costs.measured_once",
                        lambda parts, measure: measure())
    result = run("cox-hanrahan", "--size", "12x12", "--engine", "pysim")
    assert result.exit_code == 1
    assert result.stdout.startswith("DIFFERENT: 2x(PMT), teapot: ")


@pytest.mark.parametrize(("arguments", "word"), [
    ([], "PAPER"),
    (["cox"], "cox-hanrahan"),
    (["cox-hanrahan", "--size", "16"], "width and a height"),
    (["cox-hanrahan", "--no-rtl", "--size", "2048x2048"], "memory units"),
    (["cox-hanrahan", "--no-rtl", "--size", "8x16"], "Brooks; take 11x11 at least"),
    (["cox-hanrahan", "--engine", "icarus"], "icarus"),
    (["cox-hanrahan", "--frames", "3"], "--frames: is not for cox-hanrahan"),
    (["cox-hanrahan", "--model", "teapot"], "--model: is not for cox-hanrahan"),
])
def test_bad_input(arguments, word):
    assert word in refusal(run, *arguments)


def test_a_file_where_the_folder_should_be(place):
    Path("there").write_text("mine")
    assert "--out: there is a file" in refusal(run, "cox-hanrahan", "--no-rtl", "--out", "there")


def test_help_and_papers():
    text = CliRunner().invoke(main, ["figures", "--help"]).stdout
    assert all(f"cardcage figures {paper}" in text for paper in PAPERS)
    assert tuple(papers.PAPERS) == PAPERS and PAPER in PAPERS


def test_every_step_is_told():
    told = []
    options = FiguresOptions(size=(16, 16), simulate=False, scenes=["teapot", "random as Rad"])
    found = redraw_cox_hanrahan(options, step=told.append)
    assert len(told) == len(options.jobs()) + 1 == 4
    assert [scene.name for scene in found.scenes] == ["teapot", "random as Rad"]
