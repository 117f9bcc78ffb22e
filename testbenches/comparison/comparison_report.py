"""Writes a comparison of cages: one page, one JSON file, the picture."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..reports.frame_pictures import data_uri, different_pixels, png
from ..reports.page import page_environment
from ..support.any_characters import readable
from .cage import CageRun
from .compare_cages import CageComparison
from .comparison_charts import figures_chart, sweep_chart
from .comparison_facts import comparison_facts
from .comparison_table import figures, headline, tables

#: Everything that ``write_comparison`` writes.
COMPARISON_FILES = ("comparison.html", "comparison.json", "comparison.png")


def write_comparison(comparison: CageComparison, folder: Path) -> None:
    """Write ``COMPARISON_FILES`` to ``folder``, which exists."""
    facts = comparison_facts(comparison)
    (folder / "comparison.json").write_text(json.dumps(facts, indent=2) + "\n", encoding="utf-8")
    (folder / "comparison.html").write_text(readable(comparison_page(comparison, facts)),
                                            encoding="utf-8")
    (folder / "comparison.png").write_bytes(png(golden_picture(comparison)))


def golden_picture(comparison: CageComparison) -> NDArray[np.uint8]:
    """What the first cage should show, uint8 (height, width, 3); black where no cage delivers."""
    if comparison.runs:
        return comparison.runs[0].comparison.expected
    listed = comparison.scene.display_list
    return np.zeros((listed.height, listed.width, 3), np.uint8)


def comparison_page(comparison: CageComparison, facts: dict[str, Any]) -> str:
    """The page, complete in itself: pictures and charts are inside it."""
    return page_environment().get_template("comparison.html").render(
        facts,
        headline=headline(comparison),
        pictures=_pictures(comparison),
        figures=figures(comparison),
        chart=figures_chart(comparison.runs) if comparison.runs else "",
        sweep_chart=sweep_chart(comparison.curves) if comparison.curves else "",
        sweep_tables=tables(comparison)[bool(comparison.runs):],
        nothing_sent=all(run.configuration.merge is None for run in comparison.runs),
    )


def _pictures(comparison: CageComparison) -> list[tuple[str, str]]:
    """Picture and caption: the golden one, and of each other picture what differs."""
    first = comparison.runs[0].comparison if comparison.runs else None
    found = []
    if first is not None:
        found.append((data_uri(first.expected), "the golden picture"))
    for group in comparison.pictures:
        shown = group[0]
        where = ", ".join(run.cage.label for run in group)
        if shown.comparison.equal and not comparison.identical and len(comparison.pictures) > 1:
            found.append((data_uri(shown.simulation.video), f"on {where}"))
        elif not shown.comparison.equal:
            found.append((data_uri(_different(shown)), f"{where}: grey equal, red different"))
    return found


def _different(run: CageRun) -> NDArray[np.uint8]:
    return different_pixels(run.comparison)
