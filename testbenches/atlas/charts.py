"""What an atlas looks like: the map, what limits each point, and speed against error."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.colors import to_rgb
from matplotlib.figure import Figure
from matplotlib.font_manager import FontProperties
from matplotlib.layout_engine import ConstrainedLayoutEngine
from matplotlib.patches import Patch, Rectangle
from matplotlib.textpath import TextPath
from matplotlib.ticker import LogLocator, NullLocator, StrMethodFormatter

from ..support.counted import counted
from .atlas import Atlas
from .atlas_map import MEASURES, Cell, Place, atlas_map, finest, kind_of, kinds
from .points.atlas_point import AtlasPoint, Figures
from .points.model_figures import LIMITS
from .scene_names import short_names

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

#: In inches, the least width of a cell of the map, and what is left free beside its words.
CELL_WIDTH, CELL_MARGIN = 1.2, 0.16

#: With more columns the four maps are one below another, or their words would be too small to read.
MOST_COLUMNS = 4

#: Of the words in a cell, in points: the kind of the best cage, and those below.
BEST_SIZE, BELOW_SIZE = 8, 6.5

#: Characters of a scene's name beside the map and above curves, and below the limits.
NAME, LIMITS_NAME = 22, 16

#: In inches, a column of the limits, of which a scene's name takes all but so much.
LIMITS_WIDTH, LIMITS_MARGIN = 0.95, 0.12


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
    width = max(CELL_WIDTH, 0.0, *(
        CELL_MARGIN + _width(line, size, bold) for places in found.values()
        for place in places.values() for words, size, bold in _words(place)
        for line in words.split("\n")))
    across = 1 if len(columns) > MOST_COLUMNS else 2
    down = len(found) // across
    figure = Figure(figsize=(2.6 + across * width * len(columns),
                             0.2 + 0.7 * down + down * height * max(2, len(scenes))),
                    layout=ConstrainedLayoutEngine(wspace=0.03, hspace=0.04))
    panels = figure.subplots(down, across, sharex=True, sharey=True, squeeze=False)
    colors = kind_colors(atlas)
    for axes, (name, places) in zip(panels.flat, found.items(), strict=True):
        _map(axes, places, scenes, columns, colors)
        axes.set_title(f"{MEASURES[name].best}: {MEASURES[name].unit}", fontsize=10, loc="left")
    shown = {place.best.kind for places in found.values() for place in places.values()}
    _legend(figure, [Patch(color=color, label=kind) for kind, color in colors.items()
                     if kind in shown], 9)
    return figure


def _legend(figure: Figure, handles: Sequence[Artist], size: float) -> None:
    """Below the figure, in as many columns as there is room for: no word of it is cut."""
    widest = max((_width(str(handle.get_label()), size) for handle in handles), default=0.0)
    # The mark of an entry and what is free around it are four and a half times its letters.
    columns = int(figure.get_figwidth() * 0.96 / (widest + 4.8 * size / 72))
    figure.legend(handles=list(handles), loc="outside lower center",
                  ncols=max(1, min(5, columns)), frameon=False, fontsize=size)


def _width(words: str, size: float, bold: bool = False) -> float:
    """In inches."""
    if not words.strip():
        return 0.0
    font = FontProperties(weight="bold" if bold else "normal")
    return float(TextPath((0, 0), words, size=size, prop=font).get_extents().width) / 72


def _words(place: Place) -> tuple[tuple[str, float, bool], ...]:
    """In a cell of the map, from above: words, how large, and whether they are bold."""
    ahead = "" if place.ahead is None else f"then {place.second}, ×{place.ahead:.2f}"
    return ((_broken(place.best.kind), BEST_SIZE, True),
            (f"{place.best.figure:,}", BELOW_SIZE, False), (_broken(ahead), BELOW_SIZE, False))


def _map(axes: Axes, places: dict[Cell, Place], scenes: Sequence[str],
         columns: Sequence[tuple[int, tuple[int, int]]], colors: dict[str, Any]) -> None:
    for cell, place in places.items():
        x, y = columns.index((cell.elements, cell.size)), scenes.index(cell.scene)
        color = colors[place.best.kind]
        axes.add_patch(Rectangle((x - 0.5, y - 0.5), 1, 1, facecolor=color, edgecolor="white",
                                 linewidth=1.5))
        ink = "white" if sum(color) < 1.45 else "black"
        for down, (words, size, bold) in zip((-0.27, 0.05, 0.32), _words(place), strict=True):
            axes.text(x, y + down, words, ha="center", va="center", fontsize=size, color=ink,
                      fontweight="bold" if bold else "normal")
    axes.set_xlim(-0.5, len(columns) - 0.5)
    axes.set_ylim(len(scenes) - 0.5, -0.5)
    names = short_names(scenes, NAME)
    axes.set_yticks(range(len(scenes)), [names[scene] for scene in scenes])
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
    names = short_names([scene for scene, _ in columns], LIMITS_NAME)
    width = max(LIMITS_WIDTH, 0.0, *(LIMITS_MARGIN + _width(name, 7) for name in names.values()))
    figure = Figure(figsize=(2.5 + width * max(4, len(columns)), 1.8 + 0.24 * max(4, len(cages))),
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
    axes.set_xticks(range(len(columns)), ["{}\n{}x{}".format(names[scene], *size)
                                          for scene, size in columns], fontsize=7)
    _bare(axes)
    shown = {figures["limit"] for figures in points.values()}
    _legend(figure, [Patch(color=color, label=limit) for limit, color in LIMIT_COLORS.items()
                     if limit in shown], 9)
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
    elements = max((figures["machine"]["elements"] for figures in atlas.figures.values()),
                   default=0)
    curves: dict[str, dict[str, list[tuple[AtlasPoint, Figures]]]] = {}
    for point, figures in atlas.figures.items():
        if point.scene.size == size and figures["machine"]["elements"] == elements:
            curves.setdefault(point.scene.name, {}).setdefault(kind_of(point.cage), []).append(
                (point, figures))
    if not curves:
        return None
    figure = Figure(figsize=(2.6 * max(2, len(curves)), 5.4), layout="constrained")
    panels = figure.subplots(2, len(curves), squeeze=False, sharex=True, sharey="row")
    colors, names = kind_colors(atlas), short_names(list(curves), NAME)
    for column, (scene, cages) in enumerate(curves.items()):
        for row in range(2):
            for kind, points in cages.items():
                _curve(panels[row][column], points, colors[kind], row, kind)
        panels[0][column].set_title(names[scene], fontsize=9)
        panels[1][column].set_xlabel("greatest depth error, LSB", fontsize=8)
    panels[0][0].set_ylabel("fragments a clock", fontsize=9)
    panels[1][0].set_ylabel("… for each 100,000 cells", fontsize=9)
    figure.suptitle("{} at {}x{}: the most elements, the largest size".format(
        counted(elements, "element"), *size), fontsize=10)
    # A scene without objects lacks kinds that others have.
    lines = {line.get_label(): line for panel in panels[0] for line in panel.get_lines()}
    _legend(figure, [*lines.values()], 8)
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
