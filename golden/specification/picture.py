"""A finished picture: what every model and every machine hands back."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

NO_PRIMITIVE = -1


@dataclass(frozen=True)
class Picture:
    """Colour, depth and winner of every pixel, rows first.

    ``color``   uint8 (height, width, 3)
    ``depth``   int64 (height, width); ``2**depth_bits - 1`` where nothing was drawn
    ``winner``  int32 (height, width): primitive number, ``NO_PRIMITIVE`` where nothing was drawn
    """

    color: NDArray[np.uint8]
    depth: NDArray[np.int64]
    winner: NDArray[np.int32]

    @property
    def height(self) -> int:
        return int(self.color.shape[0])

    @property
    def width(self) -> int:
        return int(self.color.shape[1])
