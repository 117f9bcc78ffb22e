"""The words of scene files, with what they mean and an example of each.

The parser and the reference (``cardcage scenes --language``) are both made from these tables.
What Blazek's text leaves open, and was decided here, begins with "Decided:".
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

from ...specification.card_order import MAXIMUM_NODES
from .values import (
    COLOR,
    COLOR_OR_RANDOM,
    FILE,
    NAME,
    SIZE,
    ValueKind,
    choice,
    number,
    scale,
    vector,
    whole,
)

#: Of one line; the triangles of all are limited besides.
MOST_OBJECTS = 100_000
MOST_RECURSION = 8

FAR = 1e6


@dataclass(frozen=True)
class Word:
    """A definition of the view or the viewer, or a parameter of an object.

    ``field``    of ``SceneDescription`` or ``ObjectDefinition``
    ``meaning``  a sentence
    ``example``  a whole line
    """

    name: str
    field: str
    value: ValueKind
    meaning: str
    example: str


VIEW_WORDS = {word.name: word for word in (
    Word("ambient", "ambient", number(0, 100),
         "Per cent of light that comes from everywhere; the rest comes from the light.",
         "ambient 40"),
    Word("background", "background", COLOR, "Colour where nothing is drawn.",
         "background black"),
    Word("light", "light", vector(-FAR, FAR, direction=True),
         "Direction towards the one light, which is far away: right, up, towards the eye.",
         "light -1,1,1"),
    Word("nodes", "nodes", whole(1, MAXIMUM_NODES),
         "How many nodes share the scene, for compare, where it is told no cages; the atlas has "
         "--nodes.",
         "nodes 16"),
    Word("overlay", "overlay", COLOR,
         "Decided: a frame in this colour, one pixel wide, just inside the edge of the picture.",
         "overlay gray"),
    Word("outfile", "outfile", NAME,
         "Decided: the folder to which render writes its report where --out says nothing.",
         "outfile testout"),
    Word("percent", "percent", number(0, 100),
         "Decided: so many per cent of the picture's pixels have a star behind all objects, each "
         "in a colour of its own.", "percent 1"),
    Word("projection", "projection", choice("orthographic", "perspective"),
         "Orthographic unless said otherwise: x to the right, y up, z towards the eye; the smaller "
         "side of the picture reaches from -1 to 1.", "projection perspective"),
    Word("eye", "eye", vector(-FAR, FAR), "Where the eye is, in perspective.", "eye 0,1,4"),
    Word("target", "target", vector(-FAR, FAR),
         "What is in the middle of the picture, in perspective.", "target 0,0.5,0"),
    Word("up", "up", vector(-FAR, FAR, direction=True),
         "What is up in the picture, in perspective.", "up 1,1,0"),
    Word("fov", "field_of_view", number(1, 170),
         "Degrees across the smaller side of the picture, in perspective.", "fov 50"),
    Word("size", "size", SIZE, "Pixels of the picture where --size says nothing.",
         "size 256x256"),
)}

#: Words that an orthographic picture has no use for.
PERSPECTIVE_WORDS = ("eye", "target", "up", "fov")

OBJECT_WORDS = {word.name: word for word in (
    Word("rot", "rotation", vector(-FAR, FAR),
         "Decided: radians about x, then about y, then about z.", "obj cube rot 0,1.9,0"),
    Word("scale", "scale", scale(1e-6, FAR),
         "How many times as large as from -1 to 1; along each axis before it is turned.",
         "obj sphere scale 0.15"),
    Word("position", "position", vector(-FAR, FAR),
         "Where its middle is; left out, anywhere from -1 to 1 on each axis.",
         "obj cone position 0,0.5,0"),
    Word("num", "number", whole(1, MOST_OBJECTS),
         "How many of them, each in a place of its own.", "obj cube num 3"),
    Word("color", "color", COLOR_OR_RANDOM,
         "A name, #rrggbb, or random: another one for each. White unless said otherwise; a mesh "
         "has its own.", "obj cube color red"),
    Word("recursion", "recursion", whole(0, MOST_RECURSION),
         "How often each triangle becomes four: 3 times for what is round, else not at all.",
         "obj sphere recursion 5"),
    Word("seed", "seed", whole(0, 2**32 - 1),
         "Start of the random numbers; left out, the number of the obj line, from 1 on.",
         "obj sphere num 20 seed 7"),
)}

#: What an object may be.  Decided: the first five are what Blazek's figure 8 shows.  His text says
#: that they are five, but names conics, cubics, cylinders and spheroids there, and elsewhere
#: pyramids.
KINDS = {
    "sphere": "a ball, from an octahedron",
    "cube": "twelve triangles",
    "cylinder": "its axis is y",
    "cone": "its tip is at y = 1",
    "pyramid": "on a square base, its tip at y = 1",
    "mesh": "what is in a mesh file, moved and scaled so that it just fits from -1 to 1",
}

MESH = "mesh"
MESH_FILE = Word("mesh", "path", FILE, "The mesh file, seen from the scene file's folder.",
                 "obj mesh teapot.obj scale 0.5")


def reference() -> str:
    """The language for people: every word with its value, its meaning and an example."""
    lines = ["A scene file has a definition a line, in any order; # begins a comment.", "",
             "The view and the viewer:", ""]
    lines += _described(VIEW_WORDS.values())
    lines += ["Objects, as many lines as there are:", "",
              "  obj KIND [PARAMETER VALUE]...", ""]
    lines += [f"  {name:<10}{meaning}" for name, meaning in KINDS.items()]
    lines += ["", "Parameters of an object:", ""]
    lines += _described([*OBJECT_WORDS.values(), MESH_FILE])
    return "\n".join(lines)


def _described(words: Iterable[Word]) -> list[str]:
    lines: list[str] = []
    for word in words:
        lines += [f"  {word.name} {word.value.form}", f"      {word.meaning}",
                  f"      {word.example}", ""]
    return lines
