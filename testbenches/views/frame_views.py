"""From where each picture of a sequence is seen: turning, or along a path."""

from __future__ import annotations

import csv
import math
from pathlib import Path

from ...golden.scenes.camera import View
from ...golden.specification.errors import InputError

#: Degrees from picture to picture: the head of Ellsworth 1994.
DEFAULT_TURN = 4.5

MOST_FRAMES = 10_000

#: Columns of a path; the last may be missing.
COLUMNS = ("azimuth", "elevation", "zoom")


def turning(start: tuple[float, float], zoom: float, frames: int, turn: float) -> list[View]:
    """Views of a scene that turns about what is up: from ``start``, azimuth and elevation, by
    ``turn`` degrees each."""
    azimuth, elevation = start
    if not math.isfinite(turn * frames):
        raise InputError(f"--turn: {turn!r} degrees over {frames} pictures are no angle")
    return [View((azimuth + turn * number, elevation), zoom) for number in range(frames)]


def read_path(path: Path) -> list[View]:
    """The views of a CSV file: a header, then a line for each picture.

    The columns are azimuth and elevation in degrees and, if the header has it, zoom.  Raises
    ``InputError``, with the line, for a file that is no path.
    """
    try:
        with path.open(encoding="utf-8-sig", newline="") as file:
            lines = [(number, line) for number, line in enumerate(csv.reader(file), 1)
                     if any(word.strip() for word in line)]
    except OSError as error:
        raise InputError(f"--path: {path}: {error.strerror or error}") from None
    except (UnicodeDecodeError, csv.Error):
        raise InputError(f"--path: {path}: is no CSV file") from None
    header = [word.strip().lower() for word in lines[0][1]] if lines else []
    if tuple(header) not in (COLUMNS, COLUMNS[:2]):
        raise InputError(f"--path: {path}: line 1: begin with the columns {','.join(COLUMNS[:2])}, "
                         f"or {','.join(COLUMNS)}")
    if len(lines) == 1:
        raise InputError(f"--path: {path}: no view; write a line for each picture")
    if len(lines) - 1 > MOST_FRAMES:
        raise InputError(f"--path: {path}: {len(lines) - 1:,} views, at most {MOST_FRAMES:,}")
    return [_view(path, number, header, line) for number, line in lines[1:]]


def _view(path: Path, number: int, header: list[str], line: list[str]) -> View:
    place = f"--path: {path}: line {number}"
    if len(line) != len(header):
        raise InputError(f"{place}: {len(line)} columns, the first line has {len(header)}")
    values = {name: _number(word, f"{place}: {name}")
              for name, word in zip(header, line, strict=True)}
    try:
        return View((values["azimuth"], values["elevation"]), values.get("zoom", 1.0))
    except InputError as error:
        raise InputError(f"{place}: {error}") from None


def _number(word: str, place: str) -> float:
    try:
        value = float(word)
    except ValueError:
        value = math.nan
    if not math.isfinite(value):
        raise InputError(f"{place}: {word.strip()!r} is not a number")
    return value
