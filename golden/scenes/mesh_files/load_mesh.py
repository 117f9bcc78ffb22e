"""Mesh files: ``.obj .stl .ply .glb .gltf`` to one ``Mesh`` each."""

from __future__ import annotations

import dataclasses
import os
from collections.abc import Callable
from pathlib import Path
from typing import Final

import numpy as np

from ...specification.errors import InputError
from ..mesh import UP_Y, UP_Z, Mesh, Vector
from .gltf.read_gltf import read_gltf
from .obj import read_obj
from .ply.read_ply import read_ply
from .reading import Reading, joined
from .stl import read_stl

#: The up axis by file format.  glTF defines y; OBJ and PLY modellers use it by
#: custom; STL comes from mechanical design and printing, where z is up.
UP_OF_FORMAT: Final[dict[str, Vector]] = {
    ".obj": UP_Y,
    ".stl": UP_Z,
    ".ply": UP_Y,
    ".glb": UP_Y,
    ".gltf": UP_Y,
}

MESH_EXTENSIONS: Final = tuple(UP_OF_FORMAT)

#: Bytes of an array that is made and freed at once.  From then on the C library of Linux keeps
#: for the next arrays what arrays of up to this size free, rather than hand it back to the
#: system, which clears every page anew: that would take as long as the reading itself.
_KEPT: Final = 24 << 20

#: Each takes the bytes of the file and the folder where other files that it names are found.
_READERS: Final[dict[str, Callable[[bytes, Path], Reading]]] = {
    ".obj": read_obj,
    ".stl": read_stl,
    ".ply": read_ply,
    ".glb": read_gltf,
    ".gltf": read_gltf,
}


def load_mesh(path: str | os.PathLike[str]) -> Mesh:
    """Read a mesh file: every part of its scene, transforms applied.

    Vertices and faces of a part are taken as they stand: nothing is merged or turned
    round, polygons are split into triangles.  The colour of a corner is that of its
    vertex times that of its face or material; textures are not read.  Normals in the
    file are ignored: see ``mesh.corner_normals``.  ``docs/mesh-files.md`` has the rules.

    ``Mesh.notes`` says in one line each what was left out.  Raises ``InputError`` of one
    line for everything that is not a usable mesh, a file that is cut short included.
    """
    source = Path(path)
    suffix = source.suffix.lower()
    if suffix not in UP_OF_FORMAT:
        raise InputError(f"{source}: extension: {suffix or 'none'} is not a mesh format; use one "
                         f"of {' '.join(MESH_EXTENSIONS)}")
    np.empty(_KEPT, np.uint8)
    data = _contents(source)
    try:
        with np.errstate(all="ignore"):
            reading = _READERS[suffix](data, source.parent)
            mesh = joined(reading.parts, reading.notes)
    except InputError as error:
        text = str(error).removeprefix("mesh: ")
        raise InputError(f"{source}: {_one_line(text, 300)}") from None
    except Exception as error:  # whatever a reader trips over in a bad file
        raise InputError(f"{source}: contents: not a readable {suffix} mesh "
                         f"({_reason(error)}); export it again") from None
    notes = tuple(_one_line(note, 300) for note in reading.notes)
    return dataclasses.replace(mesh, up=UP_OF_FORMAT[suffix], notes=notes)


def _contents(source: Path) -> bytes:
    try:
        if source.is_dir():
            raise InputError(f"{source}: file: is a directory; name the mesh file inside it")
        data = source.read_bytes()
    except FileNotFoundError:
        raise InputError(f"{source}: file: no such file; check the path") from None
    except InputError:
        raise
    except (OSError, ValueError, MemoryError) as error:
        raise InputError(f"{source}: file: cannot be read ({_reason(error)}); make it readable, or "
                         "name another file") from None
    if not data:
        raise InputError(f"{source}: contents: the file is empty; export the mesh again")
    return data


def _reason(error: BaseException) -> str:
    """One short printable line that says what an exception says."""
    text = error.strerror if isinstance(error, OSError) and error.strerror else str(error)
    return _one_line(text or type(error).__name__, 120)


def _one_line(text: str, limit: int) -> str:
    line = " ".join("".join(c if c.isprintable() else " " for c in text).split())
    return line if len(line) <= limit else line[: limit - 3] + "..."
