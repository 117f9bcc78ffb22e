"""The tables of the page, for a terminal and for the page itself."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import fields

from ...support.text_table import TextTable
from .blazek import Blazek
from .claims import MOST, Methods, summary
from .findings import findings
from .his_machine.costs import COSTS, MICROSECOND, REASONS
from .his_machine.his_claims import his_summary
from .his_machine.sensitivity import SHOWN, Sensitivity, axis_of
from .our_machine.clocks import Clocks
from .our_machine.in_rtl import Point
from .scenes.speed_ups import SpeedUps
from .scenes.spheres import NODES

#: Spheres of the tables.
SHOWN_SPHERES = (1, 16, 256, 2048)


def headline(found: Blazek) -> list[str]:
    """What machines did otherwise, then each claim of the thesis, and what was found beyond it."""
    return [*(f"DIFFERENT: {line}" for line in found.differences),
            *(f"His machine: {claim}" for claim in summary(Methods(found.times))),
            *(f"His machine: {claim}" for claim in his_summary(found.times, found.size)),
            *(f"Ours: {claim}" for claim in summary(Methods(found.clocks))),
            *findings(found.sensitivity, found.clocks, found.points, found.size)]


def tables(found: Blazek) -> list[TextTable]:
    """All that there are figures for."""
    made = [speed_up_table("his machine, an event model: speed-up, seconds", found.times),
            *(sensitivity_table(each) for each in found.sensitivity),
            speed_up_table("ours, by the cycle model: speed-up, clocks", found.clocks)]
    made.append(link_table(found.clocks))
    if found.points:
        made.append(point_table(found.points))
    return made


def speed_up_table(title: str, methods: Mapping[str, SpeedUps]) -> TextTable:
    """Rows: a method and a number of spheres."""
    return TextTable(
        f"{title} on one node and on {MOST}",
        ("method, spheres", *(f"on {nodes}" for nodes in NODES), "one node", f"{MOST} nodes",
         "of it merging"),
        tuple((f"{name}, {spheres:,}", *(f"{speed:.2f}" for speed in method.curve(spheres)),
               _amount(method.time(spheres, 1)), _amount(method.time(spheres, MOST)),
               f"{100 * method.merging(spheres, MOST) / method.time(spheres, MOST):.0f} %")
              for name, method in methods.items() for spheres in SHOWN_SPHERES))


def _amount(value: float) -> str:
    return f"{value:,.1f}" if value < 10_000 else f"{value:,.0f}"


def sensitivity_table(found: Sensitivity) -> TextTable:
    axis = axis_of(found.axis)
    return TextTable(
        f"his machine, speed-up on {MOST} nodes by {axis.name} ({axis.unit}, usually "
        f"{axis.usual:g})",
        ("method", *(f"{value:g}" for value in axis.values)),
        tuple((method, *(f"{speed:.1f}" for speed in found.speed_up[method])) for method in SHOWN))


def link_table(clocks: Mapping[str, Clocks]) -> TextTable:
    return TextTable(
        f"ours: words of 32 bits on the host link for a frame on {MOST} nodes, the mesh loaded "
        "anew, by spheres", ("decomposition", *(f"{spheres:,}" for spheres in SHOWN_SPHERES)),
        tuple((name, *(f"{found.words(spheres, MOST):,}" for spheres in SHOWN_SPHERES))
              for name, found in clocks.items()))


def costs_with_reasons() -> list[tuple[str, str, str]]:
    """What things cost on his machine, and why."""
    def cost(name: str) -> str:
        value = getattr(COSTS, name)
        return f"{value}" if isinstance(value, int) else f"{value / MICROSECOND:g} µs"

    return [(field.name.replace("_", " "), cost(field.name), REASONS[field.name])
            for field in fields(COSTS)]


def point_table(points: Sequence[Point]) -> TextTable:
    return TextTable(
        "ours, simulated: clocks of a frame",
        ("decomposition", "nodes", "spheres", "drawing", "by the model", "merging", "by the model",
         "model off by", "picture"),
        tuple((point.decomposition, f"{point.nodes}", f"{point.spheres}", f"{point.drawing:,}",
               f"{point.model_drawing:,.0f}", f"{point.merging:,}", f"{point.model_merging:,.0f}",
               f"{100 * point.off:+.2f} %", "equal" if point.equal else "differs")
              for point in points))

