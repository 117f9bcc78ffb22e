"""The rows of a PLY element, from text or binary, as one array per property."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

from ....specification.errors import InputError
from ..decimals import decimals
from ..numbers import numbers
from ..reading import contents_error
from ..text_lines import Lines, line_number, ranges, stretch_from
from .header import Element

#: A row of two bytes is the least that a list takes: a greater count cannot be true.
_LONGEST_LIST: Final = 1 << 31


@dataclass
class Rows:
    """``scalars``: a number a row.  ``lists``: the items of all rows, and how many each row has."""

    scalars: dict[str, NDArray[Any]] = field(default_factory=dict)
    lists: dict[str, tuple[NDArray[Any], NDArray[np.int64]]] = field(default_factory=dict)


def cut_short(element: Element, there: int) -> InputError:
    return contents_error(f"{element.count} rows of {element.name!r} are announced and {there} are "
                          "there: the file is cut short, or its header wrong")


def text_rows(text: bytes, start: int, element: Element) -> tuple[Rows, int]:
    """The rows of an element, a line each, from byte ``start`` on; then where the next begin."""
    pieces = []
    left = element.count if element.properties else 0
    whole = all(p.dtype.kind != "f" for p in element.properties)
    while left:
        stretch = stretch_from(text, start)
        if not stretch:
            raise cut_short(element, element.count - left)
        lines = Lines(stretch)
        chosen = lines.count > 0
        rows = np.flatnonzero(chosen)[:left]
        if len(rows):
            last = int(rows[-1])
            chosen[last + 1 :] = False
            pieces.append(_split(text, start, lines, chosen, element, whole))
            left -= len(rows)
            start += int(lines.newlines[last + 1])
        else:
            start += len(stretch)
    return _joined(element, pieces), start


def _split(
    text: bytes, start: int, lines: Lines, chosen: NDArray[np.bool_], element: Element, whole: bool
) -> Rows:
    """Some lines of text: the words of each, shared out among the properties."""
    counts = lines.count[chosen]
    values = _numbers(text, start, lines, chosen, element, whole)
    if (counts == counts[0]).all():
        table = _table(element, values.reshape(len(counts), -1))
        if table is not None:
            return table
    begin = np.cumsum(counts) - counts
    at, end = begin.copy(), begin + counts
    rows = Rows()
    for field_ in element.properties:
        there = np.append(values, 0)[np.minimum(at, len(values))]
        if field_.count is None:
            rows.scalars[field_.name] = there
            at = at + 1
        else:
            length = np.where(at < end, there, 0).astype(np.int64)
            bad = (length < 0) | (at + 1 + length > end)
            if bad.any():
                at[bad] = end[bad] + 1
                break
            rows.lists[field_.name] = (values[ranges(at + 1, length)], length)
            at = at + 1 + length
    if (at != end).any():
        row = int(np.argmax(at != end))
        place = start + int(lines.newlines[:-1][chosen][row])
        raise contents_error(f"line {line_number(text, place)}: {counts[row]} numbers do not make "
                             f"a row of {element.name!r}; the file is cut short or damaged")
    return rows


def _numbers(
    text: bytes, start: int, lines: Lines, chosen: NDArray[np.bool_], element: Element, whole: bool
) -> NDArray[Any]:
    """All numbers of the chosen lines, which are the first ones that hold any."""
    kind = np.int64 if whole else np.float64
    count = int(lines.count[chosen].sum())
    if lines.clean:
        values = decimals(lines.text, lines.words[:count], lines.ends[:count], kind)
        if values is not None:
            return values
    try:
        return numbers(lines.bytes_of(chosen), kind, count)
    except ValueError:
        raise _bad_line(text, start, lines, chosen, element, whole) from None


def _table(element: Element, values: NDArray[Any]) -> Rows | None:
    """Rows (rows, numbers) of which all have lists of one length; None where they have not."""
    rows, at = Rows(), 0
    for p in element.properties:
        if at >= values.shape[1]:
            return None
        first = values[:, at]
        at += 1
        if p.count is None:
            rows.scalars[p.name] = first
            continue
        length = int(first[0])
        if (first != length).any() or not 0 <= length <= values.shape[1] - at:
            return None
        rows.lists[p.name] = values[:, at : at + length], np.full(len(values), length)
        at += length
    return rows if at == values.shape[1] else None


def _bad_line(
    text: bytes, start: int, lines: Lines, chosen: NDArray[np.bool_], element: Element, whole: bool
) -> InputError:
    for index in np.flatnonzero(chosen).tolist():
        words = lines.text[lines.newlines[index] : lines.newlines[index + 1]].tobytes()
        try:
            numbers(words, np.int64 if whole else np.float64, int(lines.count[index]))
        except ValueError:
            line = line_number(text, start + int(lines.newlines[index]))
            shown = " ".join(words.decode(errors="replace").split())[:60]
            return contents_error(f"line {line}: cannot read {shown!r} as a row of "
                                  f"{element.name!r}; repair the file")
    return contents_error("bytes that no text has between the numbers; repair the file")


def binary_rows(data: bytes, start: int, element: Element) -> tuple[Rows, int]:
    """The rows of an element from byte ``start`` on; then where the next begin."""
    if not element.count or not element.properties:
        return _joined(element, []), start
    lists = [p for p in element.properties if p.count is not None]
    # Rows of one length are an array that numpy reads as it stands.
    lengths = _first_lengths(data, start, element)
    dtype = _row_dtype(element, lengths)
    if start + element.count * dtype.itemsize <= len(data):
        array = np.frombuffer(data, dtype, element.count, start)
        if all((array[f"{p.name} count"] == n).all() for p, n in zip(lists, lengths, strict=True)):
            rows = Rows()
            for p in element.properties:
                if p.count is None:
                    rows.scalars[p.name] = array[p.name]
                else:
                    items = array[p.name]
                    rows.lists[p.name] = (items.reshape(-1), np.full(element.count, items.shape[1]))
            return rows, start + element.count * dtype.itemsize
    if not lists:
        raise cut_short(element, (len(data) - start) // dtype.itemsize)
    return _walked(data, start, element)


def _row_dtype(element: Element, lengths: list[int]) -> np.dtype[Any]:
    names, formats, left = [], [], iter(lengths)
    for p in element.properties:
        if p.count is not None:
            names.append(f"{p.name} count")
            formats.append(np.dtype(p.count))
        names.append(p.name)
        formats.append(p.dtype if p.count is None else np.dtype((p.dtype, (next(left),))))
    return np.dtype(list(zip(names, formats, strict=True)))


def _first_lengths(data: bytes, start: int, element: Element) -> list[int]:
    at, lengths = start, []
    for p in element.properties:
        if p.count is not None:
            lengths.append(_length(data, at, p.count, element, 0))
            at += p.count.itemsize + lengths[-1] * p.dtype.itemsize
        else:
            at += p.dtype.itemsize
    return lengths


def _length(data: bytes, at: int, kind: np.dtype[Any], element: Element, row: int) -> int:
    if at + kind.itemsize > len(data):
        raise cut_short(element, row)
    length = int(np.frombuffer(data, kind, 1, at)[0])
    if not 0 <= length < _LONGEST_LIST or at + length > len(data):
        raise cut_short(element, row)
    return length


def _walked(data: bytes, start: int, element: Element) -> tuple[Rows, int]:
    """Rows of different lengths: where one starts follows from the one before."""
    # Bytes between the lists, and one step of Python for each list.
    steps: list[tuple[int, int, int, np.dtype[Any]]] = []
    gap = 0
    for p in element.properties:
        if p.count is None:
            gap += p.dtype.itemsize
        else:
            steps.append((gap, p.count.itemsize, p.dtype.itemsize, p.count))
            gap = 0
    places: list[int] = []
    at = start
    row = 0
    try:
        if len(steps) == 1 and steps[0][1] == 1 and steps[0][3].kind == "u":
            before, _, size, _ = steps[0]
            fixed = 1 + gap
            at += before
            fixed += before
            for row in range(element.count):  # noqa: B007
                places.append(at)
                at += fixed + size * data[at]
            at -= before
        else:
            for row in range(element.count):
                for before, width, size, kind in steps:
                    at += before
                    places.append(at)
                    at += width + size * _length(data, at, kind, element, row)
                at += gap
    except IndexError:
        raise cut_short(element, row) from None
    if at > len(data):
        raise cut_short(element, element.count - 1)
    return _gathered(data, element, np.array(places, np.int64).reshape(element.count, -1)), at


def _gathered(data: bytes, element: Element, places: NDArray[np.int64]) -> Rows:
    """All properties, where ``places`` (rows, lists) says where the count of each list stands."""
    raw = np.frombuffer(data, np.uint8)
    rows = Rows()
    done = 0
    # Positions run forwards from the last list, and backwards to the first one.
    lead = 0
    for p in element.properties:
        if p.count is not None:
            break
        lead += p.dtype.itemsize
    at = places[:, 0] - lead
    for p in element.properties:
        if p.count is None:
            rows.scalars[p.name] = _values(raw, at, p.dtype)
            at = at + p.dtype.itemsize
        else:
            lengths = _values(raw, places[:, done], p.count).astype(np.int64)
            first = places[:, done] + p.count.itemsize
            size = p.dtype.itemsize
            items = raw[ranges(first, lengths * size)].view(p.dtype)
            rows.lists[p.name] = (items, lengths)
            at = first + lengths * size
            done += 1
    return rows


def _values(
    raw: NDArray[np.uint8], places: NDArray[np.int64], dtype: np.dtype[Any]
) -> NDArray[Any]:
    taken = raw[places[:, None] + np.arange(dtype.itemsize)]
    return np.ascontiguousarray(taken).view(dtype).reshape(-1)


def _joined(element: Element, pieces: list[Rows]) -> Rows:
    rows = Rows()
    for p in element.properties:
        none = np.zeros(0, p.dtype)
        if p.count is None:
            rows.scalars[p.name] = np.concatenate([none, *(x.scalars[p.name] for x in pieces)])
        else:
            rows.lists[p.name] = (
                np.concatenate([none, *(x.lists[p.name][0] for x in pieces)], axis=None),
                np.concatenate([np.zeros(0, np.int64), *(x.lists[p.name][1] for x in pieces)]),
            )
    return rows
