"""Figures 12 to 19, for his machine and for ours, and how they depend on what things cost."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from matplotlib import colormaps
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import FixedLocator, NullLocator, PercentFormatter, StrMethodFormatter

from ...reports.page import chart_style, svg_element
from .his_machine.sensitivity import AXES, SHOWN, Sensitivity, axis_of
from .his_machine.times import Times
from .our_machine.in_rtl import Point
from .scenes.speed_ups import SpeedUps
from .scenes.spheres import NODES, SPHERES

POINT_COLOR = "#c0392b"
IDEAL_COLOR = "#888888"

#: One of each method of the sensitivity.
COLORS = dict(zip(SHOWN, ("#b0643c", "#2a9d6f", "#3b82c4", "#8a5fb0", "#d98a2b", "#7a7a7a"),
                  strict=True))

#: Of the picture: his figures 12, 14, 16 and 18, and the same of ours.
PICTURED = ("host initiated, 100", "node initiated", "forwarding, strips", "broadcast, lines")

#: Spheres whose scenes are shown one by one.
SEEDS_SPHERES = 64


def speed_up_chart(methods: Mapping[str, SpeedUps], points: Sequence[Point] = ()) -> str:
    """An ``<svg>`` element: speed-up and, below it, efficiency against nodes, a curve for each
    number of spheres; ``points`` were measured in RTL."""
    with _chart((3.6 * len(methods) + 1.2, 5.6)) as figure:
        panels = figure.subplots(2, len(methods), squeeze=False, sharex=True)
        for (name, method), (upper, lower) in zip(methods.items(), panels.T, strict=True):
            _speed_ups(upper, name, method, points)
            _efficiencies(lower, method, points)
        panels[0, 0].set_ylabel("speed-up")
        panels[1, 0].set_ylabel("efficiency")
        _legend(figure, panels[0, 0])
        return svg_element(figure, f"Speed-up and efficiency against nodes: {', '.join(methods)}")


def seeds_chart(methods: Sequence[Times]) -> str:
    """An ``<svg>`` element: speed-up of scenes of one number of spheres, each at other places."""
    with _chart((3.6 * len(methods), 3.2)) as figure:
        for axes, method in zip(figure.subplots(1, len(methods), sharey=True), methods,
                                strict=True):
            for curve in method.curves_of_seeds(SEEDS_SPHERES):
                axes.plot(NODES, curve, color="#3b82c4", linewidth=0.9, alpha=0.6)
            axes.plot(NODES, method.curve(SEEDS_SPHERES), color=POINT_COLOR, linewidth=1.8)
            axes.set_title(f"{method.name}, {SEEDS_SPHERES} spheres", fontsize=10)
            _nodes_axis(axes)
        return svg_element(figure, "Speed-up against nodes, a curve for each scene, and their mean")


def sensitivity_chart(sensitivity: Sequence[Sensitivity]) -> str:
    """An ``<svg>`` element: speed-up on the most nodes against what is varied, a panel each."""
    with _chart((13.0, 6.6)) as figure:
        panels = figure.subplots(2, -(-len(AXES) // 2), sharey=True).flat
        _sensitivity_panels(panels, sensitivity)
        for axes in panels[len(AXES):]:
            axes.set_visible(False)
        figure.legend(*panels[0].get_legend_handles_labels(), loc="outside lower center",
                      frameon=False, fontsize=9, ncols=len(SHOWN))
        return svg_element(figure, "Speed-up on the most nodes against each cost")


def save_figures(his: Mapping[str, SpeedUps], ours: Mapping[str, SpeedUps],
                 points: Sequence[Point], sensitivity: Sequence[Sensitivity], path: Path) -> None:
    """Speed-up on both machines, and the sensitivity of his, for a page that shows pictures
    only."""
    figure = Figure(figsize=(13.0, 9.4), layout="constrained")
    rows = figure.subplots(3, len(PICTURED), squeeze=False)
    for row, machine, methods in zip(rows, ("his", "ours"), (his, ours), strict=False):
        for axes, name in zip(row, PICTURED, strict=True):
            _speed_ups(axes, f"{machine}: {name}", methods[name],
                       points if machine == "ours" else ())
        row[0].set_ylabel("speed-up")
    _sensitivity_panels(rows[2], sensitivity)
    rows[2, 0].legend(frameon=False, fontsize=7)
    _legend(figure, rows[0, 0])
    figure.savefig(path, dpi=100, metadata={"Software": None})


@contextmanager
def _chart(size: tuple[float, float]) -> Iterator[Figure]:
    with chart_style():
        yield Figure(figsize=size, layout="constrained")


def _speed_ups(axes: Axes, title: str, method: SpeedUps, points: Sequence[Point]) -> None:
    axes.plot(NODES, NODES, ":", color=IDEAL_COLOR, linewidth=1.2)
    for spheres in SPHERES:
        axes.plot(NODES, method.curve(spheres), color=_color(spheres), marker="o", markersize=2.5,
                  linewidth=1.3, label=f"{spheres:,}")
    for point in _own(points, method):
        axes.plot([point.nodes], [method.time(point.spheres, 1) / point.clocks], **_MARK)
    axes.set_title(title, fontsize=10)
    axes.set_yscale("log", base=2)
    axes.yaxis.set_major_formatter(StrMethodFormatter("{x:g}"))
    _nodes_axis(axes)


def _efficiencies(axes: Axes, method: SpeedUps, points: Sequence[Point]) -> None:
    for spheres in SPHERES:
        axes.plot(NODES, method.efficiencies(spheres), color=_color(spheres), marker="o",
                  markersize=2.5, linewidth=1.3)
    for point in _own(points, method):
        speed_up = method.time(point.spheres, 1) / point.clocks
        axes.plot([point.nodes], [speed_up / point.nodes], **_MARK)
    axes.set_ylim(0, 1.05)
    axes.yaxis.set_major_formatter(PercentFormatter(1.0))
    _nodes_axis(axes)


#: Of a point that was measured.
_MARK: dict[str, Any] = {"marker": "s", "markersize": 7, "markerfacecolor": "none",
                         "markeredgewidth": 1.6, "color": POINT_COLOR}


def _own(points: Sequence[Point], method: SpeedUps) -> list[Point]:
    return [point for point in points if point.decomposition == method.name]


def _sensitivity_panels(panels: Sequence[Axes], sensitivity: Sequence[Sensitivity]) -> None:
    for axes, found in zip(panels, sensitivity, strict=False):
        axis = axis_of(found.axis)
        for method in SHOWN:
            axes.plot(axis.values, found.speed_up[method], color=COLORS[method], marker="o",
                      markersize=3, linewidth=1.4, label=method)
        axes.axvline(axis.usual, color=IDEAL_COLOR, linestyle=":", linewidth=1.2)
        axes.set_xscale("log")
        axes.set_yscale("log", base=2)
        axes.set_ylim(0.25, 2 * NODES[-1])
        axes.yaxis.set_major_formatter(StrMethodFormatter("{x:g}"))
        axes.set_xlabel(f"{axis.name}, {axis.unit}")
        _plain(axes)
    panels[0].set_ylabel(f"speed-up on {NODES[-1]} nodes")


def _color(spheres: int) -> tuple[float, float, float, float]:
    return colormaps["viridis"](0.92 * SPHERES.index(spheres) / (len(SPHERES) - 1))


def _legend(figure: Figure, axes: Axes) -> None:
    figure.legend(*axes.get_legend_handles_labels(), loc="outside right upper", frameon=False,
                  fontsize=9, title="spheres", title_fontsize=9)


def _nodes_axis(axes: Axes) -> None:
    axes.set_xscale("log", base=2)
    axes.xaxis.set_major_locator(FixedLocator([float(nodes) for nodes in NODES]))
    axes.xaxis.set_minor_locator(NullLocator())
    axes.xaxis.set_major_formatter(StrMethodFormatter("{x:.0f}"))
    axes.set_xlabel("nodes")
    _plain(axes)


def _plain(axes: Axes) -> None:
    axes.grid(alpha=0.25)
    axes.spines[["top", "right"]].set_visible(False)
