"""The hard cases by name."""

from __future__ import annotations

import difflib
from itertools import chain
from typing import Final

from ..specification.errors import InputError
from . import (
    clipping,
    coordinate_range,
    coverage,
    depth,
    layers,
    sizes,
    slivers,
    snapping,
    whole_lists,
)
from .hard_case import HardCase

#: In the order in which they are shown to a user.
HARD_CASES: Final[dict[str, HardCase]] = {
    case.name: case
    for case in chain(coverage.CASES, slivers.CASES, depth.CASES, coordinate_range.CASES,
                      layers.CASES, clipping.CASES, snapping.CASES, whole_lists.CASES,
                      sizes.CASES)
}


def hard_case(name: str) -> HardCase:
    """The case of that name; ``InputError`` for an unknown one lists those that are close."""
    case = HARD_CASES.get(name)
    if case is not None:
        return case
    near = difflib.get_close_matches(name.lower(), HARD_CASES, n=3, cutoff=0.4)
    hint = f"did you mean {' or '.join(near)}?" if near else "choose another"
    raise InputError(f"hard: no case {name!r}; {hint}  (cardcage scenes --hard lists them)")
