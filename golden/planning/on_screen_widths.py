"""How wide a machine must be for triangles that have all their vertices on the screen."""

from __future__ import annotations

from typing import Any

from ..specification.widths import fewest_edge_fraction_bits


def on_screen_widths(width: int, height: int, sub_bits: int) -> dict[str, Any]:
    """The fields of ``MachineConfiguration`` that such triangles need less of than those that
    reach into the guard band.

    A machine with these widths draws every triangle that has all its vertices on the screen as
    a machine with the default widths does; it may refuse another one.
    """
    rows = height << sub_bits
    farthest = max(width, height) << sub_bits
    return {
        "coordinate_bits": 1 + farthest.bit_length(),
        "edge_column_bits": width.bit_length(),
        "edge_height_bits": rows.bit_length(),
        "edge_fraction_bits": fewest_edge_fraction_bits(rows, rows * height),
    }
