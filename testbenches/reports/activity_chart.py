"""Where the processing elements' clocks went, and when, as charts for the report."""

from __future__ import annotations

import numpy as np
from matplotlib.axes import Axes
from matplotlib.colors import to_rgb
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator, StrMethodFormatter
from numpy.typing import NDArray

from ..engines.activity_record import ACTIVITY_KINDS, ActivityRecord
from .page import chart_style, svg_element

#: Names beside more rows than that would overlap.
_LABELLED_ELEMENTS = 24

#: Height in dots of a processing element's row in the timeline; between two rows there is a gap.
_ROW_DOTS = 16
_GAP_DOTS = 2


def activity_chart(record: ActivityRecord) -> str:
    """An ``<svg>`` element: each processing element's clocks by kind, as one bar."""
    totals = 100 * record.by_element / max(record.clocks, 1)
    seen = [place for place in range(len(ACTIVITY_KINDS)) if totals[:, place].any()]
    with chart_style():
        figure, axes = _figure(len(totals), legend_rows=-(-len(seen) // 4))
        begin = np.zeros(len(totals))
        for place in seen:
            kind = ACTIVITY_KINDS[place]
            axes.barh(range(len(totals)), totals[:, place], left=begin, color=kind.color,
                      height=0.7, label=kind.title)
            begin += totals[:, place]
        axes.set_xlim(0, 100)
        axes.set_ylim(len(totals) - 0.5, -0.5)
        axes.set_xlabel("% of the clocks of the frame")
        figure.legend(loc="outside upper left", ncols=4, frameon=False, fontsize=9)
        return svg_element(figure, "Clocks of each processing element by what it did")


def timeline_chart(record: ActivityRecord) -> str:
    """An ``<svg>`` element: a row for each processing element, over the clocks of the frame.

    The height of a row is divided among the kinds as the clocks of each moment are.
    """
    elements = record.counts.shape[1]
    with chart_style():
        figure, axes = _figure(elements, legend_rows=0)
        axes.imshow(timeline_picture(record), interpolation="nearest", aspect="auto",
                    extent=(0, len(record.counts) * record.bucket_clocks, elements - 0.5, -0.5))
        axes.set_xlim(0, max(record.clocks, 1))
        axes.set_xlabel("clocks since the frame's start")
        axes.xaxis.set_major_locator(MaxNLocator(8, integer=True))
        axes.xaxis.set_major_formatter(StrMethodFormatter("{x:,.0f}"))
        return svg_element(figure, "What each processing element did over the frame")


def timeline_picture(record: ActivityRecord) -> NDArray[np.uint8]:
    """uint8 (rows, buckets, 4): red, green, blue, opacity; ``_ROW_DOTS`` rows for each element."""
    order = [kind.activity for kind in ACTIVITY_KINDS]
    counts = record.counts[:, :, order]
    ends = np.cumsum(counts, axis=2) / np.maximum(counts.sum(axis=2, keepdims=True), 1)
    # The kind that a dot falls into, from the row's lower edge, where fragments are, upwards.
    height = (np.arange(_ROW_DOTS)[::-1] + 0.5) / _ROW_DOTS
    kind = (height[:, np.newaxis, np.newaxis, np.newaxis] >= ends).sum(axis=3)
    palette = np.array([[*to_rgb(kind.color), 1.0] for kind in ACTIVITY_KINDS])
    dots = palette[np.minimum(kind, len(order) - 1)]
    dots[:_GAP_DOTS, :, :, 3] = 0
    rows = dots.transpose(2, 0, 1, 3).reshape(-1, len(counts), 4)
    return np.asarray((255 * rows).round().astype(np.uint8))


def _figure(elements: int, legend_rows: int) -> tuple[Figure, Axes]:
    height = 0.8 + 0.22 * legend_rows + min(0.34 * elements, 12.0)
    figure = Figure(figsize=(9.0, height), layout="constrained")
    axes = figure.subplots()
    axes.spines[["top", "right", "left"]].set_visible(False)
    axes.tick_params(axis="y", length=0)
    if elements <= _LABELLED_ELEMENTS:
        axes.set_yticks(range(elements), [f"PE {number}" for number in range(elements)])
    else:
        axes.set_ylabel("processing element")
    return figure, axes
