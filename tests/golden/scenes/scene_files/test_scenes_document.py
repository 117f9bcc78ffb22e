"""docs/scenes.md has every word of the language, as the tables have it."""

from pathlib import Path

from cardcage.golden.scenes.scene_files.examples import EXAMPLES, example_path
from cardcage.golden.scenes.scene_files.language import (
    KINDS,
    MESH_FILE,
    OBJECT_WORDS,
    VIEW_WORDS,
)

PAGE = (Path(__file__).parents[4] / "docs" / "scenes.md").read_text(encoding="utf-8")


def test_every_word_has_its_line():
    for word in (*VIEW_WORDS.values(), *OBJECT_WORDS.values(), MESH_FILE):
        line = f"| `{word.name}` | {word.value.form} | {word.meaning} | `{word.example}` |"
        assert PAGE.count(line) == 1, word.name


def test_every_kind_and_example_is_named_and_his_stands_whole():
    assert all(f"| `{kind}` | {meaning} |" in PAGE for kind, meaning in KINDS.items())
    assert all(f"`{name}`" in PAGE for name in EXAMPLES)
    assert example_path("three_cubes").read_text(encoding="utf-8").strip() in PAGE
