"""What a scene file says besides its picture: where the report goes, and how many nodes draw it."""

import json
from pathlib import Path

import pytest
from click.testing import CliRunner

from cardcage.golden.specification.errors import InputError
from cardcage.testbenches.command_line.cli import main
from cardcage.testbenches.comparison.compare_cages import DEFAULT_CARDS, default_cards

SCENE = "size 12x10\noutfile testout\nnodes 5\nobj cube scale 0.5 position 0,0,0 rot 1,1,0\n"


def test_the_report_goes_where_the_file_says_unless_told_otherwise(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    Path("a.scene").write_text(SCENE)
    for more, folder in (([], "testout"), (["--out", "other"], "other")):
        run = CliRunner().invoke(main, ["render", "a.scene", "--cards", "PM", "--engine", "pysim",
                                        *more])
        assert run.exit_code == 0, run.output
        facts = json.loads(Path(folder, "report.json").read_text())
        assert facts["equal"] and facts["pixels"]["compared"] == 120
    assert sorted(path.name for path in tmp_path.iterdir()) == ["a.scene", "other", "testout"]


def test_cages_that_are_compared_have_as_many_nodes_as_the_file_says(tmp_path):
    path = tmp_path / "a.scene"
    path.write_text(SCENE)
    assert default_cards(path) == ("8x(PMM)", "5x(PMMC)", "5x(PMMT)")
    path.write_text("obj cube")
    assert default_cards(path) == default_cards("teapot") == DEFAULT_CARDS
    path.write_text("obj cub")
    with pytest.raises(InputError, match="did you mean cube"):
        default_cards(path)
