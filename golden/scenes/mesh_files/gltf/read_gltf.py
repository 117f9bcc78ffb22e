"""glTF 2.0, ``.gltf`` and ``.glb``: the triangles of the default scene, in its base colours.

The libraries at hand read the JSON into objects and leave the rest to the caller, so the
document is read with ``json``, and here what it means: accessors, nodes, primitives.
Textures, lights, cameras and animations are not read.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

from ..colours import corner_colors
from ..reading import Part, Reading, check_indices, contents_error
from ..strips import fan_triangles, strip_triangles
from .accessors import Accessors
from .document import Document, read_document
from .nodes import Matrix, placed_nodes

TRIANGLES, STRIP, FAN = 4, 5, 6
#: What the modes 0 … 3 draw, and how it is called where it is left out.
_NOT_DRAWN: Final = ("points", "lines", "line loops", "line strips")


class _Meshes:
    """The primitives of each mesh, decoded once for all nodes that show it."""

    def __init__(self, document: Document, reading: Reading) -> None:
        self._document = document
        self._accessors = Accessors(document)
        self._reading = reading
        self._meshes: dict[int, list[Part]] = {}

    def parts(self, index: Any) -> list[Part]:
        mesh = self._document.item("meshes", index)
        if index not in self._meshes:
            self._meshes[index] = [
                part for number, primitive in enumerate(mesh.get("primitives", []))
                if (part := self._part(primitive, f"mesh {index}, primitive {number}"))
            ]
            if any(mesh.get("weights", [])):
                self._reading.notes.append(f"mesh {index} is drawn without its morph targets")
        return self._meshes[index]

    def _part(self, primitive: dict[str, Any], name: str) -> Part | None:
        mode = primitive.get("mode", TRIANGLES)
        attributes = primitive.get("attributes", {})
        if mode in range(len(_NOT_DRAWN)):
            self._reading.notes.append(f"{name}: {_NOT_DRAWN[mode]} are left out: only triangles "
                                       "are drawn")
            return None
        if mode not in (TRIANGLES, STRIP, FAN):
            raise contents_error(f"{name} has mode {mode}, which glTF does not know")
        if "POSITION" not in attributes:
            self._reading.notes.append(f"{name} has no positions and is left out")
            return None
        vertices = self._accessors.numbers(attributes["POSITION"])
        if vertices.shape[1] != 3:
            raise contents_error(f"{name}: positions of {vertices.shape[1]} numbers")
        if "indices" in primitive:
            corners = self._accessors.indices(primitive["indices"])
        else:
            corners = np.arange(len(vertices))
        check_indices(corners, len(vertices))
        faces = self._faces(corners, mode, name)
        of_vertex = self._vertex_colors(attributes, len(vertices), name)
        of_face = self._base_color(primitive, len(faces))
        return Part(vertices, faces, corner_colors(faces, of_vertex, of_face))

    def _faces(self, corners: NDArray[np.int64], mode: int, name: str) -> NDArray[np.int64]:
        if mode == STRIP:
            return strip_triangles(corners, np.array([len(corners)]))
        if mode == FAN:
            return fan_triangles(corners)
        over = len(corners) % 3
        if over:
            self._reading.notes.append(f"{name}: {over} of {len(corners)} corners make no whole "
                                       "triangle and are left out")
        return corners[: len(corners) - over].reshape(-1, 3)

    def _vertex_colors(
        self, attributes: dict[str, Any], count: int, name: str
    ) -> NDArray[np.float64] | None:
        if "COLOR_0" not in attributes:
            return None
        index = attributes["COLOR_0"]
        colors = self._accessors.numbers(index)
        component = self._document.item("accessors", index)["componentType"]
        if component != 5126 and not self._document.item("accessors", index).get("normalized"):
            # glTF has integer colours normalised, and some exporters forget to say so.
            colors = colors / {5121: 255.0, 5123: 65535.0}.get(component, 1.0)
        if len(colors) != count or colors.shape[1] not in (3, 4):
            raise contents_error(f"{name}: {len(colors)} colours of {colors.shape[1]} numbers for "
                                 f"{count} vertices; export it again")
        return np.clip(np.nan_to_num(colors[:, :3]), 0.0, 1.0)

    def _base_color(self, primitive: dict[str, Any], faces: int) -> NDArray[np.float64] | None:
        """The base colour of the material for each face; None where the file states none."""
        if "material" not in primitive:
            return None
        material = self._document.item("materials", primitive["material"])
        factor = material.get("pbrMetallicRoughness", {}).get("baseColorFactor")
        if factor is None:
            return None
        color = np.array(factor, np.float64)
        if color.shape not in ((3,), (4,)) or not np.isfinite(color).all():
            raise contents_error(f"material {primitive['material']}: baseColorFactor is not four "
                                 "numbers; export it again")
        return np.broadcast_to(color[:3], (faces, 3))


def read_gltf(data: bytes, folder: Path) -> Reading:
    """The triangles of the default scene; files that the document names are in ``folder``."""
    document = read_document(data, folder)
    reading = Reading()
    meshes = _Meshes(document, reading)
    skinned = 0
    for node, matrix in placed_nodes(document, reading):
        if "mesh" not in node:
            continue
        skinned += "skin" in node
        for part in meshes.parts(node["mesh"]):
            reading.parts.append(_placed(part, matrix))
    reading.note_count(skinned, "1 mesh has a skeleton and is drawn without it",
                       "{} meshes have a skeleton and are drawn without it")
    return reading


def _placed(part: Part, matrix: Matrix) -> Part:
    """A part in world space; where a mirror turns it inside out, its faces are turned back."""
    if np.array_equal(matrix, np.eye(4)):
        return part
    # Written out: each vertex is rounded alike, which a matrix routine does not promise.
    x, y, z = part.vertices.T
    vertices = np.stack([r[0] * x + r[1] * y + r[2] * z + r[3] for r in matrix[:3]], axis=1)
    if np.linalg.det(matrix[:3, :3]) >= 0.0:
        return Part(vertices, part.faces, part.colors)
    colors = None if part.colors is None else part.colors[:, ::-1].copy()
    return Part(vertices, part.faces[:, ::-1].copy(), colors)
