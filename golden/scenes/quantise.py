"""From homogeneous pixels to the integers of the display list (the last floating point)."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ..specification.display_list import coordinate_bits
from ..specification.ranges import FORMAT_RANGES, check_whole


@dataclass(frozen=True)
class PictureFormat:
    """Size and precision of a display list.

    ``width``, ``height``  pixels, 1 … 4096
    ``sub_bits``           positions are in units of 2**-sub_bits pixel, 1 … 8
    ``depth_bits``         depths are 0 … 2**depth_bits - 2, 2 … 32

    Raises ``InputError`` where a number is out of range.
    """

    width: int = 64
    height: int = 64
    sub_bits: int = 8
    depth_bits: int = 24

    def __post_init__(self) -> None:
        for field, low, high in FORMAT_RANGES:
            check_whole(f"picture: {field}", getattr(self, field), low, high)

    @property
    def guard_band(self) -> int:
        """Positions lie in [-g, g) pixels."""
        return 1 << (coordinate_bits(self.width, self.height, self.sub_bits) - 1 - self.sub_bits)

    @property
    def guard_band_end(self) -> float:
        """The greatest position, in pixels, that the grid holds: exact in floating point."""
        return self.guard_band - 2.0**-self.sub_bits

    @property
    def depth_limit(self) -> int:
        return (1 << self.depth_bits) - 2


def round_half_up(values: NDArray[np.float64]) -> NDArray[np.int64]:
    """floor(value + ½), exact: the sum itself may not be rounded up past a whole number."""
    whole = np.floor(values)
    return (whole + (values - whole >= 0.5)).astype(np.int64)


def quantise_positions(
    homogeneous: NDArray[np.float64], picture: PictureFormat
) -> NDArray[np.int32]:
    """Snap homogeneous pixel positions (…, 4) with w > 0, clipped to the guard band.

    Returns int32 (…, 2) in units of 2**-sub_bits pixel.  A vertex that clipping
    put on the band's edge may be off it by a rounding: it is held inside, and
    since that depends on the vertex alone, neighbours stay joined.
    """
    pixels = homogeneous[..., :2] / homogeneous[..., 3:4]
    held = np.clip(pixels, -picture.guard_band, picture.guard_band_end)
    return round_half_up(held * (1 << picture.sub_bits)).astype(np.int32)


def quantise_depths(homogeneous: NDArray[np.float64], picture: PictureFormat) -> NDArray[np.int64]:
    """z / w of (…, 4), from 0 at the near plane to 1 at the far one, to int64 (…)."""
    depth = np.clip(homogeneous[..., 2] / homogeneous[..., 3], 0.0, 1.0)
    return round_half_up(depth * picture.depth_limit)


def quantise_colors(colors: NDArray[np.float64]) -> NDArray[np.uint8]:
    """Channels 0 … 255 as float64 to uint8, saturated."""
    return np.clip(round_half_up(colors), 0, 255).astype(np.uint8)
