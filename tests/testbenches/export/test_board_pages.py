"""The boards' reference pages say what the docstrings say."""

from pathlib import Path

import pytest

from cardcage.testbenches.export.board_pages import PAGES, board_page

FOLDER = Path(__file__).parents[3] / "docs" / "boards"
AGAIN = "python -m cardcage.testbenches.export.board_pages docs/boards"


@pytest.mark.parametrize("name", PAGES)
def test_the_page_is_what_the_docstrings_say(name):
    page = (FOLDER / f"{name}.md").read_text(encoding="utf-8")
    assert page == board_page(name), f"docs/boards/{name}.md is not up to date: run {AGAIN}"


@pytest.mark.parametrize("name", PAGES)
def test_every_port_is_explained(name):
    rows = [line.split(" | ") for line in board_page(name).splitlines() if line.startswith("| `")]
    assert rows
    assert not [row[0] for row in rows if not row[3].strip(" |")]


def test_no_page_is_of_no_board():
    assert sorted(path.stem for path in FOLDER.iterdir()) == sorted(PAGES)
