"""Table 1 of Cox and Hanrahan (1993), as it is printed, and what of it does not multiply out."""

from __future__ import annotations

import json
from dataclasses import dataclass
from functools import cache
from importlib import resources

#: A figure is printed with two digits after the point: rounded, or cut off.
LAST_DIGIT = 0.01


@dataclass(frozen=True)
class PaperRow:
    """A scene that the authors traced.

    ``given``      primitives before clipping; None where it was not known
    ``triangles``  primitives after clipping
    ``mean_size``  pixels of a primitive
    ``fragments``  pixels of all of them
    ``area``       pixels of the screen
    ``depth``      average depth: ``fragments`` over ``area``
    ``reduction``  by how much snooping reduced its traffic (section 7.2), where they say so
    """

    name: str
    given: int | None
    triangles: int
    mean_size: float
    fragments: int
    area: int
    depth: float
    reduction: float | None

    @property
    def found_size(self) -> float:
        """The mean size by the counts."""
        return self.fragments / self.triangles

    @property
    def found_depth(self) -> float:
        """The average depth by the counts."""
        return self.fragments / self.area

    @property
    def contradictions(self) -> list[str]:
        """A line each: what the table prints that its own counts do not give."""
        lines = []
        if abs(self.mean_size - self.found_size) > LAST_DIGIT:
            lines.append(
                f"{self.name}: {self.triangles:,} primitives of {self.mean_size:,.2f} pixels are "
                f"{self.triangles * self.mean_size:,.0f}, not {self.fragments:,}: the mean is "
                f"{self.found_size:,.2f}, {_times(self.found_size, self.mean_size)}")
        if abs(self.depth - self.found_depth) > LAST_DIGIT:
            lines.append(
                f"{self.name}: {self.fragments:,} pixels on a screen of {self.area:,} are a depth "
                f"of {self.found_depth:.2f}, not {self.depth:.2f}")
        return lines


def _times(found: float, printed: float) -> str:
    larger, ratio = ("more", found / printed) if found > printed else ("less", printed / found)
    return f"{ratio:.1f} times {larger} than printed"


@cache
def paper_rows() -> tuple[PaperRow, ...]:
    """In the order of the table."""
    path = resources.files("cardcage.testbenches") / "data" / "cox_hanrahan_table_1.json"
    rows = json.loads(path.read_text(encoding="utf-8"))["rows"]
    return tuple(PaperRow(**row) for row in rows)


def contradictions() -> list[str]:
    """Of all rows."""
    return [line for row in paper_rows() for line in row.contradictions]
