"""Random triangles in screen space: a display list of its own, no camera."""

from __future__ import annotations

import numpy as np

from ...specification.display_list import DisplayList
from ...specification.errors import InputError
from ..quantise import PictureFormat
from .random_numbers import RandomNumbers


def random_display_list(
    picture: PictureFormat,
    background: tuple[int, int, int],
    *,
    gouraud: bool,
    n: int,
    size: float,
    seed: int,
) -> DisplayList:
    """``n`` triangles with corners uniform in a square box of ``size`` pixels.

    The box lies at a uniformly random sub-pixel position on the screen; one that
    is larger than the screen starts at its left or top edge.  Depths are uniform
    over the whole range at each corner, colours at each triangle (flat) or
    corner (gouraud).  The same seed gives the same list on every machine.

    Raises ``InputError`` where the box does not fit in the guard band.
    """
    if size > picture.guard_band - 1:
        raise InputError(f"random: size: {size:g} pixels do not fit in the guard band of a "
                         f"{picture.width}x{picture.height} picture; use at most "
                         f"{picture.guard_band - 1}")
    numbers = RandomNumbers(seed)
    box = max(1, round(size * (1 << picture.sub_bits)))
    corners = numbers.integers(box + 1, n, 3, 2)
    screen = np.array([picture.width, picture.height]) << picture.sub_bits
    room = np.maximum(screen - box, 0)
    shift = np.floor(numbers.uniform(n, 2) * (room + 1)).astype(np.int64)
    depth = numbers.integers(picture.depth_limit + 1, n, 3)
    color = numbers.integers(256, n, 3, 3)
    if not gouraud:
        color = np.repeat(color[:, :1], 3, axis=1)
    return DisplayList(
        width=picture.width,
        height=picture.height,
        position=(corners + shift[:, None]).astype(np.int32),
        depth=depth,
        color=color.astype(np.uint8),
        sub_bits=picture.sub_bits,
        depth_bits=picture.depth_bits,
        background=background,
    )
