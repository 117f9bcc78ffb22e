"""Scene files: what is read, and one line for whatever is wrong."""

import random
import re
from pathlib import Path

import numpy as np
import pytest

from cardcage.golden.reference.exact import draw
from cardcage.golden.scenes.quantise import PictureFormat
from cardcage.golden.scenes.scene_files.description import ObjectDefinition, SceneDescription
from cardcage.golden.scenes.scene_files.examples import EXAMPLE_FOLDER, EXAMPLES, example_path
from cardcage.golden.scenes.scene_files.language import (
    KINDS,
    MESH_FILE,
    OBJECT_WORDS,
    PERSPECTIVE_WORDS,
    VIEW_WORDS,
    reference,
)
from cardcage.golden.scenes.scene_files.parse import parse_scene_text, read_scene_file
from cardcage.golden.scenes.scene_files.placed_objects import placed_objects
from cardcage.golden.scenes.scene_files.scene_file import SceneFile
from cardcage.golden.specification.errors import InputError

PATH = Path("folder/a.scene")
SEED = 20261130


def parse(text):
    return parse_scene_text(text, PATH)


def test_blazeks_example_says_what_his_figure_says():
    scene = read_scene_file(example_path("three_cubes"))
    assert scene == SceneDescription(
        path=example_path("three_cubes"), ambient=40.0, background=(0, 0, 0),
        light=(-1.0, 1.0, 1.0), nodes=16, overlay=(128, 128, 128), outfile="testout", percent=1.0,
        objects=(
            ObjectDefinition("cube", seed=1, line=20, rotation=(0.0, 1.9, 0.0),
                             scale=(0.4, 0.4, 0.4), number=3, color=(255, 0, 0)),
            ObjectDefinition("sphere", seed=2, line=21, scale=(0.15, 0.15, 0.15), recursion=5,
                             color="random")))


def test_every_example_is_named_and_read():
    assert sorted(EXAMPLES) == sorted(path.stem for path in EXAMPLE_FOLDER.glob("*.scene"))
    assert all(read_scene_file(example_path(name)).objects for name in EXAMPLES)


@pytest.mark.parametrize("word", [*VIEW_WORDS.values(), *OBJECT_WORDS.values(), MESH_FILE],
                         ids=lambda word: word.name)
def test_the_example_of_each_word_is_one(word):
    text = word.example if word.example.startswith("obj") else f"{word.example}\nobj cube"
    if word.name in PERSPECTIVE_WORDS:
        text += "\nprojection perspective"
    scene = parse(text)
    said = scene.objects[0] if word.example.startswith("obj") else scene
    usual = ObjectDefinition("cube", 1, 1) if said is not scene else SceneDescription(PATH)
    assert getattr(said, word.field) != getattr(usual, word.field)
    assert word.example in reference() and word.meaning in reference()


def test_comments_blanks_case_and_line_ends_make_no_difference():
    plain = parse("obj cube color #ff8000 scale 1,2,3\nambient 10")
    assert parse("  obj  cube color #ff8000 scale 1,2,3 # red\n# obj\n\n ambient\t10 #x") == plain
    assert parse("OBJ CUBE COLOR #FF8000 SCALE 1,2,3\r\nAMBIENT 10\r\n") == plain


def test_a_byte_order_mark_is_passed_over(tmp_path):
    file = tmp_path / "a.scene"
    file.write_bytes("\ufeffobj cube\n".encode())
    assert read_scene_file(file).objects[0].kind == "cube"


@pytest.mark.parametrize(("text", "message"), [
    ("obj", "line 1, column 1: obj has no kind"),
    ("obj spere", "line 1, column 5: 'spere' is no kind of object; did you mean sphere?"),
    ("obj cube colour red", "column 10: 'colour' is no parameter of an object; did you mean col"),
    ("obj cube color rde", "column 16: color: 'rde' is no colour; did you mean red?"),
    ("obj cube color", "column 10: color has no value; write one as in: obj cube color red"),
    ("obj cube scale 0", "scale: '0' is not a number from 1e-06 to 1e+06"),
    ("obj cube scale 1,2", "scale: '1,2' is not three numbers such as 0,1,0"),
    ("obj cube num 0", "num: '0' is not a whole number from 1 to 100000"),
    ("obj cube num 2 num 3", "column 16: num is given twice"),
    ("obj cube num 2 position 0,0,0", "column 10: num: all would be in one place"),
    ("obj sphere recursion 9", "recursion: '9' is not a whole number from 0 to 8"),
    ("obj mesh", "column 5: mesh has no file"),
    ("obj mesh a.obj recursion 2", "recursion: a mesh is drawn as it is"),
    ("ambient 40\nambient 50\nobj cube", "line 2, column 1: ambient is given twice, first in "),
    ("ambiant 40\nobj cube", "line 1, column 1: 'ambiant' is no definition; did you mean ambient?"),
    ("ambient\nobj cube", "ambient has no value; write one as in: ambient 40"),
    ("ambient nan\nobj cube", "ambient: 'nan' is not a number from 0 to 100"),
    ("light -1, 1, 1\nobj cube", "'-1,' is not three numbers"),
    ("light 0,0,0\nobj cube", "'0,0,0' is no direction"),
    ("light 1,1,1 2\nobj cube", "column 13: '2' is one word too many"),
    ("eye 0,0,1\nobj cube", "line 1, column 1: eye is for pictures in perspective"),
    ("projection cavalier\nobj cube", "'cavalier' is unknown; write one of orthographic, "),
    ("outfile ../x\nobj cube", "outfile: '../x' is no plain name"),
    ("size 64\nobj cube", "size: '64' is no size such as 512x512"),
    ("size 64x5000\nobj cube", "size: '5000' is not a whole number from 1 to 4096"),
    ("ambient 40\n# end", "line 2, column 1: obj: there is none; add a line such as obj sphere"),
    ("", "line 1, column 1: obj: there is none"),
    ("projection perspective\ntarget 0,1,2\n eye 0,1,2\nup 0,0,1\nobj cube",
     "line 2, column 1: target: is where the eye is; move one of them"),
    ("projection perspective\nobj cube\n eye 0,0,0",
     "line 3, column 2: target: is where the eye is"),
    ("projection perspective\neye 0,0,3\n  up 0,0,1\nobj cube",
     "line 3, column 3: up: is along the line of sight; choose another direction"),
    ("projection perspective\neye 0,3,0\nobj cube", "line 2, column 1: up: is along the line of"),
])
def test_a_mistake_is_one_line_with_its_place_and_a_remedy(text, message):
    with pytest.raises(InputError) as caught:
        parse(text)
    assert str(caught.value).startswith("folder/a.scene: ")
    assert message in str(caught.value) and "\n" not in str(caught.value)


def test_a_file_that_is_none_is_one_line(tmp_path):
    (tmp_path / "a.scene").write_bytes("\ufeffobj cube\nné ".encode() + b"\xff\xfe")
    for path, message in ((tmp_path, "cannot be read"), (tmp_path / "b.scene", "cannot be read"),
                          (tmp_path / "a.scene", "line 2, column 4: is no text in UTF-8")):
        with pytest.raises(InputError, match=message):
            read_scene_file(path)


def valid_scene(numbers: random.Random) -> str:
    """A random scene file without a mistake."""
    def triple(low=-2.0, high=2.0):
        return ",".join(f"{numbers.uniform(low, high):.3g}" for _ in range(3))

    perspective = numbers.random() < 0.3
    values = {
        "ambient": lambda: f"{numbers.uniform(0, 100):.3g}", "background": color(numbers),
        "light": lambda: f"{triple()[:-1]}1", "nodes": lambda: str(numbers.randint(1, 64)),
        "overlay": color(numbers), "outfile": lambda: "out", "percent": lambda: "0.5",
        "projection": lambda: "perspective" if perspective else "orthographic",
        "size": lambda: "16x12"}
    if perspective:
        values |= {"eye": lambda: "3,2,5", "target": triple, "up": lambda: "0,1,0",
                   "fov": lambda: "40"}
    chosen = numbers.sample(sorted(values), numbers.randint(0, len(values)))
    chosen += ["projection"] * (perspective and "projection" not in chosen)
    lines = [f"{name} {values[name]()}" for name in chosen]
    for _ in range(numbers.randint(1, 3)):
        placed = numbers.random() < 0.5
        words = [
            *numbers.choice(([], ["rot", triple()])),
            *numbers.choice(([], ["scale", "0.4"], ["scale", triple(0.1, 1)])),
            *(["position", triple()] if placed else ["num", str(numbers.randint(1, 3))]),
            *numbers.choice(([], ["color", color(numbers)()], ["color", "random"])),
            *numbers.choice(([], ["recursion", str(numbers.randint(0, 2))])),
            *numbers.choice(([], ["seed", str(numbers.randint(0, 9))]))]
        kind = numbers.choice([kind for kind in KINDS if kind != "mesh"])
        lines.append(" ".join(["obj", kind, *words]))
    numbers.shuffle(lines)
    return "\n".join(lines)


def color(numbers):
    return lambda: numbers.choice(("red", "gray", "#102030", "#FFF0e1"))


def mutated(text: str, numbers: random.Random) -> str:
    """The text with a few of its letters or words changed."""
    letters = list(text)
    for _ in range(numbers.randint(1, 4)):
        place = numbers.randrange(len(letters))
        letters[place] = numbers.choice(["", " ", "\n", "#", ",", "-", "9", "x", "é", "\0", "1e999",
                                         letters[numbers.randrange(len(letters))] * 2])
    return "".join(letters)


def test_ten_thousand_random_texts_are_read_or_refused_in_one_line():
    print("seed", SEED)
    numbers = random.Random(SEED)
    refused = 0
    for _ in range(5_000):
        text = valid_scene(numbers)
        assert parse(text).objects
        wrong = mutated(text, numbers)
        try:
            parse(wrong)
        except InputError as error:
            refused += 1
            assert re.match(r"folder/a\.scene: line \d+, column \d+: ", str(error)), wrong
            assert "\n" not in str(error)
    assert 2_000 < refused < 4_900


def test_random_scenes_draw():
    """A few of the valid ones, small: objects cover pixels, and what is covered by nothing has the
    background, the edge of an orthographic picture the overlay's colour."""
    print("seed", SEED)
    numbers = random.Random(SEED)
    covering = framed = 0
    for _ in range(20):
        text = valid_scene(numbers)
        scene = parse(text)
        file = SceneFile(scene, placed_objects(scene, 100_000))
        width, height = scene.size or (numbers.randint(8, 24), numbers.randint(8, 24))
        picture = draw(file.display_list(PictureFormat(width, height)))
        assert picture.color.shape == (height, width, 3), text
        covered = picture.winner >= 0
        assert (picture.color[~covered] == (scene.background or (0, 0, 0))).all(), text
        if file.orthographic and scene.overlay is not None:
            framed += 1
            edge = np.ones((height, width), bool)
            edge[1:-1, 1:-1] = False
            assert (picture.color[edge] == scene.overlay).all(), text
            covered &= ~edge
        covering += covered.any()
    assert covering >= 15 and framed >= 3
