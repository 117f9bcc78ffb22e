"""Whether a paper's claim comes out, of one scene and of all that it is about."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass


@dataclass(frozen=True)
class Verdict:
    """A claim and one scene: whether it came out, and the numbers, in words."""

    claim: str
    scene: str
    came_out: bool
    numbers: str

    @property
    def outcome(self) -> str:
        return "Came out" if self.came_out else "Did not"

    def __str__(self) -> str:
        return f"{self.claim}  {self.outcome}: {self.numbers}."


@dataclass(frozen=True)
class Summary:
    """A claim and all scenes that it is about: on how many it came out, and on which it did not."""

    claim: str
    scenes: int
    failed: Sequence[str]

    @property
    def came_out(self) -> bool:
        return not self.failed

    @property
    def outcome(self) -> str:
        if self.came_out:
            return "Came out"
        return "In part" if len(self.failed) < self.scenes else "Did not"

    @property
    def numbers(self) -> str:
        if self.came_out and self.scenes == 1:
            return "on the one scene that it is about"
        return f"on {self.scenes - len(self.failed)} of {self.scenes} scenes" + (
            f"; not on {', '.join(self.failed)}" if self.failed else "")

    def __str__(self) -> str:
        return f"{self.claim}  {self.outcome}: {self.numbers}."


def together(verdicts: Iterable[Verdict]) -> list[Summary]:
    """Each claim once, of all scenes that it is about."""
    of_claim: dict[str, list[Verdict]] = {}
    for verdict in verdicts:
        of_claim.setdefault(verdict.claim, []).append(verdict)
    return [Summary(claim, len(found), [verdict.scene for verdict in found
                                        if not verdict.came_out])
            for claim, found in of_claim.items()]
