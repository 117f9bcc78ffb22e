"""Writes what was redrawn of Ellsworth: one page, one JSON file, a picture."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

from ...reports.page import page_environment
from ...support.any_characters import readable
from .charts import figure_4, figure_5, overlap_chart, points_of, save_figure_4
from .claims import claims_of, claims_of_overlap, summary
from .dealing.cures import GOES_ON
from .ellsworth import Ellsworth
from .facts import PAPER, ellsworth_facts
from .figure_tables import (
    cure_table,
    model_table,
    overlap_table,
    point_table,
    shape_table,
    time_table,
    utilisation_table,
)
from .overlap import by_shape

#: Everything that ``write_ellsworth`` writes.
FIGURE_FILES = (f"{PAPER}.html", f"{PAPER}.json", f"{PAPER}.png")


def write_ellsworth(found: Ellsworth, folder: Path) -> None:
    """Write ``FIGURE_FILES`` to ``folder``, which exists."""
    facts = ellsworth_facts(found)
    page, plain, picture = FIGURE_FILES
    (folder / plain).write_text(json.dumps(facts, indent=2) + "\n", encoding="utf-8")
    (folder / page).write_text(readable(ellsworth_page(found, facts)), encoding="utf-8")
    save_figure_4(found.models, folder / picture, found.points)


def ellsworth_page(found: Ellsworth, facts: dict[str, Any]) -> str:
    """The page, complete in itself."""
    overlaps = found.overlaps
    return page_environment().get_template("ellsworth.html").render(
        facts,
        warnings=[],
        verdicts=summary(found.models, overlaps),
        point_table=point_table(found.points) if found.points else None,
        scenes=[(model, figure_4(model, points_of(model, found.points)), claims_of(model),
                 utilisation_table(model)) for model in found.models],
        model_table=model_table(found),
        cure_table=cure_table(found.models) if facts["cures"] else None,
        goes_on=GOES_ON,
        time_chart=figure_5(found.models),
        time_table=time_table(found.models),
        overlap_chart=overlap_chart(overlaps) if overlaps else "",
        overlap_table=overlap_table(found) if overlaps else None,
        shape_table=shape_table(found) if by_shape(overlaps) else None,
        overlap_verdicts=claims_of_overlap(overlaps),
    )
