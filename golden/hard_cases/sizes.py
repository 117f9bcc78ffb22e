"""Pictures whose width and height are no power of two."""

from __future__ import annotations

from functools import partial
from typing import Final

from ..specification.display_list import DisplayList
from .expectations import covered_once
from .hard_case import HardCase
from .screen_lists import fan, screen_list


def _fan(width: int, height: int) -> DisplayList:
    """Eight steep triangles over the whole screen; the hub is on a pixel centre, the ring on
    the rim and beyond it."""
    right, bottom = width + 0.25, height + 0.25
    ring = [(-0.25, -0.25), (width // 3, -9.5), (right, -0.25), (width + 11.5, height // 3),
            (right, bottom), (width // 2, height + 7.25), (-0.25, bottom), (-5.75, height // 2)]
    # Any pixel centre would do for the hub.
    return screen_list(fan((width // 2 + 0.5, height // 3 + 0.5), ring), width=width,
                       height=height)


def _case(width: int, height: int, mistake: str, sample: int) -> HardCase:
    return HardCase(
        f"size-{width}x{height}", mistake, partial(_fan, width, height),
        (covered_once(lambda x, y: 1, "the whole screen once"),), sample,
    )


CASES: Final = (
    _case(97, 61, "assumes that a line is a multiple of the interlace, and shears the picture or "
          "writes beyond its last column", 1),
    _case(1000, 333, "keeps a column in too few bits, or steps slopes over a thousand pixels with "
          "too few fraction bits", 31),
    _case(640, 480, "is right on small screens, and drifts or overflows across a standard one",
          31),
)
