"""The header of a PLY file: which elements follow, with which properties."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Final

import numpy as np

from ..reading import contents_error

_TYPES: Final = {
    "char": "i1", "uchar": "u1", "short": "i2", "ushort": "u2", "int": "i4", "uint": "u4",
    "float": "f4", "double": "f8",
    "int8": "i1", "uint8": "u1", "int16": "i2", "uint16": "u2", "int32": "i4", "uint32": "u4",
    "float32": "f4", "float64": "f8", "int64": "i8", "uint64": "u8",
}
_BYTE_ORDERS: Final = {"ascii": "=", "binary_little_endian": "<", "binary_big_endian": ">"}


@dataclass(frozen=True)
class Property:
    """One number of each row, or a list of numbers where ``count`` is not None."""

    name: str
    dtype: np.dtype[Any]
    count: np.dtype[Any] | None = None


@dataclass(frozen=True)
class Element:
    name: str
    count: int
    properties: tuple[Property, ...]


@dataclass(frozen=True)
class Header:
    """``body`` is the position of the first byte after the header."""

    ascii: bool
    elements: tuple[Element, ...]
    body: int


def read_header(data: bytes) -> Header:
    """Raises ``InputError`` that names the line for what no PLY header has."""
    if data[:3] != b"ply":
        raise contents_error("does not begin with 'ply': no PLY file")
    # As the first line ends, so do the others: a byte 10 after the header may be data.
    end = b"\r\n" if data[3:20].lstrip(b" \t")[:2] == b"\r\n" else data[3:20].lstrip(b" \t")[:1]
    if end not in (b"\n", b"\r", b"\r\n"):
        raise contents_error("does not begin with a line 'ply': no PLY file, or cut short")
    order: str | None = None
    elements: list[tuple[str, int, list[Property]]] = []
    start, line_number = data.index(end) + len(end), 1
    while True:
        stop = data.find(end, start)
        if stop < 0:
            raise contents_error("the header has no end: the file is cut short")
        line_number += 1
        words = data[start:stop].decode("latin-1").split()
        start = stop + len(end)
        try:
            match words:
                case [] | ["comment" | "obj_info", *_]:
                    pass
                case ["format", kind, _]:
                    order = _BYTE_ORDERS[kind]
                case ["element", name, count]:
                    elements.append((name, _count(count), []))
                case ["property", "list", count, kind, name]:
                    of_list = Property(name, _dtype(kind, order), _dtype(count, order))
                    elements[-1][2].append(of_list)
                case ["property", kind, name]:
                    elements[-1][2].append(Property(name, _dtype(kind, order)))
                case ["end_header"]:
                    break
                case _:
                    raise ValueError
        except (ValueError, KeyError, IndexError):
            shown = " ".join(words)[:60]
            raise contents_error(f"line {line_number}: cannot read {shown!r} in the header; "
                                 "repair the file") from None
    if order is None:
        raise contents_error("the header has no line 'format'; repair the file")
    return Header(order == "=", tuple(Element(n, c, tuple(p)) for n, c, p in elements), start)


def _count(word: str) -> int:
    if not word.isascii() or not word.isdigit():
        raise ValueError
    return int(word)


def _dtype(name: str, order: str | None) -> np.dtype[Any]:
    if order is None:
        raise ValueError
    return np.dtype(order + _TYPES[name])
