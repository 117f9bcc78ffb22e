"""Figures 5 and 6, a scene each: traffic against processors, and how well the drawing is shared."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import FixedLocator, NullLocator, StrMethodFormatter

from ..reports.page import chart_style, svg_element
from .scene_traffic import CONTIGUOUS, NODES, ROUND_ROBIN, SHUFFLED, SceneTraffic
from .sent_in_rtl import Point

COLORS = {ROUND_ROBIN: "#3b82c4", CONTIGUOUS: "#2a9d6f", SHUFFLED: "#8a5fb0"}
EXPECTED_COLOR = "#d98a2b"
MAXIMUM_COLOR = "#999999"


def traffic_chart(scene: SceneTraffic, points: Sequence[Point] = ()) -> str:
    """An ``<svg>`` element; ``points`` were measured in RTL."""
    with chart_style():
        figure = Figure(figsize=(9.0, 3.3), layout="constrained")
        traffic, share = figure.subplots(1, 2, width_ratios=(3, 2))
        _traffic(traffic, scene, points)
        _share(share, scene)
        figure.legend(*traffic.get_legend_handles_labels(), loc="outside lower center", ncols=4,
                      frameon=False, fontsize=9)
        return svg_element(figure, f"{scene.name}: traffic over the least there can be, and the "
                           "busiest node's part of the drawing, against processors")


def save_traffic_png(scenes: Sequence[SceneTraffic], path: Path) -> None:
    """The traffic of some scenes side by side, for a page that shows pictures only."""
    figure = Figure(figsize=(3.6 * len(scenes), 3.6), layout="constrained")
    panels = figure.subplots(1, len(scenes), squeeze=False)[0]
    for axes, scene in zip(panels, scenes, strict=True):
        _traffic(axes, scene, ())
        axes.set_title(scene.name, fontsize=10)
    figure.legend(*panels[0].get_legend_handles_labels(), loc="outside lower center", ncols=3,
                  frameon=False, fontsize=9)
    figure.savefig(path, dpi=110, metadata={"Software": None})


def _traffic(axes: Axes, scene: SceneTraffic, points: Sequence[Point]) -> None:
    places = range(len(NODES))
    axes.plot(places, [scene.maximum] * len(NODES), color=MAXIMUM_COLOR, linestyle=":",
              label="maximum: every fragment")
    axes.plot(places, [scene.expected] * len(NODES), color=EXPECTED_COLOR, linestyle="--",
              label="expected, equation 4")
    axes.plot(places, scene.expected_among, color=EXPECTED_COLOR, linewidth=6, alpha=0.35,
              label="expected pixel by pixel, among n nodes")  # behind what is observed
    for name, color in COLORS.items():
        curve = scene.curve(name)
        axes.plot(places, [scene.ratio(sent) for sent in curve.sent], color=color, marker="o",
                  markersize=3.5, linewidth=1.6, label=f"observed, {name}")
        if curve.least != curve.most:
            axes.fill_between(places, [scene.ratio(sent) for sent in curve.least],
                              [scene.ratio(sent) for sent in curve.most], color=color, alpha=0.15,
                              linewidth=0)
    for number, point in enumerate(points):
        axes.plot([NODES.index(point.nodes)], [scene.ratio(sum(point.sent))], marker="s",
                  markersize=8, markerfacecolor="none", linestyle="none",
                  color=COLORS[point.assignment], label="measured in RTL" if not number else None)
    _nodes_axis(axes)
    axes.set_ylim(bottom=0.95)
    axes.set_ylabel("traffic over the least")


def _share(axes: Axes, scene: SceneTraffic) -> None:
    places = range(len(NODES))
    axes.plot(places, [1 / nodes for nodes in NODES], color=MAXIMUM_COLOR, linestyle=":")
    for name, color in COLORS.items():
        axes.plot(places, scene.curve(name).busiest, color=color, marker="o", markersize=3.5)
    axes.set_yscale("log", base=2)
    axes.yaxis.set_major_formatter(StrMethodFormatter("{x:.1%}"))
    axes.yaxis.set_minor_locator(NullLocator())
    _nodes_axis(axes)
    axes.set_ylabel("fragments of the busiest node")


def _nodes_axis(axes: Axes) -> None:
    axes.xaxis.set_major_locator(FixedLocator([float(place) for place in range(len(NODES))]))
    axes.set_xticklabels([str(nodes) for nodes in NODES])
    axes.set_xlabel("processors")
    axes.grid(alpha=0.25)
    axes.spines[["top", "right"]].set_visible(False)
