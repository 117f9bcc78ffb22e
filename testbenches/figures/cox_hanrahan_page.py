"""Writes what was redrawn of Cox and Hanrahan: one page, one JSON file, a picture."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

from ..reports.page import page_environment
from ..support.any_characters import readable
from .assignments.frame_time_chart import assignment_chart
from .claims import claims_of, summary
from .cox_hanrahan import CoxHanrahan
from .cox_hanrahan_facts import PAPER, cox_hanrahan_facts
from .figure_tables import (
    assignment_table,
    merge_table,
    paper_table,
    table_1,
    traffic_table,
)
from .traffic_charts import save_traffic_png, traffic_chart

#: Everything that ``write_cox_hanrahan`` writes.
FIGURE_FILES = (f"{PAPER}.html", f"{PAPER}.json", f"{PAPER}.png")

#: On the picture: as the paper expects, and the two ways in which it does not.
PICTURE_SCENES = ("spheres", "tetra", "background first")


def write_cox_hanrahan(found: CoxHanrahan, folder: Path) -> None:
    """Write ``FIGURE_FILES`` to ``folder``, which exists."""
    facts = cox_hanrahan_facts(found)
    page, plain, picture = FIGURE_FILES
    (folder / plain).write_text(json.dumps(facts, indent=2) + "\n", encoding="utf-8")
    (folder / page).write_text(readable(cox_hanrahan_page(found, facts)), encoding="utf-8")
    save_traffic_png([scene for scene in found.scenes if scene.name in PICTURE_SCENES],
                     folder / picture)


def cox_hanrahan_page(found: CoxHanrahan, facts: dict[str, Any]) -> str:
    """The page, complete in itself."""
    small = found.point_traffic
    return page_environment().get_template("cox_hanrahan.html").render(
        {name: fact for name, fact in facts.items() if name not in ("paper_table", "traffic")},
        warnings=[],
        verdicts=summary(found.scenes),
        table_1=table_1(found),
        paper_table=paper_table(),
        traffic_table=traffic_table(found),
        scenes=[(scene, traffic_chart(scene), claims_of(scene)) for scene in found.scenes],
        point_chart=traffic_chart(small, found.points) if small and found.points else "",
        point_scene=small,
        map_chart=assignment_chart(found.maps) if found.maps else "",
        map_table=assignment_table(found) if found.maps else None,
        merge_table=merge_table(found.merges, found.size) if found.merges else None,
    )
