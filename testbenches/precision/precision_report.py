"""Writes the report of a study of precision: one page, one JSON file, the plot."""

from __future__ import annotations

import json
from pathlib import Path

from ..reports.page import page_environment
from ..support.any_characters import readable
from .precision_chart import precision_svg, save_precision_png
from .precision_facts import precision_facts
from .precision_table import headline, remarks, tables
from .scene_precision import Precision

#: Everything that ``write_precision_report`` writes.
PRECISION_FILES = ("precision.html", "precision.json", "precision.png")


def write_precision_report(precision: Precision, folder: Path) -> None:
    """Write ``PRECISION_FILES`` to ``folder``, which exists."""
    facts = json.dumps(precision_facts(precision), indent=2) + "\n"
    (folder / "precision.json").write_text(facts, encoding="utf-8")
    (folder / "precision.html").write_text(readable(precision_page(precision)),
                                           encoding="utf-8")
    save_precision_png(precision, folder / "precision.png")


def precision_page(precision: Precision) -> str:
    """The page, complete in itself: the plot is inside it."""
    return page_environment().get_template("precision.html").render(
        precision_facts(precision),
        headline=headline(precision),
        tables=tables(precision),
        remarks=remarks(precision),
        chart=precision_svg(precision),
    )
