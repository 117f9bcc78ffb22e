"""One hard case: a display list, what goes wrong on it, and what is right."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from ..specification.display_list import DisplayList
from ..specification.picture import Picture

#: Anything that draws a display list at its own size: a model, or a machine.
Draw = Callable[[DisplayList], Picture]


@dataclass(frozen=True)
class Expectation:
    """Something known of a case's picture without drawing it.

    ``says``   one line: what is expected
    ``judge``  draws the list, or lists derived from it, and gives a complaint of
               one line; None where there is nothing to complain of
    """

    says: str
    judge: Callable[[DisplayList, Draw], str | None]


@dataclass(frozen=True)
class HardCase:
    """A display list of fixed size, and expectations derived independently of any model.

    ``name``          kebab-case, as in ``hard:NAME``
    ``mistake``       one sentence: what a naive implementation does wrong
    ``make``          makes the display list, always the same
    ``expectations``  by hand, or by an invariant; besides ``rational``, which knows every pixel
    ``sample``        ``rational`` looks at every ``sample``-th pixel in raster order; more than 1
                      only where the picture is too large for fractions
    """

    name: str
    mistake: str
    make: Callable[[], DisplayList]
    expectations: tuple[Expectation, ...]
    sample: int = 1
