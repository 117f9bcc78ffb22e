"""From the text of a scene file to what it says."""

from __future__ import annotations

import codecs
import re
from collections.abc import Iterator
from pathlib import Path
from typing import Any, NamedTuple

from ...specification.errors import InputError
from ..camera import Camera
from .description import ObjectDefinition, SceneDescription
from .language import KINDS, MESH, OBJECT_WORDS, PERSPECTIVE_WORDS, VIEW_WORDS, Word
from .values import WrongValueError, nearest

OBJECT = "obj"

#: A scene is words; a file of more is something else.
MOST_BYTES = 16 << 20


class _Token(NamedTuple):
    text: str
    line: int
    column: int


def read_scene_file(path: Path) -> SceneDescription:
    """What a scene file says.  Raises ``InputError``, which names line and column, the nearest word
    that is known, and the remedy."""
    try:
        with path.open("rb") as file:
            data = file.read(MOST_BYTES + 1)
    except (OSError, ValueError) as error:
        reason = getattr(error, "strerror", None) or error
        raise InputError(f"{path}: cannot be read: {reason}") from None
    if len(data) > MOST_BYTES:
        raise InputError(f"{path}: more than {MOST_BYTES >> 20} MB is no scene file; is it a mesh?")
    data = data.removeprefix(codecs.BOM_UTF8)
    try:
        text = data.decode("utf-8")
    except UnicodeDecodeError as error:
        *before, last = f"{data[:error.start].decode('utf-8')}?".splitlines()
        raise InputError(f"{path}: line {len(before) + 1}, column {len(last)}: is no text in "
                         "UTF-8; save it as such") from None
    return parse_scene_text(text, path)


def parse_scene_text(text: str, path: Path) -> SceneDescription:
    """What ``text`` says, the contents of the file ``path``.  Raises ``InputError`` likewise."""
    parser = _Parser(path)
    number = 1
    for number, line in enumerate(text.splitlines(), 1):
        tokens = list(_tokens(line, number))
        if tokens:
            parser.definition(tokens)
    return parser.finished(number)


def _tokens(line: str, number: int) -> Iterator[_Token]:
    # A colour such as #ff0000 begins no comment: it follows a word, and six digits follow it.
    for found in re.finditer(r"\S+", line):
        if found[0].startswith("#") and not re.fullmatch(r"#[0-9A-Fa-f]{3,8}", found[0]):
            return
        if found[0].startswith("#") and not line[:found.start()].strip():
            return
        yield _Token(found[0], number, found.start() + 1)


class _Parser:
    def __init__(self, path: Path) -> None:
        self._path = path
        self._view: dict[str, Any] = {}
        self._places: dict[str, _Token] = {}
        self._objects: list[ObjectDefinition] = []

    def definition(self, tokens: list[_Token]) -> None:
        """One line."""
        first, rest = tokens[0], tokens[1:]
        name = first.text.lower()
        if name == OBJECT:
            self._object(first, rest)
        elif name in VIEW_WORDS:
            self._view_word(VIEW_WORDS[name], first, rest)
        else:
            remedy = (f"did you mean {OBJECT} {name}?" if name in KINDS
                      else nearest(name, [OBJECT, *VIEW_WORDS]))
            raise self._wrong(first, f"{first.text!r} is no definition; {remedy}")

    def finished(self, last_line: int) -> SceneDescription:
        """All of it, once no line follows ``last_line``."""
        if self._view.get("projection") != "perspective":
            for name in PERSPECTIVE_WORDS:
                if name in self._places:
                    raise self._wrong(self._places[name], f"{name} is for pictures in perspective; "
                                      "leave it out, or add: projection perspective")
        if not self._objects:
            raise self._wrong(_Token("", last_line, 1),
                              "obj: there is none; add a line such as obj sphere")
        scene = SceneDescription(self._path, objects=tuple(self._objects), **self._view)
        self._check_camera(scene)
        return scene

    def _check_camera(self, scene: SceneDescription) -> None:
        """Where the eye is, what it looks at and what is up are right or wrong only together; what
        is wrong is told of the definition that most likely has to change."""
        try:
            Camera(scene.eye, scene.target, scene.up, scene.field_of_view)
        except InputError as error:
            problem = str(error).removeprefix("camera: ")
            words = [name for name in ("up", "target", "eye") if name in self._places]
            if problem.startswith("target") and len(words) > 1 and words[0] == "up":
                del words[0]
            raise self._wrong(self._places[words[0]], problem) from None

    def _view_word(self, word: Word, first: _Token, rest: list[_Token]) -> None:
        if word.name in self._places:
            raise self._wrong(first, f"{word.name} is given twice, first in line "
                              f"{self._places[word.name].line}; keep one")
        if not rest:
            raise self._wrong(first, f"{word.name} has no value; write one as in: {word.example}")
        self._places[word.name] = first
        self._view[word.field] = self._value(word, rest[0])
        if len(rest) > 1:
            raise self._wrong(rest[1], f"{rest[1].text!r} is one word too many; write a tuple "
                              f"without blanks, as in: {word.example}")

    def _object(self, first: _Token, rest: list[_Token]) -> None:
        if not rest:
            raise self._wrong(first, "obj has no kind; write one, as in: obj sphere scale 0.15")
        kind = rest[0].text.lower()
        if kind not in KINDS:
            raise self._wrong(rest[0], f"{rest[0].text!r} is no kind of object; "
                              f"{nearest(kind, KINDS)}")
        values: dict[str, Any] = {}
        words = rest[1:]
        if kind == MESH:
            if not words:
                raise self._wrong(rest[0], "mesh has no file; write one, as in: obj mesh a.obj")
            file = words.pop(0)
            values |= {"path": self._path.parent / file.text, "column": file.column}
        places: dict[str, _Token] = {}
        for name, value in zip(words[::2], [*words[1::2], None], strict=False):
            word = OBJECT_WORDS.get(name.text.lower())
            if word is None:
                raise self._wrong(name, f"{name.text!r} is no parameter of an object; "
                                  f"{nearest(name.text, OBJECT_WORDS)}")
            if word.name in places:
                raise self._wrong(name, f"{word.name} is given twice; keep one")
            if value is None:
                raise self._wrong(name, f"{word.name} has no value; write one as in: "
                                  f"{word.example}")
            places[word.name] = name
            values[word.field] = self._value(word, value)
        if values.get("position") is not None and values.get("number", 1) > 1:
            raise self._wrong(places["num"], "num: all would be in one place; leave position out, "
                              "or write a line for each")
        if kind == MESH and "recursion" in places:
            raise self._wrong(places["recursion"], "recursion: a mesh is drawn as it is; leave it "
                              "out")
        self._objects.append(ObjectDefinition(
            kind=kind, line=first.line, **{"seed": len(self._objects) + 1, **values}))

    def _value(self, word: Word, token: _Token) -> Any:
        try:
            return word.value.parse(token.text)
        except WrongValueError as error:
            raise self._wrong(token, f"{word.name}: {error}") from None

    def _wrong(self, token: _Token, problem: str) -> InputError:
        return InputError(f"{self._path}: line {token.line}, column {token.column}: {problem}")
