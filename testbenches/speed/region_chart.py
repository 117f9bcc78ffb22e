"""Where regions that are dealt out are faster than interlaced pixels, and where they are slower."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from matplotlib.figure import Figure
from matplotlib.ticker import FixedLocator, FuncFormatter, NullLocator

from .cases import MESH
from .machines import BenchMachine
from .speed_rows import BenchRow

#: What the axis says, as far as the bars reach.
_TICKS = (0.125, 0.25, 0.5, 0.7, 1.0, 1.4, 2.0, 4.0, 8.0)

#: Of a group of bars, that belong to one case.
_GROUP = 0.8


def region_chart(rows: Sequence[BenchRow], path: Path) -> None:
    """Write a PNG: of each case and order a bar for each machine with regions, how many times as
    fast it is as the one that interlaces pixels and is like it otherwise.

    Simulated bars are full, predicted ones hatched.
    """
    interlaced = {(row.case, row.order, _alike(row.machine)): row.cycles for row in rows
                  if row.machine.regions is None and row.machine.block == 1
                  and not row.machine.lines}
    factors: dict[str, dict[str, tuple[float, bool]]] = {}
    for row in rows:
        before = interlaced.get((row.case, row.order, _alike(row.machine)))
        if row.machine.regions is not None and before is not None:
            factors.setdefault(_case(row), {})[row.machine.label] = (
                before / row.cycles, row.measured is not None)
    labels = list(dict.fromkeys(label for some in factors.values() for label in some))
    figure = Figure(figsize=(9.0, 2.0 + 0.2 * len(factors) * (len(labels) + 0.5)),
                    layout="constrained")
    axes = figure.subplots()
    height = _GROUP / len(labels)
    for number, label in enumerate(labels):
        color = f"C{number % 10}"
        axes.barh([0], [0], color=color, label=label)  # for the legend
        for group, some in enumerate(factors.values()):
            if label not in some:
                continue
            factor, simulated = some[label]
            place = group + (number + 0.5) * height - _GROUP / 2
            axes.barh(place, factor - 1, left=1, height=0.9 * height, color=color,
                      hatch=None if simulated else "////", edgecolor="white", linewidth=0)
            axes.annotate(f"{factor:.2f}", (factor, place), fontsize=7, va="center",
                          ha="left" if factor >= 1 else "right",
                          xytext=(3 if factor >= 1 else -3, 0), textcoords="offset points")
    axes.axvline(1, color="black", linewidth=1)
    axes.set_xscale("log")
    reached = [factor for some in factors.values() for factor, _ in some.values()] + [0.9, 1.1]
    axes.set_xlim(0.8 * min(reached), 1.25 * max(reached))
    axes.xaxis.set_major_locator(FixedLocator(_TICKS))
    axes.xaxis.set_minor_locator(NullLocator())
    axes.xaxis.set_major_formatter(FuncFormatter(lambda factor, _: f"{factor:g}"))
    axes.set_yticks(range(len(factors)), list(factors))
    axes.invert_yaxis()
    axes.set_xlabel("interlaced pixels are faster   \N{LEFTWARDS ARROW}   how many times as fast"
                    "   \N{RIGHTWARDS ARROW}   regions are faster")
    axes.grid(axis="x", alpha=0.3)
    figure.legend(fontsize=8, loc="outside lower center")
    axes.set_title("full: simulated; hatched: cycle model", fontsize=10)
    figure.savefig(path, format="png", dpi=120)


def _alike(machine: BenchMachine) -> tuple[int, int, int, str, int]:
    """What machines have in common that are compared."""
    return machine.elements, machine.units, machine.ports, machine.setup, machine.fifo


def _case(row: BenchRow) -> str:
    """Only a mesh has an order that can be shuffled; the peers' triangles lie anywhere, and their
    depths matter to one-port units alone."""
    if row.case.split()[0] == MESH:
        return f"{row.case}, shuffled" if row.order == "random" else f"{row.case}, in list order"
    hidden = row.order == "random" and row.machine.ports == 1
    return f"{row.case}, random depths" if hidden else row.case
