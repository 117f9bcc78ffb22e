"""PLY, text and binary of either byte order: polygons and triangle strips with their colours.

The readers at hand are right and take minutes, or are quick and lose strips, colours or
the difference between float and double; the rows are therefore read here, as arrays.
Elements other than vertices, faces and strips are passed over, edges are counted.
"""

from __future__ import annotations

from pathlib import Path
from typing import Final

import numpy as np
from numpy.typing import NDArray

from ....specification.errors import InputError
from ..colours import corner_colors, fractions
from ..polygons import triangulate
from ..reading import Part, Reading, check_indices, contents_error
from ..strips import strip_triangles
from ..text_lines import line_number, plain_text
from .header import Element, read_header
from .rows import Rows, binary_rows, text_rows

#: The names of the list of a face's or strip's vertices.
_INDICES: Final = ("vertex_indices", "vertex_index")
_RESTART: Final = -1
_COLORS: Final = (("red", "green", "blue"), ("r", "g", "b"),
                  ("diffuse_red", "diffuse_green", "diffuse_blue"))


def read_ply(data: bytes, folder: Path) -> Reading:
    """The mesh of a PLY file.  A texture that its comments name is not read."""
    del folder
    data = _without_mark(data)
    header = read_header(data)
    reading = Reading()
    start = header.body
    if header.ascii:
        whole = data.endswith((b"\n", b"\r"))
        data = plain_text(data)
        header = read_header(data)
        start = header.body
        if not whole:
            reading.notes.append("the last line has no end: the file may be cut short")
    tables: dict[str, tuple[Element, Rows]] = {}
    for element in header.elements:
        rows, start = (text_rows if header.ascii else binary_rows)(data, start, element)
        tables[element.name] = element, rows
    if data[start:].strip(b"\0 \t\r\n"):
        where = (f"line {line_number(data, len(data) - len(data[start:].lstrip()))}"
                 if header.ascii else f"{len(data) - start} bytes")
        raise contents_error(f"{where} after the last row that the header announces; repair the "
                             "header")
    _take(tables, reading)
    return reading


def _without_mark(data: bytes) -> bytes:
    """Without byte order mark; binary bodies stay as they are."""
    if data[:2] in (b"\xff\xfe", b"\xfe\xff"):
        return plain_text(data)
    return data.removeprefix(b"\xef\xbb\xbf")


def _take(tables: dict[str, tuple[Element, Rows]], reading: Reading) -> None:
    if "vertex" not in tables:
        raise contents_error("no element 'vertex' in the header: no mesh")
    vertex = tables["vertex"][1].scalars
    missing = [name for name in "xyz" if name not in vertex]
    if missing:
        raise contents_error(f"vertices have no property {missing[0]!r}; export the mesh again")
    vertices = np.empty((tables["vertex"][0].count, 3))
    for column, name in enumerate("xyz"):
        vertices[:, column] = vertex[name]
    of_vertex = _colors(*tables["vertex"])
    if "face" in tables:
        corners, sizes = _indices("face", tables["face"][1])
        cut = triangulate(vertices, corners, sizes, reading)
        of_face = _colors(*tables["face"])
        faces = cut.of_corners(corners)
        reading.parts.append(Part(vertices, faces, corner_colors(
            faces, of_vertex, None if of_face is None else cut.of_polygons(of_face))))
    if "tristrips" in tables:
        corners, sizes = _indices("tristrips", tables["tristrips"][1])
        check_indices(corners[corners != _RESTART], len(vertices))
        faces = strip_triangles(corners, sizes, restart=_RESTART)
        reading.parts.append(Part(vertices, faces, corner_colors(faces, of_vertex, None)))
    if "edge" in tables:
        reading.note_count(tables["edge"][0].count,
                           "1 edge is left out: only faces are drawn",
                           "{} edges are left out: only faces are drawn")


def _indices(name: str, rows: Rows) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """The vertices of all rows, and how many each row has."""
    found = [rows.lists[of] for of in _INDICES if of in rows.lists]
    if not found:
        raise InputError(f"mesh: faces: element {name!r} has no list {' or '.join(_INDICES)}; "
                         "export the mesh again")
    items, sizes = found[0]
    corners = items.astype(np.int64, copy=False)
    if name == "tristrips":  # -1 in an unsigned list
        corners = np.where(corners == 0xFFFFFFFF, _RESTART, corners)
    if items.dtype.kind == "f" and (corners != items).any():
        raise InputError("mesh: faces: a vertex number is no whole number; repair the mesh")
    return corners, sizes


def _colors(element: Element, rows: Rows) -> NDArray[np.float64] | None:
    for names in _COLORS:
        if all(name in rows.scalars for name in names):
            kinds = {p.name: p.dtype for p in element.properties}
            values = np.stack([rows.scalars[name] for name in names], axis=1)
            return fractions(values, kinds[names[0]])
    return None
