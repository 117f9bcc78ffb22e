"""What a comparison of cages looks like: clocks and bits, and speed-up along the nodes."""

from __future__ import annotations

from collections.abc import Sequence

from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.layout_engine import ConstrainedLayoutEngine
from matplotlib.ticker import FixedLocator, MaxNLocator, NullLocator, StrMethodFormatter

from ..reports.page import chart_style, svg_element
from .cage import CageRun
from .node_sweep import Curve

DRAW_COLOR = "#3b82c4"
MERGE_COLOR = "#d98a2b"
SENT_COLOR = "#8a5fb0"

#: Of the curves, in turn; those of retained lists are dashed.
CURVE_COLORS = ("#5c6678", "#3b82c4", "#d98a2b", "#2a9d6f", "#8a5fb0", "#b3261e")


def figures_chart(runs: Sequence[CageRun]) -> str:
    """An ``<svg>`` element: of each cage clocks to draw and to merge, and the bits its nodes send.
    """
    with chart_style():
        figure = Figure(figsize=(9.0, 1.5 + min(0.42 * len(runs), 14.0)),
                        layout=ConstrainedLayoutEngine(wspace=0.06))
        clocks, bits = figure.subplots(1, 2, sharey=True)
        draw = [run.clocks.draw for run in runs]
        merge = [run.clocks.merge for run in runs]
        places = range(len(runs))
        clocks.barh(places, draw, color=DRAW_COLOR, height=0.66, label="draw")
        last = clocks.barh(places, merge, left=draw, color=MERGE_COLOR, height=0.66, label="merge")
        clocks.bar_label(last, [f"{one + other:,}" for one, other in zip(draw, merge, strict=True)],
                         padding=4)
        _finish(clocks, "clocks of a frame, without the wait for the scan")
        sent = [run.traffic.bits for run in runs]
        busiest = [run.traffic.busiest_piece * run.traffic.pixel_bits for run in runs]
        bars = bits.barh(places, sent, color=SENT_COLOR, alpha=0.35, height=0.66, label="in all")
        bits.barh(places, busiest, color=SENT_COLOR, height=0.66, label="on the busiest link")
        bits.bar_label(bars, [f"{number:,}" if number else "none" for number in sent], padding=4)
        _finish(bits, "bits sent between nodes for a picture")
        clocks.invert_yaxis()  # the first cage on top; shared with the other half
        clocks.set_yticks(places, [run.cage.label for run in runs])
        return svg_element(figure, "Clocks to draw and to merge, and bits sent, of each cage")


def _finish(axes: Axes, label: str) -> None:
    axes.set_xlabel(label)
    axes.set_xlim(0, max(1.0, axes.dataLim.xmax) * 1.24)
    axes.xaxis.set_major_locator(MaxNLocator(5, integer=True))
    axes.xaxis.set_major_formatter(StrMethodFormatter("{x:,.0f}"))
    axes.spines[["top", "right"]].set_visible(False)
    axes.tick_params(axis="y", length=0)
    axes.legend(loc="lower center", bbox_to_anchor=(0.5, 1.0), ncols=2, frameon=False, fontsize=9)


def sweep_chart(curves: Sequence[Curve]) -> str:
    """An ``<svg>`` element: speed-up along the nodes, of the scene as it is and of one that grows;
    lines are the cycle model's, marks were simulated."""
    with chart_style():
        figure = Figure(figsize=(9.0, 4.6), layout=ConstrainedLayoutEngine(wspace=0.08))
        panels = figure.subplots(1, 2, sharey=True)
        labels = list(dict.fromkeys(curve.label for curve in curves))
        nodes = sorted({point.place.nodes for curve in curves for point in curve.points})
        for axes, growing in zip(panels, (False, True), strict=True):
            axes.plot(nodes, [number / nodes[0] for number in nodes], color="#999999",
                      linestyle=":", linewidth=1.2, label="ideal")
            for curve in curves:
                if curve.growing == growing:
                    _curve(axes, curve, labels.index(curve.label))
            _nodes_axis(axes, nodes)
        panels[0].set_title("the scene as it is", fontsize=10)
        panels[1].set_title("a scene that grows with the machine", fontsize=10)
        panels[0].set_ylabel(f"speed-up over {nodes[0]} node{'s' * (nodes[0] > 1)}")
        figure.legend(*panels[0].get_legend_handles_labels(), loc="outside lower center", ncols=4,
                      frameon=False, fontsize=9)
        return svg_element(figure, "Speed-up of each kind of cage along the number of its nodes")


def _curve(axes: Axes, curve: Curve, number: int) -> None:
    color = CURVE_COLORS[number % len(CURVE_COLORS)]
    points = curve.speed_ups()
    axes.plot([point.place.nodes for point, _, _ in points], [model for _, model, _ in points],
              color=color, linewidth=1.6, linestyle="--" if curve.retained else "-",
              label=curve.label)
    simulated = [(point.place.nodes, found) for point, _, found in points if found is not None]
    axes.plot([place for place, _ in simulated], [found for _, found in simulated], color=color,
              linestyle="none", marker="s" if curve.retained else "o", markersize=5)


def _nodes_axis(axes: Axes, nodes: Sequence[int]) -> None:
    axes.set_xscale("log", base=2)
    axes.set_yscale("log", base=2)
    axes.xaxis.set_major_locator(FixedLocator([float(number) for number in nodes]))
    for axis in (axes.xaxis, axes.yaxis):
        axis.set_minor_locator(NullLocator())
        axis.set_major_formatter(StrMethodFormatter("{x:g}"))
    axes.set_xlabel("nodes (of one node: elements with their units)")
    axes.grid(alpha=0.25)
    axes.spines[["top", "right"]].set_visible(False)
