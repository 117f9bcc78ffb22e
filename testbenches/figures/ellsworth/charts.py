"""Figures 4 and 5, a model each, and the overlap factor."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Literal

from matplotlib import colormaps
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.ticker import FixedLocator, NullLocator, PercentFormatter, StrMethodFormatter

from ...reports.page import chart_style, svg_element
from .dealing.dealing_job import CLOCKS, LAST, SCATTERED, STATIC, THIS, TRIANGLES
from .dealing.model_dealing import ModelDealing
from .dealing.screen_grids import PROCESSORS, RATIOS
from .frame_time import RATIOS as TIMED_RATIOS
from .frame_time import relative_times
from .in_rtl import MEASURED, Point
from .overlap import SIDES, Overlap, by_regions

#: One of each ratio, from few regions to many.
COLORS = dict(zip(RATIOS, ("#7a7a7a", "#b0643c", "#d98a2b", "#8aa02b", "#2a9d6f", "#3b82c4",
                           "#8a5fb0"), strict=True))

#: What tables are made of, and how each panel of figure 4 draws it.
PANELS = {
    "static": {STATIC: ":", SCATTERED: "-."},
    "by triangles": {f"{TRIANGLES}, {THIS}": "--", f"{TRIANGLES}, {LAST}": "-"},
    "by clocks": {f"{CLOCKS}, {THIS}": "--", f"{CLOCKS}, {LAST}": "-"},
}


POINT_COLOR = "#c0392b"

#: Inches, at least: pages draw every chart as wide as they are, and its type with it.
_WIDTH = 10.5


def figure_4(model: ModelDealing, points: Sequence[Point] = ()) -> str:
    """An ``<svg>`` element: utilisation against processors, a curve for each ratio; ``points`` were
    measured in RTL."""
    with chart_style():
        figure = Figure(figsize=(_WIDTH, 3.7), layout="constrained")
        _utilisation_panels(figure.subplots(1, len(PANELS), sharey=True), model, points)
        _legend(figure, bool(points))
        return svg_element(figure, f"{model.model.name}: utilisation against processors, a curve "
                           "for each granularity ratio")


def save_figure_4(models: Sequence[ModelDealing], path: Path, points: Sequence[Point] = ()
                  ) -> None:
    """The same of all models, for a page that shows pictures only; ``points`` each where its model
    is."""
    figure = Figure(figsize=(_WIDTH, 3.3 * len(models) + 0.4), layout="constrained")
    panels = figure.subplots(len(models), len(PANELS), squeeze=False, sharey=True)
    for row, model in zip(panels, models, strict=True):
        _utilisation_panels(row, model, points_of(model, points))
    _legend(figure, bool(points))
    figure.savefig(path, dpi=100, metadata={"Software": None})


def points_of(model: ModelDealing, points: Sequence[Point]) -> list[Point]:
    """Those that were measured of ``model``."""
    return [point for point in points if point.model == model.model.name]


def _utilisation_panels(panels: Sequence[Axes], model: ModelDealing, points: Sequence[Point]
                        ) -> None:
    panels[0].set_ylabel(f"{model.model.name}: utilisation")
    for axes, (title, curves) in zip(panels, PANELS.items(), strict=True):
        for ratio in RATIOS:
            for how, style in curves.items():
                axes.plot(_places(model.processors), model.curve(ratio, how), style,
                          color=COLORS[ratio], linewidth=1.4, marker="o", markersize=2.5)
        for point in points:
            for how in curves.keys() & MEASURED:
                axes.plot(_places([point.processors]), [point.by(how)], "s", markersize=7,
                          markerfacecolor="none", markeredgewidth=1.6, color=POINT_COLOR)
        axes.set_title(title, fontsize=10)
        axes.set_ylim(0, 1.02)
        axes.yaxis.set_major_formatter(PercentFormatter(1.0))
        _processors_axis(axes, model)


def _legend(figure: Figure, measured: bool) -> None:
    lines = [Line2D([], [], color=color, label=f"{ratio}") for ratio, color in COLORS.items()]
    styles: dict[str, Literal["--", "-", ":", "-."]] = {
        "this frame's counts": "--", "the last frame's": "-", "static": ":", "scattered": "-."}
    lines += [Line2D([], [], color="#888888", linestyle=style, label=label)
              for label, style in styles.items()]
    if measured:
        lines.append(Line2D([], [], color=POINT_COLOR, marker="s", markerfacecolor="none",
                            linestyle="none", label="in RTL"))
    figure.legend(handles=lines, loc="outside lower center", ncols=len(lines), frameon=False,
                  fontsize=9, title="regions a processor", title_fontsize=9, columnspacing=1.2,
                  handlelength=1.7)


def figure_5(models: Sequence[ModelDealing]) -> str:
    """An ``<svg>`` element: relative time against ratio, a curve for each number of processors."""
    with chart_style():
        figure = Figure(figsize=(max(_WIDTH, 5.2 * len(models)), 3.6), layout="constrained")
        panels = figure.subplots(1, len(models), squeeze=False, sharey=True)[0]
        colors = colormaps["viridis"]
        for axes, model in zip(panels, models, strict=True):
            for processors, times in relative_times(model).items():
                place = PROCESSORS.index(processors) / (len(PROCESSORS) - 1)
                axes.plot(TIMED_RATIOS, times, color=colors(0.9 * place), marker="o", markersize=3,
                          linewidth=1.4, label=f"{processors}")
            axes.set_title(model.model.name, fontsize=10)
            axes.xaxis.set_major_locator(FixedLocator([float(ratio) for ratio in TIMED_RATIOS]))
            axes.set_xlabel("regions a processor")
            _plain(axes)
        panels[0].set_ylabel("relative time of a frame")
        figure.legend(*panels[0].get_legend_handles_labels(), loc="outside right upper",
                      frameon=False, fontsize=9, title="processors", title_fontsize=9)
        return svg_element(figure, "Relative time of a frame against the granularity ratio")


def overlap_chart(overlaps: Sequence[Overlap]) -> str:
    """An ``<svg>`` element: measured, and as Molnar expects."""
    with chart_style():
        figure = Figure(figsize=(7.5, 3.8), layout="constrained")
        axes = figure.subplots()
        colors = colormaps["viridis"]
        for side, found in by_regions(overlaps).items():
            color = colors(0.85 * SIDES.index(side) / (len(SIDES) - 1))
            regions = [each.regions for each in found]
            axes.plot(regions, [each.measured for each in found], color=color, marker="o",
                      markersize=3.5, label=f"triangles in squares of {side}")
            for style, expected in ((":", [each.expected for each in found]),
                                    ("--", [each.expected_of_centres for each in found])):
                axes.plot(regions, expected, style, color=color, linewidth=1.2)
        axes.plot([], [], ":", color="#888888", label="Molnar")
        axes.plot([], [], "--", color="#888888", label="Molnar, of pixel centres")
        axes.set_xscale("log", base=2)
        axes.set_yscale("log", base=2)
        axes.xaxis.set_major_formatter(StrMethodFormatter("{x:.0f}"))
        axes.yaxis.set_major_formatter(StrMethodFormatter("{x:.0f}"))
        axes.set_xlabel("regions of the screen")
        axes.set_ylabel("overlap factor")
        axes.legend(frameon=False, fontsize=9)
        _plain(axes)
        return svg_element(figure, "Overlap factor against regions, for triangles of several sizes")


def _places(processors: Sequence[int]) -> list[int]:
    return [PROCESSORS.index(each) for each in processors]


def _processors_axis(axes: Axes, model: ModelDealing) -> None:
    axes.xaxis.set_major_locator(FixedLocator([float(each) for each in _places(model.processors)]))
    axes.xaxis.set_minor_locator(NullLocator())
    axes.set_xticklabels([str(each) for each in model.processors])
    axes.set_xlabel("processors")
    _plain(axes)


def _plain(axes: Axes) -> None:
    axes.grid(alpha=0.25)
    axes.spines[["top", "right"]].set_visible(False)
