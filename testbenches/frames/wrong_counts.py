"""Counts of a machine that are not as the golden model has them, whatever they count."""

from __future__ import annotations

from typing import Protocol


class Counted(Protocol):
    """Figures of a machine beside the golden model's."""

    @property
    def differences(self) -> list[str]:
        """A line for each count that is not golden's."""


def wrong_counts(*figures: Counted | None) -> list[str]:
    """The differences of all figures that there are."""
    return [line for each in figures if each is not None for line in each.differences]
