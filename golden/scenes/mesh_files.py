"""Mesh files: ``.obj .stl .ply .glb .gltf`` to one ``Mesh`` each, through trimesh."""

from __future__ import annotations

import logging
import os
import warnings
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

from ..specification.errors import InputError
from .mesh import UP_Y, UP_Z, Mesh, Vector

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


def load_mesh(path: str | os.PathLike[str]) -> Mesh:
    """Read a mesh file: every part of its scene, transforms applied.

    Vertices and faces of a part are taken as they stand: nothing is merged, dropped or
    turned round, polygons are split into triangles.  Colours are those of the
    vertices or faces, or else the base colour of the material; textures are not
    read.  Normals in the file are ignored: see ``mesh.corner_normals``.

    Raises ``InputError`` of one line for everything that is not a usable mesh.
    """
    source = Path(path)
    suffix = source.suffix.lower()
    if suffix not in UP_OF_FORMAT:
        raise InputError(f"{source}: extension: {suffix or 'none'} is not a mesh format; use one "
                         f"of {' '.join(MESH_EXTENSIONS)}")
    _check_readable(source)
    try:
        with _silence():
            pieces = list(_pieces(source))
            mesh = _joined(pieces, UP_OF_FORMAT[suffix])
    except InputError as error:
        raise InputError(str(error).replace("mesh:", f"{source}:", 1)) from None
    except Exception as error:  # whatever a parser trips over in a bad file
        raise InputError(f"{source}: contents: not a readable {suffix} mesh "
                         f"({_reason(error)}); export it again") from None
    return mesh


def _check_readable(source: Path) -> None:
    try:
        if source.is_dir():
            raise InputError(f"{source}: file: is a directory; name the mesh file inside it")
        with source.open("rb") as file:
            empty = not file.read(1)
    except FileNotFoundError:
        raise InputError(f"{source}: file: no such file; check the path") from None
    except InputError:
        raise
    except (OSError, ValueError) as error:
        raise InputError(f"{source}: file: cannot be read ({_reason(error)})") from None
    if empty:
        raise InputError(f"{source}: contents: the file is empty; export the mesh again")


def _reason(error: BaseException) -> str:
    """One short printable line that says what an exception says."""
    text = error.strerror if isinstance(error, OSError) and error.strerror else str(error)
    printable = "".join(c if c.isprintable() else " " for c in text or type(error).__name__)
    line = " ".join(printable.split())
    return line if len(line) <= 120 else line[:117] + "..."


@contextmanager
def _silence() -> Iterator[None]:
    """No warnings and no log lines of the library: what matters becomes an ``InputError``."""
    logger = logging.getLogger("trimesh")
    disabled = logger.disabled
    logger.disabled = True
    try:
        with warnings.catch_warnings(), np.errstate(all="ignore"):
            warnings.simplefilter("ignore")
            yield
    finally:
        logger.disabled = disabled


_Piece = tuple[NDArray[np.float64], NDArray[np.int64], NDArray[np.uint8] | None]


def _pieces(source: Path) -> Iterator[_Piece]:
    """Vertices in world space, faces, and corner colours (or None) of each geometry."""
    import trimesh  # takes a moment: only those who read a file wait for it

    scene: Any = trimesh.load(str(source), force="scene", process=False, maintain_order=True)
    for node in scene.graph.nodes_geometry:
        transform, name = scene.graph[node]
        geometry = scene.geometry[name]
        faces = getattr(geometry, "faces", None)
        if faces is None or len(faces) == 0:
            continue
        faces = np.array(faces, np.int64)
        vertices = np.array(geometry.vertices, np.float64)
        # Checked here: joining the pieces would move a bad index into another piece.
        Mesh(vertices, faces)
        colors = _colors(geometry.visual, faces, len(vertices))
        matrix = np.asarray(transform, np.float64)
        if not np.array_equal(matrix, np.eye(4)):
            vertices = _transformed(vertices, matrix)
        if np.linalg.det(matrix[:3, :3]) < 0.0:  # a mirror turns the faces inside out
            faces = faces[:, ::-1].copy()
            colors = None if colors is None else colors[:, ::-1].copy()
        yield vertices, faces, colors


def _transformed(
    vertices: NDArray[np.float64], matrix: NDArray[np.float64]
) -> NDArray[np.float64]:
    """Apply an affine matrix, each vertex rounded alike (no matrix routine)."""
    x, y, z = vertices.T
    return np.stack([row[0] * x + row[1] * y + row[2] * z + row[3] for row in matrix[:3]], axis=1)


def _colors(
    visual: Any, faces: NDArray[np.int64], vertex_count: int
) -> NDArray[np.uint8] | None:
    """uint8 (f, 3, 3), or None where the file has no simple colours."""
    if visual.kind == "vertex":
        of_vertex = _channels(visual.vertex_colors, vertex_count)
        return None if of_vertex is None else of_vertex[faces]
    if visual.kind == "face":
        of_face = _channels(visual.face_colors, len(faces))
    else:
        base = _base_color(getattr(visual, "material", None))
        of_face = None if base is None else np.tile(base, (len(faces), 1))
    return None if of_face is None else np.repeat(of_face[:, None], 3, axis=1)


def _channels(colors: Any, count: int) -> NDArray[np.uint8] | None:
    array = np.asarray(colors)
    if array.dtype != np.uint8 or array.ndim != 2 or len(array) != count or array.shape[1] < 3:
        return None
    return array[:, :3].copy()


def _base_color(material: Any) -> NDArray[np.uint8] | None:
    """Base colour of a glTF material or ``Kd`` of an OBJ one; None where the file states none."""
    if hasattr(material, "materials"):  # several on one geometry: the first stands for all
        return _base_color(material.materials[0]) if material.materials else None
    if hasattr(material, "baseColorFactor"):
        stated = material.baseColorFactor is not None
    else:
        stated = "kd" in getattr(material, "kwargs", {})
    return np.array(material.main_color[:3], np.uint8) if stated else None


def _joined(pieces: list[_Piece], up: Vector) -> Mesh:
    if not pieces:
        raise InputError("mesh: faces: there are none; export the mesh with its triangles")
    first = np.cumsum([0] + [len(vertices) for vertices, _, _ in pieces])
    vertices = np.concatenate([vertices for vertices, _, _ in pieces])
    faces = np.concatenate([faces + first[i] for i, (_, faces, _) in enumerate(pieces)])
    if all(colors is None for _, _, colors in pieces):
        return Mesh(vertices, faces, up=up)
    colors = np.concatenate([
        Mesh(vertices, faces).corner_colors() if colors is None else colors
        for vertices, faces, colors in pieces
    ])
    return Mesh(vertices, faces, colors, up=up)
