"""What an atlas looks like: the map, what limits each point, and speed against error."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from matplotlib.axes import Axes
from matplotlib.colors import to_rgb
from matplotlib.figure import Figure
from matplotlib.layout_engine import ConstrainedLayoutEngine
from matplotlib.patches import Patch, Rectangle
from matplotlib.ticker import LogLocator, NullLocator, StrMethodFormatter

from .atlas import Atlas
from .atlas_map import MEASURES, Cell, Place, atlas_map, finest, kind_of, kinds
from .points.atlas_point import AtlasPoint, Figures
from .points.model_figures import LIMITS

#: Of kinds of cages, in turn as they were asked for; those with lists are darker.
KIND_COLORS = ("#8fb7dd", "#8ccfae", "#f0b671", "#c3a3dc", "#e79a93", "#86cbd1", "#d6cf7a",
               "#c9b39b", "#b5bcc6", "#e6a8cf", "#aad57f", "#f2c9a1")
LIST_SHADE = 0.68

LIMIT_COLORS = dict(zip(LIMITS.values(), (
    "#d98a2b", "#3b82c4", "#2a9d6f", "#c9a227", "#8a5fb0", "#c4525b"), strict=True))

#: More rows of limits than that would be no picture any more.
MOST_ROWS = 60

#: In inches, of a cell of the map, and of one in which kinds take two lines, since they tell where
#: triangles of objects are made.
CELL_HEIGHT, MAKING_HEIGHT = 0.54, 0.72
OBJECTS = ", objects"

#: Characters of a scene's name beside the map.
NAME = 22


def kind_colors(atlas: Atlas) -> dict[str, tuple[float, float, float]]:
    """A colour for each kind of cage: of one without lists, and of the same one with them."""
    found: dict[str, tuple[float, float, float]] = {}
    bases = list(dict.fromkeys(kind.removesuffix(", lists") for kind in kinds(atlas)))
    for number, base in enumerate(bases):
        red, green, blue = to_rgb(KIND_COLORS[number % len(KIND_COLORS)])
        found[base] = red, green, blue
        found[f"{base}, lists"] = red * LIST_SHADE, green * LIST_SHADE, blue * LIST_SHADE
    return {kind: found[kind] for kind in kinds(atlas)}


def map_figure(atlas: Atlas) -> Figure:
    """Four maps: of each measure the best kind of cage, for each scene, size and number of
    elements."""
    found = atlas_map(atlas)
    cells = list(next(iter(found.values())))
    scenes = list(dict.fromkeys(cell.scene for cell in cells))
    columns = sorted({(cell.elements, cell.size) for cell in cells})
    making = any(OBJECTS in kind for kind in kinds(atlas))
    height = MAKING_HEIGHT if making else CELL_HEIGHT
    figure = Figure(figsize=(2.6 + 2.4 * len(columns), 1.6 + 2 * height * max(2, len(scenes))),
                    layout=ConstrainedLayoutEngine(wspace=0.03, hspace=0.04))
    panels = figure.subplots(2, 2, sharex=True, sharey=True, squeeze=False)
    colors = kind_colors(atlas)
    for axes, (name, places) in zip(panels.flat, found.items(), strict=True):
        _map(axes, places, scenes, columns, colors)
        axes.set_title(f"{MEASURES[name].best}: {MEASURES[name].unit}", fontsize=10, loc="left")
    shown = {place.best.kind for places in found.values() for place in places.values()}
    figure.legend(handles=[Patch(color=color, label=kind) for kind, color in colors.items()
                           if kind in shown], loc="outside lower center", ncols=5, frameon=False,
                  fontsize=9)
    return figure


def _map(axes: Axes, places: dict[Cell, Place], scenes: Sequence[str],
         columns: Sequence[tuple[int, tuple[int, int]]], colors: dict[str, Any]) -> None:
    for cell, place in places.items():
        x, y = columns.index((cell.elements, cell.size)), scenes.index(cell.scene)
        color = colors[place.best.kind]
        axes.add_patch(Rectangle((x - 0.5, y - 0.5), 1, 1, facecolor=color, edgecolor="white",
                                 linewidth=1.5))
        ahead = "" if place.ahead is None else f"then {place.second}, ×{place.ahead:.2f}"
        ink = "white" if sum(color) < 1.45 else "black"
        axes.text(x, y - 0.27, _broken(place.best.kind), ha="center", va="center", fontsize=8,
                  color=ink, fontweight="bold")
        for down, words in ((0.05, f"{place.best.figure:,}"), (0.32, _broken(ahead))):
            axes.text(x, y + down, words, ha="center", va="center", fontsize=6.5, color=ink)
    axes.set_xlim(-0.5, len(columns) - 0.5)
    axes.set_ylim(len(scenes) - 0.5, -0.5)
    axes.set_yticks(range(len(scenes)), [scene[:NAME] for scene in scenes])
    axes.set_xticks(range(len(columns)), ["{} element{}\n{}x{}".format(
        elements, "s" * (elements > 1), *size) for elements, size in columns], fontsize=8)
    _bare(axes)


def _broken(words: str) -> str:
    """On two lines, where one would be wider than a cell."""
    return words.replace(OBJECTS, ",\n" + OBJECTS.removeprefix(", "))


def limits_figure(atlas: Atlas) -> Figure:
    """What takes longest, of each cage for each picture; a dot where the picture is complete in
    less than a scan, so that no faster machine shows more of them."""
    points = {point: figures for point, figures in atlas.figures.items()
              if point.fraction_bits == finest(atlas)}
    cages = list(dict.fromkeys(point.cage.label for point in points))[:MOST_ROWS]
    columns = list(dict.fromkeys((point.scene.name, point.scene.size) for point in points))
    figure = Figure(figsize=(2.5 + 0.95 * max(4, len(columns)), 1.8 + 0.24 * max(4, len(cages))),
                    layout="constrained")
    axes = figure.subplots()
    for point, figures in points.items():
        if point.cage.label not in cages:
            continue
        x, y = columns.index((point.scene.name, point.scene.size)), cages.index(point.cage.label)
        axes.add_patch(Rectangle((x - 0.5, y - 0.5), 1, 1, edgecolor="white",
                                 facecolor=LIMIT_COLORS[figures["limit"]]))
        axes.text(x, y, f"{figures['work']:,}" + (" •" if figures["scans"] == 1 else ""),
                  ha="center", va="center", fontsize=7, color="white")
    axes.set_xlim(-0.5, len(columns) - 0.5)
    axes.set_ylim(len(cages) - 0.5, -0.5)
    axes.set_yticks(range(len(cages)), cages, fontsize=8)
    axes.set_xticks(range(len(columns)), ["{}\n{}x{}".format(name[:12], *size)
                                          for name, size in columns], fontsize=7)
    _bare(axes)
    shown = {figures["limit"] for figures in points.values()}
    figure.legend(handles=[Patch(color=color, label=limit) for limit, color in
                           LIMIT_COLORS.items() if limit in shown],
                  loc="outside lower center", ncols=6, frameon=False, fontsize=9)
    return figure


def _bare(axes: Axes) -> None:
    axes.tick_params(length=0)
    axes.spines[:].set_visible(False)


def error_figure(atlas: Atlas) -> Figure | None:
    """Speed against error of the largest machines at the largest size: fragments a clock, and for
    each 100,000 cells; None where there is one precision alone."""
    if len(set(atlas.options.fraction_bits)) < 2:
        return None
    size = max(atlas.options.sizes, key=lambda size: size[0] * size[1])
    elements = max(figures["machine"]["elements"] for figures in atlas.figures.values())
    curves: dict[str, dict[str, list[tuple[AtlasPoint, Figures]]]] = {}
    for point, figures in atlas.figures.items():
        if point.scene.size == size and figures["machine"]["elements"] == elements:
            curves.setdefault(point.scene.name, {}).setdefault(kind_of(point.cage), []).append(
                (point, figures))
    if not curves:
        return None
    figure = Figure(figsize=(2.6 * max(2, len(curves)), 5.4), layout="constrained")
    panels = figure.subplots(2, len(curves), squeeze=False, sharex=True, sharey="row")
    colors = kind_colors(atlas)
    for column, (scene, cages) in enumerate(curves.items()):
        for row in range(2):
            for kind, points in cages.items():
                _curve(panels[row][column], points, colors[kind], row, kind)
        panels[0][column].set_title(f"{scene[:NAME]}", fontsize=9)
        panels[1][column].set_xlabel("greatest depth error, LSB", fontsize=8)
    panels[0][0].set_ylabel("fragments a clock", fontsize=9)
    panels[1][0].set_ylabel("… for each 100,000 cells", fontsize=9)
    figure.suptitle("{} elements, {}x{}".format(elements, *size), fontsize=10)
    figure.legend(*panels[0][0].get_legend_handles_labels(), loc="outside lower center", ncols=5,
                  frameon=False, fontsize=8)
    return figure


def _curve(axes: Axes, points: Sequence[tuple[AtlasPoint, Figures]], color: Any, row: int,
           kind: str) -> None:
    places = sorted((figures["error"]["depth_anywhere"],
                     figures["fragments"] / max(figures["work"], 1)
                     * (1e5 / max(figures["cells"], 1) if row else 1)) for _, figures in points)
    axes.plot([error for error, _ in places], [speed for _, speed in places], color=color,
              marker="o", markersize=3.5, linewidth=1.3, label=kind,
              linestyle="--" if kind.endswith(", lists") else "-")
    axes.set_yscale("log")
    axes.yaxis.set_major_locator(LogLocator(subs=(1.0, 2.0, 5.0)))
    axes.yaxis.set_major_formatter(StrMethodFormatter("{x:g}"))
    axes.yaxis.set_minor_locator(NullLocator())
    axes.grid(alpha=0.25)
    axes.spines[["top", "right"]].set_visible(False)
    axes.tick_params(labelsize=8)
