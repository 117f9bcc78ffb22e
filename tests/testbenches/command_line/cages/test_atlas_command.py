"""``cardcage atlas``: what it says, what it writes, and how it ends."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
from click.testing import CliRunner
from refusals import refusal

from cardcage.testbenches.atlas.atlas_report import ATLAS_FILES
from cardcage.testbenches.command_line.cli import main

SMALL = ["tetra:depth=1", "--size", "16x16", "--processes", "1", "--cages", "PM", "--cages",
         "2x(PMC)", "--cages", "PMMM"]


@pytest.fixture(autouse=True)
def place(tmp_path, monkeypatch) -> Path:
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("CARDCAGE_CACHE", str(tmp_path / "cache"))
    return tmp_path


def run(*arguments):
    return CliRunner().invoke(main, ["atlas", *map(str, arguments)])


def test_a_map_and_the_same_once_more(place):
    result = run(*SMALL, "--fraction-bits", "0,exact")
    assert result.exit_code == 0, result.output
    verdict, *_, last = result.stdout.splitlines()
    assert verdict == "6 points, 6 by the models"
    assert last == "report: cardcage-out/atlas.html"
    assert result.stderr.startswith("cardcage: warning: tetra:depth=1 on PMMM, 2 points: cards: "
                                    "3 memory units")
    assert result.stderr.count("\n") == 1
    assert {path.name for path in (place / "cardcage-out").iterdir()} == set(ATLAS_FILES)
    facts = json.loads((place / "cardcage-out" / "atlas.json").read_text("utf-8"))
    coarse, exact = facts["points"][:2]
    assert coarse["draw"] == exact["draw"] and coarse["cells"] < exact["cells"]
    assert exact["error"]["depth_anywhere"] == 0 < coarse["error"]["depth_anywhere"]
    again = run(*SMALL, "--fraction-bits", "0,exact", "--json", "--out", "again")
    assert again.exit_code == 0, again.output
    found = json.loads(again.stdout)
    assert found["recalled"] == 6 and found["points"] == facts["points"]
    assert found["map"] == facts["map"]
    for name in ("atlas.csv", "atlas.png"):
        assert (place / "again" / name).read_bytes() == (
            place / "cardcage-out" / name).read_bytes()


@pytest.mark.parametrize(("arguments", "words"), [
    (["no-such-scene"], "no-such-scene"),
    (["tetra", "--nodes", "65"], "nodes"),
    (["tetra", "--cages", "PMMM"], "no such machine can be built: cards: 3 memory units"),
    (["tetra", "--cages", "PQ"], "no card"),
    (["tetra", "--size", "16"], "'16' is not a width and a height"),
    (["tetra", "--fraction-bits", "some"], "'some'"),
    (["tetra", "--cages", "PM", "--check-node"], "--check-node"),
    (["tetra", "--cluster", "tcp://127.0.0.1:1", "--processes", "2"], "--processes"),
    (["tetra", "--engine", "none"], "engine"),
    (["three_cubes", "--cages", "2x(PMT)@node"], "cage: 2x(PMT)@node: 'node' is no place where "
     "triangles of objects are made, which comes last, as in 4x(PMM)/1x4@elements; did you mean "
     "nodes?"),
    (["tetra", "--cages", "2x(PMT)@nodes"], "no such machine can be built: objects: only a scene "
     "file without perspective has them"),
    (["three_cubes", "--cages", "2x(PMT)@nodes", "--check-node"], "--check-node: there is no chain "
     "or tree with lists"),
])
def test_what_is_wrong_is_one_line(arguments, words):
    assert words in refusal(run, *arguments)


def test_help_teaches_by_example():
    text = CliRunner().invoke(main, ["atlas", "--help"]).stdout
    assert text.count("  cardcage atlas") >= 6
    for cage in ("4x(PMMT)@nodes", "4x(PMM)/4x4@elements", "4x(PMM)@controller"):
        assert f"--cages '{cage}'" in text
    for option in ("--cages", "--nodes", "--simulate", "--check-node", "--cluster", "--json"):
        assert option in text
