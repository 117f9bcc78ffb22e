"""Cycles of cases as a picture: against the depth of the FIFOs, or the blocks of the interlace."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from matplotlib.figure import Figure
from matplotlib.ticker import FixedLocator, NullLocator, StrMethodFormatter

from ..golden.errors import InputError
from .bench import BenchRow

#: What may run along the axis, and what the axis then says; the first that varies is taken.
_AXES = {
    "fifo": "triangles that a processing element can hold in waiting",
    "block": "pixels a side that neighbour in one processing element",
    "elements": "processing elements",
}


def bench_chart(rows: Sequence[BenchRow], path: Path) -> None:
    """Write a PNG: bound over cycles of each case, simulated as marks and predicted as lines.

    ``InputError`` where no two rows differ in what can run along the axis.
    """
    def value(row: BenchRow, name: str) -> int:
        return int(getattr(row.machine, name))

    varied = [name for name in _AXES if len({value(row, name) for row in rows}) > 1]
    if not varied:
        raise InputError("--plot: nothing to draw along; give --fifo, --block or --elements "
                         "several numbers")
    axis = varied[0]
    lines: dict[tuple[str, ...], list[BenchRow]] = {}
    for row in rows:
        others = [f"{value(row, name)} {name}" for name in varied[1:]]
        cards = f"{row.machine.units} units, {row.machine.ports} ports, {row.machine.setup}"
        lines.setdefault((row.case, row.order, cards, *others), []).append(row)
    figure = Figure(figsize=(9.0, 5.5), layout="constrained")
    axes = figure.subplots()
    for number, (names, some) in enumerate(lines.items()):
        along = [value(row, axis) for row in some]
        color = f"C{number % 10}"
        axes.plot(along, [100 * row.bound / row.predicted for row in some], color=color,
                  linewidth=1.2, label=", ".join(names))
        measured = [row for row in some if row.measured is not None]
        axes.plot([value(row, axis) for row in measured],
                  [100 * row.bound / row.cycles for row in measured], "o", color=color)
    axes.set_xscale("log", base=2)
    axes.xaxis.set_major_locator(FixedLocator(sorted({value(row, axis) for row in rows})))
    axes.xaxis.set_minor_locator(NullLocator())
    axes.xaxis.set_major_formatter(StrMethodFormatter("{x:g}"))
    axes.set_xlabel(_AXES[axis])
    axes.set_ylabel("% of what broadcast and busiest element allow")
    axes.set_ylim(0, 105)
    axes.grid(alpha=0.3)
    axes.legend(fontsize=8)
    axes.set_title("marks: simulated; lines: cycle model", fontsize=10)
    figure.savefig(path, format="png", dpi=120)
