"""What ``cardcage bench`` says: for people, and for programs."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import groupby
from typing import Any

from rich.console import Console
from rich.table import Table

from ...golden.organisations.organisation_of import organisation_of
from ..engines.activity_record import ACTIVITY_KINDS
from ..reports.region_facts import region_summary
from .cases import MESH, Order, peers
from .speed_rows import QUEUE, BenchRow

TITLES: dict[Order, str] = {
    "visible": "every fragment visible",
    "random": "depths shuffled, the list as it is",
}
#: Of a mesh, whose depths are its own.
MESH_TITLES: dict[Order, str] = {
    "visible": "mesh in list order",
    "random": "mesh in shuffled order",
}

_COLUMNS = ("case", "triangles", "clocks a triangle", "of bound", "bound by")
_MEASURED_COLUMNS = ("model", "clocks a fragment", "fragments a clock", "busy", "latency")


def bench_text(rows: Sequence[BenchRow]) -> str:
    """Plain lines, the columns aligned, a table for each machine and order."""
    lines = []
    for title, cells in _tables(rows):
        widths = [max(len(row[column]) for row in cells) for column in range(len(cells[0]))]
        lines += [title, *("  ".join(
            [row[0].ljust(widths[0]), *map(str.rjust, row[1:], widths[1:])]) for row in cells), ""]
    return "\n".join([*lines, *_notes(rows)])


def bench_table(rows: Sequence[BenchRow]) -> None:
    """The same as tables on the terminal."""
    console = Console()
    for title, (header, *cells) in _tables(rows):
        table = Table(box=None, pad_edge=False, padding=(0, 2, 0, 0), title=title,
                      title_justify="left", title_style="bold")
        for place, column in enumerate(header):
            table.add_column(column, justify="left" if place == 0 else "right")
        for row in cells:
            table.add_row(*row)
        console.print(table)
        console.print()
    for line in _notes(rows):
        console.print(line, highlight=False, soft_wrap=True)


def _tables(rows: Sequence[BenchRow]) -> list[tuple[str, list[tuple[str, ...]]]]:
    """Title and cells, the header first, of two tables for each machine and order."""
    tables = []
    for (label, _), group in groupby(rows, lambda row: (row.machine.label, row.order)):
        some = list(group)
        orders = dict.fromkeys((MESH_TITLES if row.case.split()[0] == MESH else TITLES)[row.order]
                               for row in some)
        tables.append(("; ".join([label, *orders]), [_header(some[0]), *map(_cells, some)]))
        observed = [(row.case, row.measured.activity.shares()) for row in some
                    if row.measured is not None and row.measured.activity is not None]
        if observed:
            header = ("case", *(kind.name.replace("_", " ") for kind in ACTIVITY_KINDS))
            tables.append(("  where the processing elements' clocks went, in %", [
                header, *((case, *(f"{100 * share:.1f}" for share in shares.values()))
                          for case, shares in observed)]))
    return tables


def _header(row: BenchRow) -> tuple[str, ...]:
    return (*_COLUMNS, *(() if row.region_utilisation is None else ("regions",)),
            *(() if row.measured is None else _MEASURED_COLUMNS),
            *(peer.short for peer in peers()))


def _cells(row: BenchRow) -> tuple[str, ...]:
    cells = [row.case, f"{row.triangles:,}", f"{row.cycles / row.triangles:,.2f}",
             f"{100 * row.bound / row.cycles:.0f} %", row.binding]
    if row.region_utilisation is not None:
        cells.append(f"{100 * row.region_utilisation:.0f} %")
    measured, error = row.measured, row.prediction_error
    if measured is not None and error is not None:
        cells += [
            f"{100 * error:+.1f} %",
            f"{measured.cycles_per_fragment:.3f}",
            f"{measured.fragments_per_clock:.2f}",
            f"{100 * measured.utilisation:.0f} %",
            f"{measured.latency:,}",
        ]
    figures = [peer.cycles_per_triangle.get(row.case) for peer in peers()]
    return (*cells, *("" if figure is None else f"{figure:,}" for figure in figures))


def _notes(rows: Sequence[BenchRow]) -> list[str]:
    without_setup = [peer.short for peer in peers() if "hardware" not in peer.setup]
    without_depth = [peer.short for peer in peers() if not peer.depth_tested]
    of_bound = ("Of bound: how near to what set-up, broadcast, the busiest processing element and "
                "the busiest port allow.")
    said = [
        "Nothing was simulated: clocks are the cycle model's, (T(2n) - T(n)) / n of n triangles.  "
        + of_bound,
    ] if all(row.measured is None for row in rows) else [
        "Every picture was compared with the golden one.  Clocks: (T(2n) - T(n)) / n of n "
        "triangles; latency: T(n) less n of these.",
        f"{of_bound}  Model: how far the cycle model is off.  Busy: fragments per clock and "
        "processing element.",
    ]
    if any(row.binding == QUEUE for row in rows):
        said.append("Bound by the queue: with more triangles waiting (--fifo) it would be faster, "
                    "as the model says.")
    if any(row.region_utilisation is not None for row in rows):
        said.append("Regions: how evenly they are dealt out: the mean element's counts as a part "
                    "of the busiest one's.")
    predicted = sum(row.prediction_seconds for row in rows)
    simulated = sum(row.measured.seconds for row in rows if row.measured is not None)
    said.append(f"The cycle model took {predicted:.2f} s" + (
        f", the simulations {simulated:,.1f} s without compiling: {simulated / predicted:,.0f} "
        "times as long." if simulated else "."))
    return [*said, "Peers on the right, in clocks a triangle: without set-up "
            f"{' and '.join(without_setup)}, without a depth test {' and '.join(without_depth)}."]


def bench_facts(rows: Sequence[BenchRow]) -> list[dict[str, Any]]:
    """The same as plain numbers and words, one object a row."""
    return [_facts(row) for row in rows]


def _facts(row: BenchRow) -> dict[str, Any]:
    machine, measured = row.machine, row.measured
    facts: dict[str, Any] = {
        "key": row.key,
        "machine": {"label": machine.label, "cards": machine.configuration.cards,
                    "processing_elements": machine.elements, "units_each": machine.units,
                    "memory_ports": machine.ports, "setup": machine.setup, "block": machine.block,
                    "skew": machine.skew, "lines": machine.lines,
                    "fifo_depth": machine.fifo,
                    "regions": machine.regions,
                    "balance": machine.configuration.balance if machine.regions else None,
                    "scan_reads_per_line":
                        organisation_of(machine.configuration).scan_reads_per_line,
                    "fraction_bits": machine.configuration.fraction_bits},
        "case": row.case,
        "order": row.order,
        "triangles": row.triangles,
        "predicted_cycles": row.predicted,
        "prediction_seconds": row.prediction_seconds,
        "bound": {"cycles": row.bound, "binding": row.binding,
                  "share": row.bound / row.cycles},
        "region_utilisation": row.region_utilisation,
        "peers": {peer.name: peer.cycles_per_triangle[row.case] for peer in peers()
                  if row.case in peer.cycles_per_triangle},
    }
    if measured is not None:
        facts |= {
            "fragments": measured.fragments,
            "cycles": {"once": measured.cycles_once, "twice": measured.cycles_twice,
                       "sustained": measured.sustained_cycles},
            "cycles_per_triangle": measured.cycles_per_triangle,
            "cycles_per_fragment": measured.cycles_per_fragment,
            "fragments_per_clock": measured.fragments_per_clock,
            "utilisation": measured.utilisation,
            "latency": measured.latency,
            "simulation_seconds": measured.seconds,
            "element_fragments": list(measured.element_fragments),
            "prediction_error": row.prediction_error,
        }
        if measured.regions is not None:
            facts["regions"] = region_summary(measured.regions)
        if measured.activity is not None:
            facts["clocks_of_elements"] = measured.activity.shares()
    return facts
