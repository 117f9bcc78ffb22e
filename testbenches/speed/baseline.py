"""Earlier figures of ``cardcage bench``, and what became slower since."""

from __future__ import annotations

import json
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from ...golden.specification.errors import InputError
from .speed_rows import BenchRow


@dataclass(frozen=True)
class Change:
    """A row whose sustained cycles are not what they were."""

    key: str
    before: int
    now: int

    @property
    def slower(self) -> bool:
        return self.now > self.before

    def __str__(self) -> str:
        factor = self.now / self.before
        return (f"{self.key}: {self.now:,} cycles, {self.before:,} before "
                f"({100 * (factor - 1):+.1f} %)")


@dataclass(frozen=True)
class BaselineComparison:
    """``same`` rows have the same cycles; ``missing`` ones are not in the baseline."""

    changes: Sequence[Change]
    same: int
    missing: int

    @property
    def slower(self) -> list[Change]:
        return [change for change in self.changes if change.slower]

    def text(self) -> str:
        faster = [change for change in self.changes if not change.slower]
        lines = [f"against the baseline: {len(self.slower)} slower, {len(faster)} faster, "
                 f"{self.same} the same, {self.missing} not in it"]
        lines += [f"  slower  {change}" for change in self.slower]
        lines += [f"  faster  {change}" for change in faster]
        return "\n".join(lines)


#: Sustained cycles by row and number of triangles.
Baseline = dict[tuple[str, int], int]


def load_baseline(path: Path) -> Baseline:
    """What ``--json`` wrote; ``InputError`` for another file."""
    try:
        rows = json.loads(path.read_text(encoding="utf-8"))["rows"]
        return {(str(row["key"]), int(row["triangles"])): int(row["cycles"]["sustained"])
                for row in rows if "cycles" in row}
    except FileNotFoundError:
        raise InputError(f"--against: {path}: no such file; write one with --json") from None
    except (OSError, ValueError, KeyError, TypeError):
        raise InputError(f"--against: {path}: not a file that cardcage bench --json wrote"
                         ) from None


def against(rows: Sequence[BenchRow], baseline: Baseline) -> BaselineComparison:
    """``rows`` beside what they were.  Cycles are exact: any difference is a change."""
    now = {(row.key, row.triangles): row.measured.sustained_cycles
           for row in rows if row.measured is not None}
    known = {key: cycles for key, cycles in now.items() if key in baseline}
    changes = [Change(key[0], baseline[key], cycles) for key, cycles in known.items()
               if cycles != baseline[key]]
    return BaselineComparison(changes, len(known) - len(changes), len(now) - len(known))
