"""What a reader hands back: the parts of a file, and the lines that say what it left out."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from ...specification.errors import InputError
from ..mesh import Mesh


@dataclass(frozen=True)
class Part:
    """Triangles with one set of vertices.

    ``vertices``  float64 (v, 3), in world space
    ``faces``     int64 (f, 3): indices into ``vertices``
    ``colors``    uint8 (f, 3, 3): the colour at each corner, or None where the file states none
    """

    vertices: NDArray[np.float64]
    faces: NDArray[np.int64]
    colors: NDArray[np.uint8] | None = None


@dataclass
class Reading:
    """The parts of a file in drawing order, and its notes: one line each, without the file name."""

    parts: list[Part] = field(default_factory=list)
    notes: list[str] = field(default_factory=list)

    def note_count(self, count: int, one: str, many: str) -> None:
        """Say how many of something were left out; nothing where none was."""
        if count:
            self.notes.append(one if count == 1 else many.format(count))


def contents_error(text: str) -> InputError:
    """What is wrong with the contents of a file; ``load_mesh`` puts the file's name in front.  The
    remedy is behind a semicolon; where ``text`` has none, another export."""
    return InputError(f"mesh: contents: {text if ';' in text else f'{text}; export it again'}")


def check_indices(corners: NDArray[np.int64], vertex_count: int) -> None:
    """Raise ``InputError`` where a corner names a vertex that is not there."""
    # As numbers without a sign, negative ones are great ones.
    if len(corners) and corners.view(np.uint64).max() >= vertex_count:
        bad = corners[(corners < 0) | (corners >= vertex_count)][0]
        raise InputError(f"mesh: faces: a face names vertex {bad}, but there are {vertex_count} "
                         "vertices, counted from 0; repair the mesh")


def joined(parts: list[Part], notes: Sequence[str] = ()) -> Mesh:
    """One mesh of all parts; what has no colour of its own gets the base colour."""
    parts = [part for part in parts if len(part.faces)]
    if not parts:
        why = f" ({notes[0]})" if notes else ""
        raise InputError(f"mesh: faces: there are none{why}; export the mesh with its triangles")
    if len(parts) == 1:
        return Mesh(parts[0].vertices, parts[0].faces, parts[0].colors)
    for part in parts:  # a bad index must not move into another part
        check_indices(part.faces.reshape(-1), len(part.vertices))
    first = np.cumsum([0] + [len(part.vertices) for part in parts])
    vertices = np.concatenate([part.vertices for part in parts])
    faces = np.concatenate([part.faces + first[i] for i, part in enumerate(parts)])
    if all(part.colors is None for part in parts):
        return Mesh(vertices, faces)
    return Mesh(vertices, faces, np.concatenate([
        Mesh(part.vertices, part.faces).corner_colors() if part.colors is None else part.colors
        for part in parts
    ]))
