"""Cycles of cases as a picture: against the depth of the FIFOs, or the blocks of the interlace."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from matplotlib.figure import Figure
from matplotlib.ticker import FixedLocator, NullLocator, StrMethodFormatter

from .machines import varied
from .speed_rows import BenchRow

#: What the axis says; the first that varies is taken.
_AXES = {
    "fifo": "triangles that a processing element can hold in waiting",
    "block": "pixels a side that neighbour in one processing element",
    "elements": "processing elements",
}


def bench_chart(rows: Sequence[BenchRow], path: Path) -> None:
    """Write a PNG: how fast each case is, beside the fastest machine of its line.

    Simulated as marks, predicted as lines; the machines differ in something that
    ``machines.varied`` names.
    """
    def value(row: BenchRow, name: str) -> int:
        return int(getattr(row.machine, name))

    axis, *rest = varied([row.machine for row in rows])
    lines: dict[tuple[str, ...], list[BenchRow]] = {}
    for row in rows:
        others = [f"{value(row, name)} {name}" for name in rest]
        others += ["lines in turn"] * row.machine.lines
        cards = f"{row.machine.units} units, {row.machine.ports} ports, {row.machine.setup}"
        lines.setdefault((row.case, row.order, cards, *others), []).append(row)
    figure = Figure(figsize=(9.0, 5.5), layout="constrained")
    axes = figure.subplots()
    for number, (names, some) in enumerate(lines.items()):
        along = [value(row, axis) for row in some]
        color = f"C{number % 10}"
        fastest = min(row.cycles for row in some)
        axes.plot(along, [100 * fastest / row.predicted for row in some], color=color,
                  linewidth=1.2, label=", ".join(names))
        measured = [row for row in some if row.measured is not None]
        axes.plot([value(row, axis) for row in measured],
                  [100 * fastest / row.cycles for row in measured], "o", color=color)
    axes.set_xscale("log", base=2)
    axes.xaxis.set_major_locator(FixedLocator(sorted({value(row, axis) for row in rows})))
    axes.xaxis.set_minor_locator(NullLocator())
    axes.xaxis.set_major_formatter(StrMethodFormatter("{x:g}"))
    axes.set_xlabel(_AXES[axis])
    axes.set_ylabel("speed, % of the fastest machine of the line")
    axes.set_ylim(0, 110)
    axes.grid(alpha=0.3)
    axes.legend(fontsize=8)
    axes.set_title("marks: simulated; lines: cycle model", fontsize=10)
    figure.savefig(path, format="png", dpi=120)
