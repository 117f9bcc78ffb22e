"""``cardcage compare``: what it says, what it writes, and how it ends."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
from click.testing import CliRunner
from refusals import BAD_SCENES_AND_MACHINES, refusal

from cardcage.testbenches.command_line.cli import main
from cardcage.testbenches.comparison.comparison_report import COMPARISON_FILES

SCENE = "random:n=6,size=5,seed=5"
SMALL = [SCENE, "--size", "8x8", "--engine", "pysim"]


@pytest.fixture(autouse=True)
def place(tmp_path, monkeypatch) -> Path:
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("CARDCAGE_CACHE", str(tmp_path / "cache"))
    return tmp_path


def run(*arguments):
    return CliRunner().invoke(main, ["compare", *map(str, arguments)])


@pytest.fixture
def in_this_process(monkeypatch):
    """Where engines can be recorded or tampered with."""
    monkeypatch.setattr("cardcage.testbenches.support.processes.cores", lambda: 1)


def test_cages_in_processes_of_their_own(place, monkeypatch):
    monkeypatch.setattr("cardcage.testbenches.support.processes.cores", lambda: 2)
    result = run(*SMALL, "--cards", "PM", "--cards", "PMT", "--cards", "PMMM", "--immediate")
    assert result.exit_code == 0, result.output
    verdict, *_, last = result.stdout.splitlines()
    assert verdict.startswith("identical on all 2 cages: 64 colours and 64 depths")
    assert last == "report: cardcage-out/comparison.html"
    assert result.stderr.startswith("cardcage: warning: PMMM: cards: 3 memory units")
    assert result.stderr.count("\n") == 1
    assert {path.name for path in (place / "cardcage-out").iterdir()} == set(COMPARISON_FILES)
    page = (place / "cardcage-out" / "comparison.html").read_text("utf-8")
    assert "PMMM: cards: 3 memory units" in page


def test_json(place, draw, in_this_process):
    result = run(*SMALL, "--cards", "PM", "--json", "--out", "out")
    assert result.exit_code == 0, result.output
    facts = json.loads(result.stdout)
    assert facts == json.loads((place / "out" / "comparison.json").read_text("utf-8"))
    assert facts["identical"] and facts["command_line"].startswith("cardcage compare random:n=6")
    assert result.stderr == ""


def test_a_difference_is_status_1(recording, tampering, monkeypatch, in_this_process):
    engine = tampering(recording, colors={(1, 2): (1, 2, 3)})
    monkeypatch.setattr("cardcage.testbenches.engines.choose_engine.ENGINES",
                        {"pysim": lambda: engine})
    result = run(*SMALL, "--cards", "PM")
    assert result.exit_code == 1
    first = result.stdout.splitlines()[0]
    assert first.startswith("DIFFERENT: PM: 1 of 64 colours") and "x 1, y 2" in first


@pytest.mark.parametrize(("arguments", "words"), [
    *((arguments, words) for arguments, words in BAD_SCENES_AND_MACHINES
      if arguments[0] not in ("--cards", "--size", "--packet", "--queue")  # are for some cages
      or arguments[1] == "16"),
    ([SCENE, "--cards", "PMMM"], "no cage to compare: PMMM: cards: 3 memory units"),
    ([SCENE, "--nodes", "0"], "nodes"),
    ([SCENE, "--nodes", "1,65"], "nodes"),
    ([SCENE, "--engine", "none"], "engine"),
    ([SCENE, "--max-error", "1", "--fraction-bits", "3"], "--max-error"),
])
def test_what_is_wrong_is_one_line(arguments, words, in_this_process):
    assert words in refusal(run, *arguments)


def test_help_teaches_by_example():
    text = CliRunner().invoke(main, ["compare", "--help"]).stdout
    assert text.count("  cardcage compare") >= 6
    for option in ("--cards", "--retain / --immediate", "--nodes", "--cells", "--json", "--out"):
        assert option in text
