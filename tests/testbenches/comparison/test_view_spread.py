"""Several views of one scene on each cage: every one compared, and how far their figures spread."""

from __future__ import annotations

import json

import pytest
from click.testing import CliRunner
from refusals import refusal

from cardcage.testbenches.command_line.cli import main
from cardcage.testbenches.comparison.compare_cages import compare_cages
from cardcage.testbenches.comparison.comparison_facts import comparison_facts
from cardcage.testbenches.comparison.comparison_table import OF_VIEWS, comparison_text
from cardcage.testbenches.comparison.view_spread import Spread
from cardcage.testbenches.engines import choose_engine
from cardcage.testbenches.engines.pysim_engine import PysimEngine
from cardcage.testbenches.render_frames import render_frames

CAGES = ("2x(PM)", "2x(PMC)")
ASKED = {"size": (8, 8), "engine": "pysim", "retain": False, "processes": 1}


def test_spread():
    assert Spread.of([3, 1, 2]) == Spread(1, 2, 3)


@pytest.fixture(scope="module")
def comparison():
    return compare_cages("tetra:depth=1", CAGES, frames=3, turn=50.0, **ASKED)


def test_the_figures_are_those_of_the_pictures(comparison):
    assert comparison.identical
    for run, cards in zip(comparison.runs, CAGES, strict=True):
        alone = render_frames("tetra:depth=1", frames=3, turn=50.0, cards=cards, size=(8, 8),
                              engine="pysim")
        assert [view.draw for view in run.views] == [
            frame.simulation.draw_cycles for frame in alone.frames]
        assert [view.fragments for view in run.views] == [
            sum(work.fragments for work in frame.simulation.work) for frame in alone.frames]
        assert not any(view.differences for view in run.views)
    one, chain = comparison.runs
    assert {view.busiest_share for view in one.views} == {1.0}
    assert [view.sent for view in chain.views] == [64] * 3  # every pixel of a scan
    # The first view is the one of all other figures.
    assert (chain.views[0].fragments, chain.views[0].sent) == (chain.fragments,
                                                              chain.traffic.pixels)


def test_what_is_told(comparison):
    text = comparison_text(comparison)
    draw = [view.draw for view in comparison.runs[0].views]
    assert OF_VIEWS in text
    assert f"{min(draw):,} / {sum(draw) / 3:,.0f} / {max(draw):,}" in text
    facts = comparison_facts(comparison)["cages"]
    assert facts[1]["views"]["views"] == 3
    assert facts[0]["views"]["draw"] == {"least": min(draw), "mean": sum(draw) / 3,
                                         "greatest": max(draw)}


def test_a_view_that_differs(monkeypatch):
    class Wrong(PysimEngine):
        """Every whole scan of a sequence but the first ones has a wrong pixel."""

        def run(self, job, progress=None):
            found = super().run(job, progress)
            found.scans[-1].picture[3, 4] ^= 255
            return found

    monkeypatch.setattr(choose_engine, "ENGINES", {"pysim": Wrong})
    comparison = compare_cages("tetra:depth=0", ["PM"], frames=2, turn=50.0, **ASKED)
    assert not comparison.equal
    assert "PM: view 1: the picture differs from the golden one" in comparison.differences


def test_the_command(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    arguments = ["compare", "tetra:depth=0", "--cards", "PM", "--size", "8x8", "--engine", "pysim",
                 "--frames", "2", "--json"]
    result = CliRunner().invoke(main, arguments)
    assert result.exit_code == 0, result.output
    assert json.loads(result.stdout)["cages"][0]["views"]["views"] == 2
    assert OF_VIEWS[1:] in (tmp_path / "cardcage-out/comparison.html").read_text()


@pytest.mark.parametrize(("options", "message"), [
    (["--turn", "3"], "--turn: is for several views; give --frames as well"),
    (["--frames", "2", "--path", "none.csv"], "--path: none.csv: No such file or directory"),
    (["random", "--frames", "2", "--turn", "3"], "--turn: random is no mesh and cannot be turned"),
])
def test_bad_input(tmp_path, monkeypatch, options, message):
    monkeypatch.chdir(tmp_path)

    def run(*arguments):
        return CliRunner().invoke(main, [str(argument) for argument in arguments])

    assert message in refusal(run, "compare", *options)
