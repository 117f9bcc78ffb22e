"""Mutants that no test can kill, because they do what the right program does."""

from __future__ import annotations

from typing import NamedTuple


class Equivalent(NamedTuple):
    """A file, the text of a line in it, what is changed to what there, and why that is the same."""

    file: str
    text: str
    change: str
    why: str


EQUIVALENT: tuple[Equivalent, ...] = ()
