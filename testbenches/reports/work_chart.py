"""Work per processing element as a chart for the report."""

from __future__ import annotations

from collections.abc import Sequence

from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.layout_engine import ConstrainedLayoutEngine
from matplotlib.ticker import MaxNLocator, StrMethodFormatter

from ..frames.responses import Work
from .page import chart_style, svg_element

FRAGMENTS_COLOR = "#3b82c4"
BUSY_COLOR = "#d98a2b"

#: Figures beside more bars than that would overlap.
_LABELLED_ELEMENTS = 24


def work_chart(work: Sequence[Work]) -> str:
    """An ``<svg>`` element: fragments and busy cycles of each processing element, left to right.

    It holds no link and takes the page's text colour.
    """
    with chart_style():
        height = 1.1 + min(0.34 * len(work), 12.0)
        figure = Figure(figsize=(9.0, height), layout=ConstrainedLayoutEngine(wspace=0.06))
        fragments, busy = figure.subplots(1, 2, sharey=True)
        _bars(fragments, [element.fragments for element in work], FRAGMENTS_COLOR,
              "fragments tested")
        _bars(busy, [element.busy_cycles for element in work], BUSY_COLOR, "busy cycles")
        fragments.invert_yaxis()  # the first element on top; shared with the other half
        if len(work) <= _LABELLED_ELEMENTS:
            fragments.set_yticks(range(len(work)), [f"PE {number}" for number in range(len(work))])
        else:
            fragments.set_ylabel("processing element")
        return svg_element(figure, "Fragments and busy cycles of each processing element")


def _bars(axes: Axes, values: Sequence[int], color: str, label: str) -> None:
    bars = axes.barh(range(len(values)), values, color=color, height=0.7)
    axes.set_xlabel(label)
    axes.set_xlim(0, max([*values, 1]) * 1.18)
    axes.xaxis.set_major_locator(MaxNLocator(6, integer=True))
    axes.xaxis.set_major_formatter(StrMethodFormatter("{x:,.0f}"))
    axes.spines[["top", "right"]].set_visible(False)
    axes.tick_params(axis="y", length=0)
    if len(values) <= _LABELLED_ELEMENTS:
        axes.bar_label(bars, [f"{value:,}" for value in values], padding=4)
