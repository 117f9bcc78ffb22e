"""How a triangle is coloured."""

from __future__ import annotations

from typing import Literal

from .display_list import DisplayList
from .errors import InputError

#: "flat" takes the colour of a triangle's first vertex, "gouraud" interpolates.
Shading = Literal["flat", "gouraud"]


def shading_for(display_list: DisplayList, shading: Shading | None = None) -> Shading:
    """``shading`` itself, or by default the cheapest that draws the list as meant.

    ``InputError`` for any other word.
    """
    if shading is None:
        return "flat" if display_list.flat else "gouraud"
    if shading not in ("flat", "gouraud"):
        raise InputError(f"shading: {shading!r} is neither 'flat' nor 'gouraud'")
    return shading
