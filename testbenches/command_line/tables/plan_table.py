"""A plan for people: a table on a terminal, aligned lines elsewhere."""

from __future__ import annotations

from dataclasses import asdict

from rich.console import Console
from rich.table import Table

from ....golden.organisations.organisation_of import organisation_of
from ....golden.planning.machine_plan import triangle_bits
from ....golden.specification.configuration import MachineConfiguration
from ...support.counted import counted
from .scene_plan import CYCLE_ACCURACY, ScenePlan

_COLUMNS = ("", "plan", "full", "saves", "because")


def plan_text(planned: ScenePlan) -> str:
    """Plain lines, the columns aligned."""
    rows = [_COLUMNS, *_rows(planned)]
    widths = [max(len(row[column]) for row in rows) for column in range(4)]
    lines = ["  ".join([row[0].ljust(widths[0]),
                        *(row[column].rjust(widths[column]) for column in (1, 2, 3)),
                        row[4]]).rstrip() for row in rows]
    return "\n".join([_title(planned), *lines, *_summary(planned)])


def plan_table(planned: ScenePlan) -> None:
    """The same as a table on the terminal."""
    table = Table(box=None, pad_edge=False, padding=(0, 2, 0, 0))
    for place, column in enumerate(_COLUMNS):
        table.add_column(column, style="bold" if place == 0 else None,
                         justify="right" if 0 < place < 4 else "left")
    for row in _rows(planned):
        table.add_row(*row)
    console = Console()
    console.print(_title(planned), highlight=False)
    console.print(table)
    for line in _summary(planned):
        console.print(line, highlight=False, soft_wrap=True)


def _title(planned: ScenePlan) -> str:
    machine, pictures = planned.plan.configuration, planned.pictures
    triangles, one = counted(planned.plan.needs.triangles, "triangle"), ""
    if pictures is not None:
        triangles = f"{counted(len(pictures.cycles), 'picture')} of up to {triangles}"
        one = ", one machine" + (" that is exact for each" if planned.exact else " for each")
    return (f"{planned.scene.name}: {triangles} at {machine.width}x{machine.height}{one}; full is "
            "a machine for every triangle on that screen")


def _rows(planned: ScenePlan) -> list[tuple[str, str, str, str, str]]:
    return [(line.item, line.value, line.full, "" if line.saves is None else f"{line.saves:,}",
             line.reason) for line in planned.plan.lines]


def _accuracy(machine: MachineConfiguration) -> str:
    """How far the estimate of the clocks can be trusted."""
    if machine.regions is not None:
        return ("a rough sum by the first table; where one element's queue is full the others "
                "wait, which takes longer")
    return f"estimated, within {100 * CYCLE_ACCURACY:.0f} % of those simulated in the tests"


def _summary(planned: ScenePlan) -> list[str]:
    plan, machine = planned.plan, planned.plan.configuration
    chosen = (f"chosen for {planned.budget:,}" if planned.budget is not None else
              "as given")
    merges, pictures = organisation_of(machine).merges_after_drawing, planned.pictures
    takes = "to draw, not to merge, takes" if merges else "a frame takes"
    if pictures is not None and len(pictures.cycles) > 1:
        takes = (f"the slowest picture, {pictures.slowest} of 0 to {len(pictures.cycles) - 1}, of "
                 f"{counted(pictures.triangles, 'triangle')}, takes"
                 + (" to draw, not to merge," if merges else ""))
    lines = [
        f"each triangle broadcast: {triangle_bits(machine):,} bits instead of "
        f"{triangle_bits(plan.full):,} (saves counts these, each line by itself)",
        f"cards: {machine.cards}, {chosen}; {takes} about {planned.estimate.total:,} cycles "
        f"({_accuracy(machine)})",
    ]
    if planned.cells is not None:
        needed, full = map(asdict, planned.cells)
        lines.append("cells of a processing element: " + ", ".join(
            f"{needed[name]:,} instead of {full[name]:,} {text}" for name, text in (
                ("flip_flops", "flip-flops"), ("gates", "gates"),
                ("multipliers", "multiplier bits"), ("memory", "bits of FIFO"))))
    return [*lines, f"draw it: {planned.command}"]
