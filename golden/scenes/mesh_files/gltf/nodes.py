"""The nodes of a glTF scene: where each mesh stands."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..reading import Reading, contents_error
from .document import Document

Matrix = NDArray[np.float64]


def placed_nodes(document: Document, reading: Reading) -> Iterator[tuple[dict[str, Any], Matrix]]:
    """Every node of the scene with its matrix (4, 4) to world space, parents before children.

    The scene is the one that the file names, else its first, else all nodes without a
    parent.  Raises ``InputError`` for a node that is reached twice.
    """
    nodes = document.items("nodes")
    scenes = document.items("scenes")
    if scenes:
        chosen = document.json.get("scene", 0)
        roots = document.item("scenes", chosen).get("nodes", [])
        if len(scenes) > 1:
            reading.notes.append(f"{len(scenes)} scenes: scene {chosen} is drawn")
    else:
        children = {child for node in nodes for child in node.get("children", [])}
        roots = [index for index in range(len(nodes)) if index not in children]
        if nodes and not roots:
            raise contents_error("every node is another's child, round in a circle; repair the "
                                 "file")
    reached: set[int] = set()
    waiting = [(index, np.eye(4)) for index in reversed(roots)]
    while waiting:
        index, parent = waiting.pop()
        node = document.item("nodes", index)
        if index in reached:
            raise contents_error(f"node {index} is reached twice: a node has one parent, and not "
                                 "itself; repair the file")
        reached.add(index)
        matrix = parent @ _local(node, index)
        yield node, matrix
        waiting += [(child, matrix) for child in reversed(node.get("children", []))]


def _local(node: dict[str, Any], index: int) -> Matrix:
    if "matrix" in node:
        return _vector(node, "matrix", 16, index).reshape(4, 4).T
    matrix = np.eye(4)
    if "rotation" in node:
        x, y, z, w = _unit(_vector(node, "rotation", 4, index))
        matrix[:3, :3] = [
            [1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
            [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
            [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)],
        ]
    if "scale" in node:
        matrix[:3, :3] *= _vector(node, "scale", 3, index)
    if "translation" in node:
        matrix[:3, 3] = _vector(node, "translation", 3, index)
    return matrix


def _vector(node: dict[str, Any], name: str, size: int, index: int) -> NDArray[np.float64]:
    try:
        values = np.array(node[name], np.float64)
    except (TypeError, ValueError):
        values = np.zeros(0)
    if values.shape != (size,) or not np.isfinite(values).all():
        raise contents_error(f"node {index}: its {name} is not {size} numbers; repair the file")
    return values


def _unit(quaternion: NDArray[np.float64]) -> NDArray[np.float64]:
    length = float(np.sqrt((quaternion * quaternion).sum()))
    return quaternion / length if length > 0.0 else np.array([0.0, 0.0, 0.0, 1.0])
