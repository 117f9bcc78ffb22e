"""A line of a plan."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class PlanLine:
    """One number of the machine.

    ``item``    what it is
    ``value``   in the planned machine
    ``full``    in the machine for every triangle on a screen of that size
    ``reason``  what of the scene decides it
    ``saves``   bits of each triangle broadcast that this alone saves; negative where the
                scene needs more, None where it does not touch them
    """

    item: str
    value: str
    full: str
    reason: str
    saves: int | None = None
