"""The pixel grid of a machine: where it samples a display list."""

from __future__ import annotations

from dataclasses import dataclass

from .display_list import DisplayList
from .errors import InputError

#: The widest list is 4096 pixels: more halvings leave one pixel anyway.
MAX_SHIFT = 12


@dataclass(frozen=True)
class Grid:
    """The resolution at which a machine draws, and its pixel in sub-pixel units.

    A machine whose memory holds less than the display list's width x height
    keeps only every ``2**x_shift``-th column and ``2**y_shift``-th row; y halves
    first.  Pixel (i, j) is sampled at ``((i + 1/2) * unit_x, (j + 1/2) * unit_y)``,
    whole numbers since both units are even.
    """

    width: int
    height: int
    unit_x: int
    unit_y: int
    x_shift: int
    y_shift: int

    @classmethod
    def of(cls, display_list: DisplayList, x_shift: int = 0, y_shift: int = 0) -> Grid:
        """The grid for ``display_list``; ``InputError`` unless y halves first."""
        if not 0 <= x_shift <= y_shift <= min(x_shift + 1, MAX_SHIFT):
            raise InputError(
                f"resolution: shifts x {x_shift}, y {y_shift}: "
                f"needs 0 <= x <= y <= x + 1 and y <= {MAX_SHIFT}"
            )
        return cls(
            width=-(-display_list.width >> x_shift),
            height=-(-display_list.height >> y_shift),
            unit_x=1 << (display_list.sub_bits + x_shift),
            unit_y=1 << (display_list.sub_bits + y_shift),
            x_shift=x_shift,
            y_shift=y_shift,
        )

    @property
    def extent(self) -> int:
        """The largest x + y, in pixels, between two corners of the screen."""
        return self.width + self.height - 2
