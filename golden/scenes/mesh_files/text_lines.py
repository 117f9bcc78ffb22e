"""Text of numbers, quickly: lines and words as numpy arrays of positions.

A file is taken in stretches of whole lines that fit the processor's cache: several times
faster than arrays of the whole file, and without a Python object per line or word.
"""

from __future__ import annotations

import codecs
from typing import Final

import numpy as np
from numpy.typing import NDArray

from .reading import contents_error

#: Bytes of text taken at a time.
STRETCH: Final = 1 << 19

TAB, NEWLINE, CARRIAGE_RETURN, SPACE = 9, 10, 13, 32

#: Blanks behind the lines, so that a few bytes may be looked at from any word on.
PADDING: Final = 9


def plain_text(data: bytes) -> bytes:
    """The text without byte order mark, with a newline at the end of every line.

    UTF-16 becomes UTF-8; Windows' and old Macintosh line ends become newlines.  Raises
    ``InputError`` for bytes that no text has.
    """
    if data.startswith((codecs.BOM_UTF16_LE, codecs.BOM_UTF16_BE)):
        try:
            data = data.decode("utf-16").encode()
        except UnicodeDecodeError:
            raise contents_error("UTF-16 text that breaks off within a character, or no text; "
                                 "save it as UTF-8") from None
    data = data.removeprefix(codecs.BOM_UTF8)
    if b"\0" in data:
        line = line_number(data, data.index(b"\0"))
        raise contents_error(f"line {line}: a zero byte in a text: the file is damaged, or "
                             "UTF-16 without a byte order mark; save it as UTF-8")
    if b"\r" in data:
        data = data.replace(b"\r\n", b"\n").replace(b"\r", b"\n")
    return data if data.endswith(b"\n") else data + b"\n"


def line_number(text: bytes, position: int) -> int:
    """Which line, counted from 1, a byte stands in."""
    return text.count(b"\n", 0, position) + 1


def stretch_end(text: bytes, start: int) -> int:
    """Where the next whole lines from ``start``, some ``STRETCH`` bytes, end."""
    return len(text) if start + STRETCH >= len(text) else text.index(b"\n", start + STRETCH) + 1


def stretch_from(text: bytes, start: int) -> bytes:
    """The next whole lines from ``start``; empty at the end."""
    return text[start : stretch_end(text, start)]


class Lines:
    """Whole lines, each ended by a newline.

    ``text``      uint8: one newline, the lines, ``PADDING`` blanks; so a line and its newline
                  are ``text[newlines[i] + 1 : newlines[i + 1] + 1]``
    ``newlines``  int64 (lines + 1,)
    ``words``     int64 (w,): where each word starts in ``text``
    ``ends``      int64 (w,): where the blank behind it stands
    ``first``     int64 (lines,): index in ``words`` of the line's first word
    ``count``     int64 (lines,): how many words the line has
    ``clean``     no byte between the words but those that a text has there

    All bytes up to 32 are blanks.  From ``comment`` (a byte) to the end of its line all
    becomes blank.
    """

    def __init__(self, lines: bytes, comment: bytes | None = None) -> None:
        self.text = np.full(1 + len(lines) + PADDING, SPACE, np.uint8)
        self.text[0] = NEWLINE
        self.text[1:-PADDING] = np.frombuffer(lines, np.uint8)
        if comment is not None and comment in lines:
            self._blank_comments(comment)
        blanks = np.flatnonzero(self.text[:-PADDING] <= SPACE)
        kinds = self.text[blanks]
        self.clean = bool(((kinds == SPACE) | (kinds - TAB <= CARRIAGE_RETURN - TAB)).all())
        bounds = np.flatnonzero(kinds == NEWLINE)
        self.newlines = blanks[bounds]
        filled = blanks[1:] - blanks[:-1] > 1
        if filled.all():
            self.words, self.ends = blanks[:-1] + 1, blanks[1:]
        else:  # some blanks have no word behind them
            before = np.flatnonzero(filled)
            self.words, self.ends = blanks[before] + 1, blanks[before + 1]
            bounds = np.append(0, np.cumsum(filled))[bounds]
        self.first = bounds[:-1]
        self.count = np.diff(bounds)

    def _blank_comments(self, comment: bytes) -> None:
        newlines = np.flatnonzero(self.text == NEWLINE)
        marks = np.flatnonzero(self.text == comment[0])
        line, first = np.unique(np.searchsorted(newlines, marks), return_index=True)
        self.text[ranges(marks[first], newlines[line] - marks[first])] = SPACE

    def bytes_of(self, chosen: NDArray[np.bool_]) -> bytes:
        """The text of some lines, ``chosen`` bool (lines,)."""
        lines = self.text[1 : self.newlines[-1] + 1]
        if chosen.all():
            return lines.tobytes()
        return lines[np.repeat(chosen, np.diff(self.newlines))].tobytes()


def ranges(starts: NDArray[np.int64], lengths: NDArray[np.int64]) -> NDArray[np.int64]:
    """``starts[i] … starts[i] + lengths[i] - 1`` for each i, one after the other."""
    before = np.cumsum(lengths) - lengths
    return np.asarray(np.repeat(starts - before, lengths) + np.arange(lengths.sum()), np.int64)
