"""The materials of an OBJ file: the diffuse colour ``Kd`` of each, from all its libraries."""

from __future__ import annotations

import os
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from ...specification.errors import InputError
from .numbers import numbers
from .reading import Reading
from .text_lines import plain_text


class Materials:
    """Material libraries as they are named, and the material in use.

    Names are bytes: an OBJ file does not say how it writes letters.  A material is looked
    up when all libraries have been read, so their order does not matter.
    """

    def __init__(self, folder: Path, reading: Reading) -> None:
        self.current = -1
        self._folder = folder
        self._reading = reading
        self._used: dict[bytes, int] = {}
        self._colors: dict[bytes, tuple[float, float, float] | None] = {}
        self._seen: set[bytes] = set()
        self._missing = False

    def use(self, name: bytes) -> int:
        """From here on faces are of this material; its number."""
        self.current = self._used.setdefault(name, len(self._used))
        return self.current

    def add_library(self, names: bytes) -> None:
        """Read the libraries of one ``mtllib`` line: one name with blanks in it, or several."""
        whole = names.split(b" #")[0].strip()
        for candidate in (names, whole):
            if self._path(candidate) is not None:
                return self._read(candidate)
        for name in whole.split():
            self._read(name)
        return None

    def of_faces(self, material: NDArray[np.int64]) -> NDArray[np.float64] | None:
        """The colour of each face of which ``material`` is the number; None without any."""
        table = np.full((len(self._used) + 1, 3), np.nan)  # the last row, -1: no material
        unknown = []
        for name, number in self._used.items():
            known = next((n for n in _spellings(name) if n in self._colors), None)
            if known is None:
                unknown.append(name)
            elif self._colors[known] is not None:
                table[number] = self._colors[known]
        if unknown and not self._missing and self._seen:
            shown = unknown[0].decode(errors="replace")
            self._reading.note_count(
                len(unknown), f"1 material is in no library: {shown!r}; its faces have the base "
                "colour", f"{{}} materials are in no library, the first {shown!r}; their faces "
                "have the base colour")
        if np.isnan(table).all():
            return None
        return table[material]

    def _path(self, name: bytes) -> Path | None:
        for spelling in (name, name.strip(b'"'), name.replace(b"\\", b"/")):
            try:
                path = self._folder / os.fsdecode(spelling)
                if spelling and path.is_file():
                    return path
            except (OSError, ValueError):
                continue
        return None

    def _read(self, name: bytes) -> None:
        if name in self._seen:
            return
        self._seen.add(name)
        shown = name.decode(errors="replace")
        path = self._path(name)
        try:
            if path is None:
                raise OSError("no such file")
            data = path.read_bytes()
            text = plain_text(data)
        except (OSError, InputError) as error:
            self._missing = True
            reason = str(error).removeprefix("mesh: contents: ")
            if isinstance(error, OSError):
                reason = error.strerror or reason
            self._reading.notes.append(f"material library {shown!r}: {reason}; faces of its "
                                       "materials have the base colour")
            return
        if data and not data.endswith((b"\n", b"\r", b"\n\0")):
            self._reading.notes.append(f"material library {shown!r}: the last line has no end: "
                                       "the file may be cut short")
        self._take(text, shown)

    def _take(self, text: bytes, shown: str) -> None:
        names: list[bytes] = []
        for number, line in enumerate(text.split(b"\n"), start=1):
            word, *rest = line.split(None, 1) or [b""]
            if word == b"newmtl":
                names = _spellings(rest[0].strip() if rest else b"")
                for name in names:
                    self._colors.setdefault(name, None)
            elif word == b"Kd" and names:
                color = _diffuse(rest[0] if rest else b"")
                if color is None:
                    self._reading.notes.append(f"material library {shown!r}: line {number}: Kd is "
                                               "not a colour of three numbers and is left out")
                for name in names:
                    self._colors[name] = color


def _spellings(name: bytes) -> list[bytes]:
    """A name as it stands, and without what may be a comment after it."""
    short = name.split(b"#")[0].strip()
    return [name, short] if short and short != name else [name]


def _diffuse(text: bytes) -> tuple[float, float, float] | None:
    """Red, green, blue; one number stands for all three."""
    words = text.split(b"#")[0].split()
    try:
        values = numbers(b" ".join(words), np.float64, len(words)).tolist()
    except ValueError:
        return None
    if len(values) not in (1, 3) or not np.isfinite(values).all():
        return None
    red, green, blue = values if len(values) == 3 else values * 3
    return red, green, blue
