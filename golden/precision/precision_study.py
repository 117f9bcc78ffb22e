"""How far pictures of a scene are off, precision by precision.

Against ``exact``, which has the display list's numbers and all the precision it
takes, it is the machine's own error: that of its fraction bits.  Against
``unquantised`` it is what a viewer gets: the grids of vertices and depths included.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from math import ceil
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..planning.scene_needs import scene_needs
from ..reference import bit_true, exact
from ..specification import fixed_point
from ..specification.display_list import DisplayList, Shading, shading_for
from ..specification.picture import Picture
from . import float32_depth_buffer, unquantised
from .unquantised import ScreenTriangles, UnquantisedScene

#: Formats of a display list that are compared: these sub-pixel bits with the list's own depth bits,
#: and these depth bits with its own sub-pixel bits (``formats``).
SUB_BITS = (1, 2, 4, 6, 8)
DEPTH_BITS = (8, 12, 16, 24, 32)


@dataclass(frozen=True)
class PictureError:
    """One picture against another, which is right.

    ``pixels``          on which the right picture, or this one, has drawn something
    ``wrong_pixels``    of these, where another primitive is seen, or none, or one that should not
    ``depth_maximum``, ``depth_mean``  LSB, where the right primitive is seen
    ``depth_anywhere``  greatest, LSB, where both have drawn something
    ``color_maximum``   of a channel, in steps of 1 in 255, where the right primitive is seen
    """

    pixels: int
    wrong_pixels: int
    depth_maximum: float
    depth_mean: float
    depth_anywhere: float
    color_maximum: float

    @property
    def none(self) -> bool:
        """The pictures are equal wherever something was drawn."""
        return not self.wrong_pixels and not self.depth_maximum and not self.color_maximum


def picture_error(got: Picture, winner: NDArray[np.int32], depth: NDArray[Any],
                  color: NDArray[Any]) -> PictureError:
    """``got`` against a right picture: (h, w) winners, (h, w) depths in LSB, (h, w, 3) colours."""
    drawn, both = (got.winner >= 0) | (winner >= 0), (got.winner >= 0) & (winner >= 0)
    right = both & (got.winner == winner)
    # In float64, which holds depths of 32 bits and is what real ones come in.
    depth_error = abs(got.depth.astype(np.float64) - depth)
    color_error = abs(got.color.astype(np.float64) - color)
    return PictureError(
        pixels=int(drawn.sum()),
        wrong_pixels=int((drawn & ~right).sum()),
        depth_maximum=float(depth_error[right].max(initial=0.0)),
        depth_mean=float(depth_error[right].mean()) if right.any() else 0.0,
        depth_anywhere=float(depth_error[both].max(initial=0.0)),
        color_maximum=float(color_error[right].max(initial=0.0)),
    )


@dataclass(frozen=True)
class FractionBitsPoint:
    """The machine at one number of fraction bits.

    ``bound``       LSB by which a stored depth or channel may be off: ``fixed_point.error_bound``
                    at the scene's greatest extent, rounded up; 0 where the scene is exact
    ``error``       against the exact picture
    ``end_to_end``  against the unquantised one
    """

    fraction_bits: int
    bound: int
    error: PictureError
    end_to_end: PictureError

    @property
    def within_bound(self) -> bool:
        """Depths anywhere, and colours of right winners; at bound 0 the whole picture.

        The least of several depths, each off by at most the bound, is off by no
        more: so depths count where the winner is wrong as well.
        """
        if self.bound == 0:
            return self.error.none
        return max(self.error.depth_anywhere, self.error.color_maximum) <= self.bound


@dataclass(frozen=True)
class FormatPoint:
    """An exact machine for vertices of ``sub_bits`` and depths of ``depth_bits``, end to end."""

    sub_bits: int
    depth_bits: int
    exact_fraction_bits: int
    end_to_end: PictureError


@dataclass(frozen=True)
class Float32Point:
    """``float32_depth_buffer`` of the display list's vertices against the exact picture, and of the
    scene's own, end to end."""

    error: PictureError
    end_to_end: PictureError


class PrecisionStudy:
    """One scene at one resolution, to be measured at any precision.

    ``display_list``  what the machine draws, and ``scene``, what that was made from
    ``shading``       None: as the list needs
    ``x_shift``, ``y_shift``  as in ``exact.draw``

    ``extent``, ``exact_fraction_bits``  of the list: see ``scene_needs``
    """

    def __init__(self, display_list: DisplayList, scene: UnquantisedScene, *,
                 shading: Shading | None = None, x_shift: int = 0, y_shift: int = 0) -> None:
        self.display_list = display_list
        self._scene = scene
        self._shading = shading_for(display_list, shading)
        self._shifts = {"x_shift": x_shift, "y_shift": y_shift}
        needs = scene_needs(display_list, **self._shifts)
        self.extent, self.exact_fraction_bits = needs.extent, needs.exact_fraction_bits
        self.exact = self._exact(display_list)
        self._ideal = unquantised.draw(self._on_screen(scene))

    def sweep(self) -> list[int]:
        """Fraction bits worth a look: every other one from 0, the fewest that hold depths to one
        LSB, and the fewest that are exact, which is the last."""
        within_one = min(fixed_point.error_fraction_bits(self.extent, 1), self.exact_fraction_bits)
        return sorted({*range(0, self.exact_fraction_bits, 2), within_one,
                       self.exact_fraction_bits})

    def bound(self, fraction_bits: int) -> int:
        """See ``FractionBitsPoint``."""
        if fraction_bits >= self.exact_fraction_bits:
            return 0
        return ceil(fixed_point.error_bound(fraction_bits, self.extent))

    def at_fraction_bits(self, fraction_bits: int) -> FractionBitsPoint:
        picture = bit_true.draw(self.display_list, fraction_bits=fraction_bits,
                                shading=self._shading, **self._shifts)
        return FractionBitsPoint(fraction_bits, self.bound(fraction_bits), self._error(picture),
                                 self._end_to_end(picture, self.display_list.depth_limit))

    def at_format(self, sub_bits: int, depth_bits: int) -> FormatPoint:
        """The scene quantised anew.  ``InputError`` for formats out of range."""
        display_list = self._scene.display_list(sub_bits, depth_bits)
        return FormatPoint(
            sub_bits, depth_bits,
            exact_fraction_bits=scene_needs(display_list, **self._shifts).exact_fraction_bits,
            end_to_end=self._end_to_end(self._exact(display_list), display_list.depth_limit),
        )  # fmt: skip

    def in_float32(self) -> Float32Point:
        as_stored = UnquantisedScene.of_display_list(self.display_list)
        depth_bits, limit = self.display_list.depth_bits, self.display_list.depth_limit
        return Float32Point(
            error=self._error(float32_depth_buffer.draw(self._on_screen(as_stored), depth_bits)),
            end_to_end=self._end_to_end(
                float32_depth_buffer.draw(self._on_screen(self._scene), depth_bits), limit),
        )

    def _exact(self, display_list: DisplayList) -> Picture:
        return exact.draw(display_list, shading=self._shading, **self._shifts)

    def _on_screen(self, scene: UnquantisedScene) -> ScreenTriangles:
        triangles = scene.on_screen(**self._shifts)
        if self._shading == "gouraud":
            return triangles
        # The machines take the first vertex's colour.
        return replace(triangles, color=np.repeat(triangles.color[:, :1], 3, axis=1))

    def _error(self, picture: Picture) -> PictureError:
        return picture_error(picture, self.exact.winner, self.exact.depth, self.exact.color)

    def _end_to_end(self, picture: Picture, depth_limit: int) -> PictureError:
        return picture_error(picture, self._ideal.winner, self._ideal.depth * depth_limit,
                             self._ideal.color)


def formats(sub_bits: int, depth_bits: int) -> list[tuple[int, int]]:
    """Formats worth a look beside a picture's own: each of ``SUB_BITS`` with its depth bits, each
    of ``DEPTH_BITS`` with its sub-pixel bits."""
    return sorted({*((bits, depth_bits) for bits in SUB_BITS),
                   *((sub_bits, bits) for bits in DEPTH_BITS), (sub_bits, depth_bits)})  # fmt: skip
