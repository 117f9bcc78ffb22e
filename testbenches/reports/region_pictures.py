"""Who draws which region of the screen: pictures in a colour for each processing element, and how
evenly the work falls to them from picture to picture."""

from __future__ import annotations

import colorsys
from collections.abc import Sequence
from typing import Any

import numpy as np
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator, PercentFormatter
from numpy.typing import NDArray

from ..frames.region_figures import RegionFigures
from .page import chart_style, svg_element
from .work_chart import BUSY_COLOR, FRAGMENTS_COLOR

Pixels = NDArray[np.uint8]

#: Of a colour, a turn each: neighbouring numbers look least alike.
_TURN = (5 ** 0.5 - 1) / 2

#: What of the picture shines through.
_THROUGH = 0.6


def element_colors(elements: int) -> NDArray[np.float64]:
    """float64 (elements, 3), from 0 to 1."""
    return np.array([colorsys.hsv_to_rgb(element * _TURN % 1, 0.55 if element % 2 else 0.8, 1.0)
                     for element in range(elements)])


def region_picture(figures: RegionFigures, picture: Pixels) -> Pixels:
    """uint8 (height, width, 3): ``picture``, as it left the pins, in the colours of those who drew
    it; darker along the left and upper sides of regions."""
    configuration = figures.configuration
    regions = configuration.dealt_regions
    y, x = np.mgrid[:configuration.height, :configuration.width]
    color = element_colors(configuration.processing_elements)[figures.table[regions.region(x, y)]]
    lightness = picture @ np.array([0.299, 0.587, 0.114]) / 255
    shown = color * (1 - _THROUGH + _THROUGH * lightness)[..., np.newaxis]
    for place, bits, count in ((x, regions.x_bits, regions.columns),
                               (y, regions.y_bits, regions.rows)):
        if bits > 1 and count > 1:  # there is something between the lines
            shown[(place & (1 << bits) - 1 == 0) & (place > 0)] *= 0.55
    return np.asarray(np.rint(255 * shown), np.uint8)


def utilisation_chart(frames: Sequence[dict[str, Any]]) -> str:
    """An ``<svg>`` element, over the pictures: utilisation, and the greatest region's part of an
    even share; ``frames`` are those of ``sequence_facts``."""
    told = [(frame["number"], frame["regions"]) for frame in frames]
    numbers = [number for number, _ in told]
    with chart_style():
        figure = Figure(figsize=(9.0, 2.6), layout="constrained")
        axes = figure.subplots()
        axes.step(numbers, [regions["utilisation"] for _, regions in told], where="mid",
                  marker=".", color=FRAGMENTS_COLOR, label="utilisation")
        axes.step(numbers, [_greatest(regions) for _, regions in told], where="mid", linewidth=1,
                  color=BUSY_COLOR, label="the costliest region, of an even share")
        axes.axhline(1, linestyle=":", linewidth=1, color="#8a94a6")
        axes.set_ylim(bottom=0)
        axes.yaxis.set_major_formatter(PercentFormatter(1.0, decimals=0))
        axes.set_xlabel("picture")
        axes.xaxis.set_major_locator(MaxNLocator(12, integer=True))
        axes.legend(loc="lower center", bbox_to_anchor=(0.5, 1.0), ncols=2, frameon=False)
        axes.spines[["top", "right"]].set_visible(False)
        return svg_element(figure, "Utilisation of the processing elements in each picture")


def _greatest(regions: dict[str, Any]) -> float:
    """Above 1 one region alone keeps its processing element longer than all others need."""
    greatest: int = regions["greatest_region"]
    total: int = regions["total"]
    return greatest * len(regions["per_pe"]) / max(total, 1)


def load_chart(facts: dict[str, Any]) -> str:
    """An ``<svg>`` element: what is counted of the regions of each processing element."""
    loads = facts["per_pe"]
    colors = element_colors(len(loads))
    with chart_style():
        figure = Figure(figsize=(9.0, 2.4), layout="constrained")
        axes = figure.subplots()
        axes.bar(range(len(loads)), loads, color=colors, width=0.8)
        axes.axhline(facts["total"] / len(loads), linestyle=":", linewidth=1, color="#8a94a6",
                     label="mean")
        axes.set_ylabel(facts["counted"])
        axes.set_xlabel("processing element")
        axes.xaxis.set_major_locator(MaxNLocator(16, integer=True))
        axes.legend(loc="lower center", bbox_to_anchor=(0.5, 1.0), frameon=False)
        axes.spines[["top", "right"]].set_visible(False)
        return svg_element(figure, f"Counted {facts['counted']} of each processing element")
