"""The values that a scene file gives: how each kind is written, and what it means."""

from __future__ import annotations

import difflib
import math
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from typing import Any

from PIL import ImageColor

from ..mesh import Vector
from .description import Color


class WrongValueError(ValueError):
    """What is wrong with a value, and what to write in its place."""


@dataclass(frozen=True)
class ValueKind:
    """How a value is written.

    ``form``   for people: ``X,Y,Z``
    ``parse``  the value of its text; raises ``WrongValueError``
    """

    form: str
    parse: Callable[[str], Any]


def nearest(word: str, known: Iterable[str]) -> str:
    """What to do about a word that is none of ``known``."""
    choices = list(known)
    close = difflib.get_close_matches(word.lower(), choices, n=1, cutoff=0.5)
    return f"did you mean {close[0]}?" if close else f"write one of {', '.join(choices)}"


def _number(text: str, low: float, high: float) -> float:
    try:
        value = float(text)
    except ValueError:
        value = math.nan
    if not low <= value <= high:
        raise WrongValueError(f"{text!r} is not a number from {low:g} to {high:g}")
    return value


def number(low: float, high: float) -> ValueKind:
    return ValueKind("N", lambda text: _number(text, low, high))


def whole(low: int, high: int) -> ValueKind:
    def parse(text: str) -> int:
        if not text.isdecimal() or not low <= int(text[:20]) <= high:
            raise WrongValueError(f"{text!r} is not a whole number from {low} to {high}")
        return int(text)

    return ValueKind("N", parse)


def vector(low: float, high: float, *, direction: bool = False) -> ValueKind:
    """Three numbers; a ``direction`` is not 0,0,0."""

    def parse(text: str) -> Vector:
        parts = text.split(",")
        if len(parts) != 3 or not all(parts):
            raise WrongValueError(f"{text!r} is not three numbers such as 0,1,0; leave no blanks "
                                  "between them")
        x, y, z = (_number(part, low, high) for part in parts)
        if direction and math.hypot(x, y, z) < 1e-6:
            raise WrongValueError(f"{text!r} is no direction; take three numbers, not all 0")
        return x, y, z

    return ValueKind("X,Y,Z", parse)


def scale(low: float, high: float) -> ValueKind:
    """One number for all axes, or one for each."""
    each = vector(low, high)

    def parse(text: str) -> Any:
        return each.parse(text if "," in text else ",".join([text] * 3))

    return ValueKind("N or X,Y,Z", parse)


def _color(text: str, *more: str) -> Color | str:
    if text.lower() in more:
        return text.lower()
    try:
        if text.startswith("#") and len(text) != len("#rrggbb"):
            raise ValueError
        red, green, blue = ImageColor.getrgb(text)[:3]
    except ValueError:
        remedy = (f"write {text[:1]}rrggbb with six digits" if text.startswith("#")
                  else nearest(text, [*more, *ImageColor.colormap]) if text.isalpha()
                  else "write a name such as red, or #rrggbb")
        raise WrongValueError(f"{text!r} is no colour; {remedy[:200]}") from None
    return red, green, blue


COLOR = ValueKind("COLOUR", _color)
COLOR_OR_RANDOM = ValueKind("COLOUR or random", lambda text: _color(text, "random"))


def choice(*names: str) -> ValueKind:
    def parse(text: str) -> str:
        if text.lower() not in names:
            raise WrongValueError(f"{text!r} is unknown; {nearest(text, names)}")
        return text.lower()

    return ValueKind(" or ".join(names), parse)


def _size(text: str) -> tuple[int, int]:
    width, cross, height = text.lower().partition("x")
    if not cross:
        raise WrongValueError(f"{text!r} is no size such as 512x512")
    side = whole(1, 4096)
    return side.parse(width), side.parse(height)


SIZE = ValueKind("WxH", _size)


def _name(text: str) -> str:
    if any(sign in text for sign in "/\\:") or text in (".", ".."):
        raise WrongValueError(f"{text!r} is no plain name; leave folders out")
    return text


NAME = ValueKind("NAME", _name)
FILE = ValueKind("FILE", lambda text: text)
