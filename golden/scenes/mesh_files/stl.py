"""STL, binary and text.  Solids, normals and the colours of some binary dialects are passed over.

A binary file is the array that numpy reads as it stands.  A text file is taken word by
word, in arrays: no reader at hand refuses a solid that is cut short, a number that cannot
be read *and* a wrong count.
"""

from __future__ import annotations

import re
from collections.abc import Sequence
from pathlib import Path
from typing import Final

import numpy as np
from numpy.typing import NDArray

from ...specification.errors import InputError
from .decimals import decimals, eight_bytes
from .numbers import numbers
from .reading import Part, Reading, contents_error
from .text_lines import SPACE, Lines, line_number, plain_text, ranges, stretch_end

HEADER_BYTES: Final = 84
_FACET: Final = np.dtype([("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("attribute", "<u2")])

#: The words of a facet; None: a number.
_VERTEX: Final = (b"vertex", None, None, None)
FACET_WORDS: Final = (b"facet", b"normal", None, None, None, b"outer", b"loop",
                      *_VERTEX, *_VERTEX, *_VERTEX, b"endloop", b"endfacet")
_COORDINATES: Final = [8, 9, 10, 12, 13, 14, 16, 17, 18]
#: From each of these words to the next, vertex numbers (in every second stretch) or other text.
_BOUNDS: Final = (0, 8, 11, 12, 15, 16, 19)


def read_stl(data: bytes, folder: Path) -> Reading:
    """The triangles of an STL file."""
    del folder
    reading = Reading()
    if _is_binary(data):
        corners = _binary(data)
    else:
        text = plain_text(data)
        corners = _Text(text).read()
        if not data.endswith((b"\n", b"\r", b"\n\0")) and not _ends_with_its_name(text):
            reading.notes.append("the last line has no end: the file may be cut short")
    points = corners.reshape(-1, 3)
    faces = np.arange(len(points), dtype=np.int64).reshape(-1, 3)
    reading.parts.append(Part(points, faces))
    return reading


def _is_binary(data: bytes) -> bool:
    """Binary files may start with ``solid``, too: then the size decides, or a zero byte."""
    if len(data) >= HEADER_BYTES:
        announced = int.from_bytes(data[80:84], "little")
        if len(data) == HEADER_BYTES + announced * _FACET.itemsize:
            return True
    start = data[:512].removeprefix(b"\xef\xbb\xbf").lstrip()
    if start[:2] in (b"\xff\xfe", b"\xfe\xff"):
        return False
    return start[:5].lower() != b"solid" or b"\0" in data[:512]


def _binary(data: bytes) -> NDArray[np.float64]:
    if len(data) < HEADER_BYTES:
        raise contents_error(f"{len(data)} bytes: cut short within the header, or no STL")
    announced = int.from_bytes(data[80:84], "little")
    there, rest = divmod(len(data) - HEADER_BYTES, _FACET.itemsize)
    tail = data[HEADER_BYTES + announced * _FACET.itemsize :]
    if announced > there or tail.strip(b"\0 \t\r\n"):
        more = f" and {rest} bytes" if rest else ""
        raise contents_error(f"{announced} triangles are announced and {there}{more} are there: "
                             "the file is cut short, or no binary STL")
    facets = np.frombuffer(data, _FACET, announced, HEADER_BYTES)
    return facets["corners"].astype(np.float64)


def _ends_with_its_name(text: bytes) -> bool:
    """The last line names the solid that it ends, as its first line does."""
    begin = [match[1] for match in re.finditer(rb"(?im)^[ \t]*solid\b(.*)$", text)]
    end = re.search(rb"(?i)endsolid\b(.*)\n\Z", text)
    return end is not None and end[1].strip() == begin[-1].strip()


class _Text:
    def __init__(self, text: bytes) -> None:
        self._text = text
        self._open = False
        self._solids = 0

    def read(self) -> NDArray[np.float64]:
        """The corners of all facets, float64 (f, 3, 3)."""
        found = [np.zeros((0, 3, 3))]
        start = end = 0
        while end < len(self._text):
            end = stretch_end(self._text, end)
            corners, taken = self._facets(self._text[start:end], start)
            found.append(corners)
            start += taken  # a facet that the stretch cuts is taken with the next one
        rest = self._text[start:]
        if rest.strip():
            self._refuse(start + len(rest) - len(rest.lstrip()), "the file ends within a facet")
        if self._open:
            raise contents_error("the last solid has no endsolid: the file is cut short")
        if not self._solids:
            raise contents_error("no solid in it: not an STL")
        return np.concatenate(found)

    def _refuse(self, place: int, what: str) -> None:
        raise contents_error(f"line {line_number(self._text, place)}: {what}; the file is cut "
                             "short or damaged")

    def _facets(self, stretch: bytes, start: int) -> tuple[NDArray[np.float64], int]:
        lines = Lines(stretch)
        names, places, opens = self._solid_lines(lines, start)
        # The rest of a line with the name of a solid may hold any word.
        begin = lines.newlines[:-1][names]
        length = np.diff(lines.newlines)[names]
        lines.text[ranges(begin + 1, length - 1)] = SPACE
        words, ends = lines.words, lines.ends
        if names.any():
            inside = np.repeat(~names, lines.count)
            words, ends = words[inside], ends[inside]
        whole = len(words) // len(FACET_WORDS)
        facets = words[: whole * len(FACET_WORDS)].reshape(-1, len(FACET_WORDS))
        self._check_words(lines.text, facets, words[whole * len(FACET_WORDS) :], start)
        self._check_solids(words, places, opens, start)
        taken = int(words[facets.size]) - 1 if len(words) > facets.size else len(stretch)
        if not whole:
            return np.zeros((0, 3, 3)), taken
        if lines.clean:
            values = decimals(
                lines.text, facets[:, _COORDINATES].reshape(-1),
                ends[: facets.size].reshape(facets.shape)[:, _COORDINATES].reshape(-1), np.float64)
            if values is not None:
                return values.reshape(-1, 3, 3), taken
        bounds = np.append(facets[:, _BOUNDS].reshape(-1), taken + 1)
        of_vertex = np.tile(np.arange(len(_BOUNDS)) % 2 == 1, whole)
        text = lines.text[bounds[0] : taken + 1][np.repeat(of_vertex, np.diff(bounds))]
        try:
            values = numbers(text.tobytes(), np.float64, 9 * whole)
        except ValueError:
            raise self._bad_number(lines.text, facets, start) from None
        return values.reshape(-1, 3, 3), taken

    def _solid_lines(
        self, lines: Lines, start: int
    ) -> tuple[NDArray[np.bool_], NDArray[np.int64], NDArray[np.bool_]]:
        """Which lines open or end a solid; where the first word of each is; which open one."""
        filled = np.flatnonzero(lines.count > 0)
        head = lines.words[lines.first[filled]]
        # Few words have an s where these two have one.
        head_s = [(lines.text[head + i] | 0x20) == ord("s") for i in (0, 3)]
        candidates = np.flatnonzero(head_s[0] | head_s[1])
        opens, ends = (_are_words(lines.text, head[candidates, None], [word])[:, 0]
                       for word in (b"solid", b"endsolid"))
        found = candidates[opens | ends]
        names = np.zeros(len(lines.count), np.bool_)
        names[filled[found]] = True
        return names, head[found], opens[opens | ends]

    def _check_solids(
        self,
        words: NDArray[np.int64],
        places: NDArray[np.int64],
        opens: NDArray[np.bool_],
        start: int,
    ) -> None:
        """Solids open and end in turn, between facets, and every facet is in one."""
        before = np.searchsorted(words, places)
        last = 0
        for place, opening, count in zip(places.tolist(), opens.tolist(), before.tolist(),
                                         strict=True):
            if opening == self._open:
                self._refuse(start + place - 1, "a solid in a solid" if opening
                             else "an endsolid without its solid")
            if count % len(FACET_WORDS):
                self._refuse(start + place - 1, "a facet is not ended")
            if opening and count > last:
                self._refuse(start + int(words[last]) - 1, "a facet outside of a solid")
            last = count
            self._open = opening
            self._solids += opening
        if not self._open and len(words) > last:
            self._refuse(start + int(words[last]) - 1, "a facet outside of a solid")

    def _check_words(
        self,
        text: NDArray[np.uint8],
        facets: NDArray[np.int64],
        rest: NDArray[np.int64],
        start: int,
    ) -> None:
        """Every keyword of a facet is in its place."""
        columns = [i for i, word in enumerate(FACET_WORDS) if word is not None]
        due = [word for word in FACET_WORDS if word is not None]
        begun = [place for place, word in zip(rest.tolist(), FACET_WORDS, strict=False) if word]
        for words in (facets[:, columns], np.array([begun], np.int64)):
            right = _are_words(text, words, due[: words.shape[1]])
            if not right.all():
                place = int(words.reshape(-1)[np.argmin(right)])
                word = due[int(np.argmin(right)) % words.shape[1]].decode()
                shown = text[place : place + 20].tobytes().split()[0].decode(errors="replace")
                self._refuse(start + place - 1, f"{shown!r} where {word!r} is due")

    def _bad_number(
        self, text: NDArray[np.uint8], facets: NDArray[np.int64], start: int
    ) -> InputError:
        corner = facets[:, _COORDINATES].reshape(-1)
        for place in corner.tolist():
            word = text[place : place + 80].tobytes().split()[0]
            try:
                numbers(word, np.float64, 1)
            except ValueError:
                line = line_number(self._text, start + place - 1)
                return contents_error(f"line {line}: {word[:30].decode(errors='replace')!r} is "
                                      "not a number; repair the mesh")
        return contents_error("bytes that no text has between the numbers; repair the mesh")


def _are_words(
    text: NDArray[np.uint8], places: NDArray[np.int64], words: Sequence[bytes]
) -> NDArray[np.bool_]:
    """Where ``words``, of up to eight letters, small or in capitals, stand: (n, words)."""
    eight = eight_bytes(text, places) | np.uint64(0x2020202020202020)
    sizes = np.array([len(word) for word in words], np.int64)
    keep = np.array([(1 << 8 * len(word)) - 1 for word in words], np.uint64)
    right = np.array([int.from_bytes(word, "little") for word in words], np.uint64)
    return np.asarray((eight & keep == right) & (text[places + sizes] <= SPACE), np.bool_)
