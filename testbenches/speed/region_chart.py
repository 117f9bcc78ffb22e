"""Where regions that are dealt out are faster than interlaced pixels, and where they are slower."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from matplotlib.figure import Figure
from matplotlib.ticker import FixedLocator, FuncFormatter, NullLocator

from .cases import MESH
from .machines import BenchMachine
from .speed_rows import BenchRow

#: What machines have in common that are compared.
_Common = tuple[int, int, int, str, int]

#: What the axis says.
_FACTORS = (0.25, 0.5, 0.7, 1.0, 1.4, 2.0, 4.0)


def region_chart(rows: Sequence[BenchRow], path: Path) -> None:
    """Write a PNG: a group of bars for each case and order, a bar for each machine with regions: how
    many times as fast it is as one that interlaces pixels and is like it otherwise.

    Simulated bars are full, predicted ones hatched.
    """
    interlaced = {(row.case, row.order, _common(row.machine)): row.cycles for row in rows
                  if row.machine.regions is None and row.machine.block == 1}
    factors: dict[str, dict[str, tuple[float, bool]]] = {}
    for row in rows:
        before = interlaced.get((row.case, row.order, _common(row.machine)))
        if row.machine.regions is not None and before is not None:
            factors.setdefault(_case(row), {})[row.machine.label] = (
                before / row.cycles, row.measured is not None)
    labels = list(dict.fromkeys(label for some in factors.values() for label in some))
    figure = Figure(figsize=(9.0, 1.6 + 0.16 * len(factors) * (len(labels) + 1)),
                    layout="constrained")
    axes = figure.subplots()
    for number, label in enumerate(labels):
        for place, some in enumerate(factors.values()):
            if label not in some:
                continue
            factor, simulated = some[label]
            axes.barh(place + (number + 0.5) / (len(labels) + 1) - 0.5, factor - 1, left=1,
                      height=0.9 / (len(labels) + 1), color=f"C{number % 10}",
                      hatch=None if simulated else "////", edgecolor="white", linewidth=0)
        axes.barh([0], [0], color=f"C{number % 10}", label=label)
    axes.axvline(1, color="black", linewidth=1)
    axes.set_xscale("log")
    axes.set_xlim(_FACTORS[0], _FACTORS[-1])
    axes.xaxis.set_major_locator(FixedLocator(_FACTORS))
    axes.xaxis.set_minor_locator(NullLocator())
    axes.xaxis.set_major_formatter(FuncFormatter(lambda factor, _: f"{factor:g}"))
    axes.set_yticks([place - 0.5 / (len(labels) + 1) for place in range(len(factors))],
                    list(factors))
    axes.invert_yaxis()
    axes.set_xlabel("interlaced pixels are faster   \N{LEFTWARDS ARROW}   how many times as fast"
                    "   \N{RIGHTWARDS ARROW}   regions are faster")
    axes.grid(axis="x", alpha=0.3)
    axes.legend(fontsize=8, loc="upper center", bbox_to_anchor=(0.5, -0.1 - 0.6 / len(factors)))
    axes.set_title("full: simulated; hatched: cycle model", fontsize=10)
    figure.savefig(path, format="png", dpi=120)


def _common(machine: BenchMachine) -> _Common:
    return machine.elements, machine.units, machine.ports, machine.setup, machine.fifo


def _case(row: BenchRow) -> str:
    """Only a mesh has an order of its own; the peers' triangles lie anywhere."""
    if not row.case.startswith(MESH):
        return f"{row.case}, {row.order} depths" if row.order == "random" else row.case
    return f"{row.case}, shuffled" if row.order == "random" else f"{row.case}, in list order"
