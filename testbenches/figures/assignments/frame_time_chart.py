"""The map of assignments: how long a frame takes by each, of every scene, on few and many nodes."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from ...reports.page import chart_style, svg_element
from .assignment import ASSIGNMENTS, ROUND_ROBIN
from .frame_times import MAP_NODES, AssignmentTimes

WAYS = {"in_turn": "drawn, then merged", "overlapped": "merged while the next one is drawn"}


def assignment_chart(maps: Sequence[AssignmentTimes]) -> str:
    """An ``<svg>`` element: a row of fields for each scene, a column for each assignment; what is
    in a field is the frame time, by round robin it is 1."""
    scenes = list(dict.fromkeys(each.scene for each in maps))
    with chart_style():
        figure = Figure(figsize=(12.0, (1.3 + 0.3 * len(scenes)) * len(WAYS) + 1.6),
                        layout="constrained")
        grid = figure.subplots(len(WAYS), len(MAP_NODES), sharex=True, sharey=True, squeeze=False)
        for row, (way, title) in zip(grid, WAYS.items(), strict=True):
            for axes, nodes in zip(row, MAP_NODES, strict=True):
                _fields(axes, [each for each in maps if each.nodes == nodes], way)
                axes.set_title(f"{title}, {nodes} nodes", fontsize=9)
        for row in grid:
            row[0].set_yticks(range(len(scenes)), scenes)
        for axes in grid[-1]:
            axes.set_xticks(range(len(ASSIGNMENTS)), [each.name for each in ASSIGNMENTS],
                            rotation=90)
        return svg_element(figure, "Frame time by each assignment against round robin, of every "
                           "scene on few and many nodes")


def _fields(axes: Axes, maps: Sequence[AssignmentTimes], way: str) -> None:
    values = np.array([[getattr(time, way) / getattr(each.of(ROUND_ROBIN), way)
                        for time in each.times] for each in maps])
    axes.imshow(np.log2(values), cmap="RdYlGn_r", vmin=-1.8, vmax=1.8, aspect="auto")
    for (row, column), value in np.ndenumerate(values):
        axes.text(column, row, f"{value:.2f}", ha="center", va="center", fontsize=7.5,
                  color="#1c2330")
    axes.tick_params(length=0, labelsize=8.5)
    axes.spines[:].set_visible(False)
