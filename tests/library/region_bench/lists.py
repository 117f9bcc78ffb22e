"""Random triangles for regions of any size, and tables that deal these out."""

from __future__ import annotations

import numpy as np

from cardcage.golden.specification.display_list import DisplayList, coordinate_bits


def listed(position, width: int, height: int, sub_bits: int) -> DisplayList:
    """Triangles of no depth and no colour."""
    position = np.array(position, np.int32).reshape(-1, 3, 2)
    return DisplayList(width, height, position, np.zeros((len(position), 3), np.int64),
                       np.zeros((len(position), 3, 3), np.uint8), sub_bits=sub_bits)


def random_list(random: np.random.Generator, triangles: int, width: int, height: int,
                sub_bits: int) -> DisplayList:
    """Of all sizes, some of them reaching beyond the screen, many with corners on pixel centres, in
    one row, in one column or almost in one line."""
    unit = 1 << sub_bits
    bits = coordinate_bits(width, height, sub_bits)
    size = (2.0 ** random.uniform(0, 8, (triangles, 1, 1)) * unit).astype(int)
    corners = random.integers(0, size + 1, (triangles, 3, 2))
    corners += random.integers(-2 * unit, max(width, height) * unit, (triangles, 1, 2))
    for number, way in enumerate(random.integers(0, 6, triangles)):
        if way == 0:
            corners[number] = corners[number] // unit * unit + unit // 2
        elif way == 1:
            corners[number, 1, 1] = corners[number, 0, 1]
        elif way == 2:
            corners[number, 2, 0] = corners[number, 0, 0]
        elif way == 3:
            corners[number, 2] = (corners[number, 0] + corners[number, 1]) // 2 + [0, 1]
    limit = 1 << (bits - 1)
    return listed(np.clip(corners, -limit, limit - 1), width, height, sub_bits)


def random_table(random: np.random.Generator, regions: int, elements: int, slots: int):
    """int64 (regions,): no element has more regions than slots; some may have none."""
    return random.permutation(np.repeat(np.arange(elements), slots))[:regions]
