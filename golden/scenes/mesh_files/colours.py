"""The colours of a mesh file: one rule for all formats.

The colour of a corner is that of its vertex times that of its face or material, as glTF
says.  What the file does not state counts as white; where it states neither, the mesh has
its own base colour.  Numbers are taken as they stand: 1.0 becomes 255, without any
conversion between linear light and sRGB, and rounded once, after the product.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..mesh import BASE_COLOR


def fractions(values: NDArray[Any], scale: np.dtype[Any] | None = None) -> NDArray[np.float64]:
    """Colours of a file, 0.0 … 1.0, float64 of the same shape.

    Floating-point colours run to 1, or to 255 where one of them lies above 1.  Whole
    numbers run to 255 whatever their width, or, where one of them lies above 255, to the
    full scale of their type (``scale``, or that of ``values``).
    """
    kind = values.dtype if scale is None else scale
    numbers = values.astype(np.float64)
    numbers[~np.isfinite(numbers)] = 0.0
    greatest = numbers.max(initial=0.0)
    if kind.kind == "f":
        full = 255.0 if greatest > 1.0 else 1.0
    elif kind.itemsize == 1:
        numbers %= 256.0  # a signed byte holds the same eight bits
        full = 255.0
    else:
        widest = float(np.iinfo(kind).max)
        full = min(next(c for c in (255.0, 65535.0, 2.0**64) if greatest <= c), widest)
    return np.asarray(np.clip(numbers / full, 0.0, 1.0), np.float64)


def corner_colors(
    faces: NDArray[np.int64],
    of_vertex: NDArray[np.float64] | None,
    of_face: NDArray[np.float64] | None,
) -> NDArray[np.uint8] | None:
    """uint8 (f, 3, 3): vertex colour times face colour at each corner; None without either.

    ``of_vertex`` (v, 3) and ``of_face`` (f, 3) run from 0 to 1; a row of NaN states nothing.
    """
    stated = [] if of_vertex is None else [of_vertex[faces]]
    if of_face is not None:
        stated.append(np.broadcast_to(of_face[:, None], (len(faces), 3, 3)))
    if not stated:
        return None
    product = np.where(np.isnan(stated[0]), 1.0, stated[0])
    for other in stated[1:]:
        product = product * np.where(np.isnan(other), 1.0, other)
    nothing = np.all([np.isnan(colors) for colors in stated], axis=0)
    colors = np.rint(np.clip(product, 0.0, 1.0) * 255.0).astype(np.uint8)
    return np.where(nothing, np.array(BASE_COLOR, np.uint8), colors)
