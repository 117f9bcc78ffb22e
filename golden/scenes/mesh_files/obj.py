"""Wavefront OBJ: vertices with or without colours, polygons, materials.

No reader at hand takes all that the format allows, so the words are read here, in arrays
of some thousand lines at a time.  Texture coordinates, normals, groups and smoothing are
passed over; points, lines and free-form surfaces are left out, and counted.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from pathlib import Path
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

from ...specification.errors import InputError
from .colours import corner_colors, fractions
from .numbers import first_numbers, numbers
from .obj_materials import Materials
from .polygons import triangulate
from .reading import Part, Reading, contents_error
from .text_lines import SPACE, Lines, line_number, plain_text, stretch_from

#: A line that goes on in the next: its backslash and newline become blanks, of which this
#: one, a form feed, still counts as the end of a line.
JOINT: Final = b"\x0c"

#: Keywords that change nothing in the picture; ``vt``, ``vn`` and ``vp`` are passed over too.
_PASSED_OVER: Final = frozenset(
    b"o g s mg mm lod bevel c_interp d_interp shadow_obj trace_obj ctech stech maplib usemap "
    b"cstype deg bmat step parm trim hole scrv sp end con".split()
)
_LEFT_OUT: Final = {b"p": "points", b"l": "lines", b"curv": "curves", b"curv2": "curves",
                    b"surf": "surfaces"}


def read_obj(data: bytes, folder: Path) -> Reading:
    """The mesh of an OBJ file; its material libraries are looked for in ``folder``."""
    whole = data.endswith((b"\n", b"\r", b"\n\0"))
    file = _File(_joined_lines(plain_text(data)), folder)
    file.read()
    if not whole:
        file.reading.notes.append("the last line has no end: the file may be cut short")
    return file.reading


def _joined_lines(text: bytes) -> bytes:
    """Continued lines in one, every byte in its place; a backslash in a comment joins nothing."""
    if b"\\" not in text:
        return text

    def blanks(match: re.Match[bytes]) -> bytes:
        return match[0] if match[0][:1] == b"#" else b" " * (len(match[0]) - 1) + JOINT

    text = text.replace(JOINT, b" ")
    return re.sub(rb"#[^\n]*|\\[ \t]*\n", blanks, text[:-1]) + b"\n"


class _File:
    def __init__(self, text: bytes, folder: Path) -> None:
        self.text = text
        self.reading = Reading()
        self.materials = Materials(folder, self.reading)
        self.vertices: list[NDArray[np.float64]] = [np.zeros((0, 3))]
        self.colors: list[NDArray[np.float64]] = [np.zeros((0, 3))]
        self.corners: list[NDArray[np.int64]] = [np.zeros(0, np.int64)]
        self.sizes: list[NDArray[np.int64]] = [np.zeros(0, np.int64)]
        self.places: list[NDArray[np.int64]] = [np.zeros(0, np.int64)]
        self.material: list[NDArray[np.int64]] = [np.zeros(0, np.int64)]
        self.vertex_count = 0
        self.left_out: dict[str, int] = {}
        self.unknown: list[tuple[str, int]] = []
        self.unknown_count = 0

    def read(self) -> None:
        start = 0
        while stretch := stretch_from(self.text, start):
            self._take(stretch, start)
            start += len(stretch)
        vertices = np.concatenate(self.vertices)
        corners, sizes = np.concatenate(self.corners), np.concatenate(self.sizes)
        self._check_range(corners, sizes, len(vertices))
        cut = triangulate(vertices, corners, sizes, self.reading)
        faces = cut.of_corners(corners)
        colors = np.concatenate(self.colors)
        of_vertex = None if np.isnan(colors).all() else _shades(colors)
        of_face = self.materials.of_faces(cut.of_polygons(np.concatenate(self.material)))
        self.reading.parts.append(Part(vertices, faces, corner_colors(faces, of_vertex, of_face)))
        unused = len(vertices) - int(np.count_nonzero(_used(corners, len(vertices))))
        if not self.left_out:
            self.reading.note_count(
                unused, f"1 of {len(vertices)} vertices is in no face: if that is not meant, the "
                "file is cut short", f"{{}} of {len(vertices)} vertices are in no face: if that is "
                "not meant, the file is cut short")
        for what, count in self.left_out.items():
            self.reading.note_count(count, f"1 element of {what} is left out: only faces are drawn",
                                    f"{{}} elements of {what} are left out: only faces are drawn")
        if self.unknown:
            word, place = self.unknown[0]
            line = self._line(place)
            self.reading.note_count(
                self.unknown_count,
                f"1 line is left out: line {line} starts with {word!r}, which OBJ does not know",
                f"{{}} lines are left out: they start with words that OBJ does not know, "
                f"the first with {word!r} in line {line}")

    def _line(self, place: int) -> int:
        return line_number(self.text, place) + self.text.count(JOINT, 0, place)

    def _take(self, stretch: bytes, start: int) -> None:
        """One stretch of whole lines, which starts at byte ``start``."""
        lines = Lines(stretch, b"#")
        filled = lines.count > 0
        head = lines.words[lines.first[filled]]
        letter, second, third = (lines.text[head + i] for i in range(3))
        kind = np.zeros(len(filled), np.uint8)  # 0: blank or passed over
        single = (second <= SPACE) & ((letter == ord("v")) | (letter == ord("f")))
        data = ((letter == ord("v")) & np.isin(second, np.frombuffer(b"tnp", np.uint8))
                & (third <= SPACE))
        kind[filled] = np.where(single, letter, np.where(data, 0, 1))
        is_vertex, is_face = kind == ord("v"), kind == ord("f")
        # Where a line starts in the file: newline i of the stretch is one byte before.
        place = start + lines.newlines[:-1]
        lines.text[head[single]] = SPACE
        uses = self._other_lines(stretch, lines, np.flatnonzero(kind == 1), start)
        before = self.vertex_count + np.cumsum(is_vertex)
        if is_vertex.any():
            self._take_vertices(lines, is_vertex, place)
        if is_face.any():
            self._take_faces(lines, is_face, place, before)
            chosen = np.searchsorted(uses[:, 0], np.flatnonzero(is_face), side="right") - 1
            self.material.append(uses[chosen, 1])

    def _other_lines(
        self, stretch: bytes, lines: Lines, others: NDArray[np.int64], start: int
    ) -> NDArray[np.int64]:
        """Which material holds from which line on: int64 (n, 2), the first one from -1."""
        uses = [(-1, self.materials.current)]
        for index in others.tolist():
            line = stretch[lines.newlines[index] : lines.newlines[index + 1] - 1]
            word, *rest = line.replace(JOINT, b" ").split(None, 1)
            name = rest[0].strip() if rest else b""
            if word == b"usemtl":
                uses.append((index, self.materials.use(name)))
            elif word == b"mtllib":
                self.materials.add_library(name)
            elif word in _LEFT_OUT:
                what = _LEFT_OUT[word]
                self.left_out[what] = self.left_out.get(what, 0) + 1
            elif word not in _PASSED_OVER:
                self.unknown_count += 1
                if not self.unknown:
                    self.unknown.append((word[:20].decode(errors="replace"),
                                         start + int(lines.newlines[index])))
        return np.array(uses, np.int64)

    def _take_vertices(
        self, lines: Lines, chosen: NDArray[np.bool_], place: NDArray[np.int64]
    ) -> None:
        counts = lines.count[chosen] - 1
        wrong = ~np.isin(counts, (3, 4, 6, 7))
        if wrong.any():
            first = int(np.argmax(wrong))
            raise contents_error(f"line {self._line(int(place[chosen][first]))}: a vertex of "
                                 f"{counts[first]} numbers; it has 3, or 6 with a colour")
        values = self._numbers(lines, chosen, place, np.float64, int(counts.sum()))
        at = np.cumsum(counts) - counts
        self.vertices.append(values[at[:, None] + np.arange(3)])
        colors = np.full((len(counts), 3), np.nan)
        colored = counts >= 6
        if colored.any():
            colors[colored] = values[at[colored][:, None] + np.arange(3, 6)]
        self.colors.append(colors)
        self.vertex_count += len(counts)

    def _take_faces(
        self,
        lines: Lines,
        chosen: NDArray[np.bool_],
        place: NDArray[np.int64],
        before: NDArray[np.int64],
    ) -> None:
        sizes = lines.count[chosen] - 1
        index = self._numbers(lines, chosen, place, np.int64, int(sizes.sum()))
        if (index == 0).any():
            face = int(np.searchsorted(np.cumsum(sizes), np.argmax(index == 0), side="right"))
            raise InputError(f"mesh: faces: line {self._line(int(place[chosen][face]))}: names "
                             "vertex 0, but OBJ counts vertices from 1; repair the mesh")
        # A negative index counts back from the vertices before the face's own line.
        corners = index - 1
        if (index < 0).any():
            back = np.repeat(before[chosen], sizes)
            corners = np.where(index < 0, back + index, corners)
            if (corners < 0).any():
                self._refuse(place[chosen], sizes, int(np.argmax(corners < 0)), index, back)
        self.corners.append(corners)
        self.sizes.append(sizes)
        self.places.append(place[chosen])

    def _refuse(
        self,
        places: NDArray[np.int64],
        sizes: NDArray[np.int64],
        corner: int,
        index: NDArray[np.int64],
        counts: NDArray[np.int64],
    ) -> None:
        face = int(np.searchsorted(np.cumsum(sizes), corner, side="right"))
        raise InputError(f"mesh: faces: line {self._line(int(places[face]))}: names vertex "
                         f"{index[corner]}, but there are {counts[corner]} vertices"
                         f"{' before it' if index[corner] < 0 else ''}; repair the mesh")

    def _check_range(
        self, corners: NDArray[np.int64], sizes: NDArray[np.int64], count: int
    ) -> None:
        if len(corners) and corners.max() >= count:
            self._refuse(np.concatenate(self.places), sizes, int(np.argmax(corners >= count)),
                         corners + 1, np.full(len(corners), count))

    def _numbers(
        self,
        lines: Lines,
        chosen: NDArray[np.bool_],
        place: NDArray[np.int64],
        dtype: type[np.float64] | type[np.int64],
        count: int,
    ) -> NDArray[Any]:
        try:
            return _parsed(lines.bytes_of(chosen), dtype, count)
        except ValueError:
            raise self._bad_line(lines, chosen, place, dtype) from None

    def _bad_line(
        self,
        lines: Lines,
        chosen: NDArray[np.bool_],
        place: NDArray[np.int64],
        dtype: type[np.float64] | type[np.int64],
    ) -> InputError:
        """Which of the lines it is that cannot be read."""
        for index, words in _words(lines, chosen):
            try:
                _parsed(words, dtype, int(lines.count[index]) - 1)
            except ValueError:
                what = "coordinates" if dtype is np.float64 else "vertex numbers"
                shown = " ".join(words.decode(errors="replace").split())[:60]
                return contents_error(f"line {self._line(int(place[index]))}: cannot read the "
                                      f"{what} in {shown!r}; repair the mesh")
        return contents_error("bytes that no text has between the numbers; repair the mesh")


def _parsed(
    text: bytes, dtype: type[np.float64] | type[np.int64], count: int
) -> NDArray[Any]:
    """Coordinates, or of corners vertex/texture/normal the vertex."""
    return numbers(text, dtype, count) if dtype is np.float64 else first_numbers(text, count)


def _words(lines: Lines, chosen: NDArray[np.bool_]) -> Iterator[tuple[int, bytes]]:
    for index in np.flatnonzero(chosen).tolist():
        yield index, lines.text[lines.newlines[index] : lines.newlines[index + 1]].tobytes()


def _used(corners: NDArray[np.int64], count: int) -> NDArray[np.bool_]:
    used = np.zeros(count, np.bool_)
    used[corners] = True
    return used


def _shades(colors: NDArray[np.float64]) -> NDArray[np.float64]:
    """Fractions of colours of which some rows are NaN: stated nowhere."""
    shades = fractions(colors)
    shades[np.isnan(colors).all(axis=1)] = np.nan
    return shades
