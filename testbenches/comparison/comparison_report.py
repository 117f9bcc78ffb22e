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
from .compare_cages import CageComparison
from .comparison_charts import figures_chart, sweep_chart
from .comparison_facts import comparison_facts
from .comparison_table import figures, headline, tables

#: Everything that ``write_comparison`` writes.
COMPARISON_FILES = ("comparison.html", "comparison.json", "comparison.png")

#: About as wide as a picture is on the page: of a larger one a lone red pixel would be lost.
PICTURE_PIXELS = 240


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
    )


def _pictures(comparison: CageComparison) -> list[tuple[str, str]]:
    """Picture and caption: the golden one; another one's own, or what differs from it."""
    golden = golden_picture(comparison)
    found = [(data_uri(golden), "the golden picture")]
    for group in comparison.pictures:
        shown = group[0].comparison
        where = ", ".join(run.cage.label for run in group)
        if not shown.equal:
            different = different_pixels(shown, reach=max(golden.shape) // PICTURE_PIXELS)
            found.append((data_uri(different), f"{where}: grey equal, red different"))
        elif not np.array_equal(shown.expected, golden):
            found.append((data_uri(shown.expected), f"on {where}"))
    return found
