"""Triangles as words of the command stream: vertices, or what set-up made of them."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, TypeAlias

import numpy as np
from numpy.typing import NDArray

from ..specification.commands import (
    BODY_OFFSET,
    CHANNELS,
    EDGES,
    Opcode,
    pack,
    prepared_triangle_layout,
    triangle_layout,
)
from ..specification.configuration import MachineConfiguration
from ..specification.display_list import DisplayList
from .triangle_setup import PreparedTriangles, carry_edges

#: Of each triangle of a display list: int64 arrays ``node`` and ``round``, where the machine wants
#: them.  Nothing for a machine of one node.
Share: TypeAlias = Mapping[str, NDArray[np.int64]]
NO_SHARE: Share = {}


def _integers(array: Any) -> NDArray[np.object_]:
    return np.asarray(array).astype(object)


def triangles(configuration: MachineConfiguration, display_list: DisplayList,
              share: Share = NO_SHARE) -> NDArray[np.object_]:
    """The ``TRIANGLE`` command of every triangle of a list in the machine's formats, in order."""
    values: dict[str, Any] = {
        f"vertex_{corner}": {
            "x": display_list.position[:, corner, 0].astype(object),
            "y": display_list.position[:, corner, 1].astype(object),
            "depth": display_list.depth[:, corner].astype(object),
            **{name: display_list.color[:, corner, channel].astype(object)
               for channel, name in enumerate(CHANNELS)},
        } for corner in range(3)
    }
    values |= {name: _integers(array) for name, array in share.items()}
    body: NDArray[np.object_] = pack(triangle_layout(configuration), values)
    words: NDArray[np.object_] = (body << BODY_OFFSET) + int(Opcode.TRIANGLE)
    return words


def prepared_triangles(configuration: MachineConfiguration, prepared: PreparedTriangles,
                       share: Share = NO_SHARE) -> NDArray[np.object_]:
    """The ``PREPARED_TRIANGLE`` command of every prepared triangle, in order."""

    def plane(planes: Any) -> dict[str, Any]:
        return {name: _integers(getattr(planes, name)) for name in ("start", "step_x", "step_y")}

    colors: list[Any]
    if configuration.shading == "flat":
        assert prepared.flat_color is not None
        colors = [_integers(prepared.flat_color[:, channel]) for channel in range(3)]
    else:
        assert prepared.color is not None
        colors = [plane(planes) for planes in prepared.color]
    values: dict[str, Any] = {
        name: _integers(getattr(prepared, name))
        for name in ("top", "middle", "bottom", "left", "right", "long_edge_left")
    }
    for edge in EDGES:
        carried = carry_edges(getattr(prepared, edge), column_bits=configuration.edge_column_bits,
                              fraction_bits=configuration.edge_fraction_bits)
        values[edge] = {name: _integers(getattr(carried, name)) for name in ("start", "step")}
    of_primitive = {name: _integers(array[prepared.primitive]) for name, array in share.items()}
    values["planes"] = {"depth": plane(prepared.depth),
                        **dict(zip(CHANNELS, colors, strict=True)), **of_primitive}
    values |= of_primitive
    body: NDArray[np.object_] = pack(prepared_triangle_layout(configuration), values)
    words: NDArray[np.object_] = (body << BODY_OFFSET) + int(Opcode.PREPARED_TRIANGLE)
    return words

