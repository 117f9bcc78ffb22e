"""Writes the report of a rendering: one page, one JSON file, pictures, the display list."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

from ...golden.organisations.organisation_of import organisation_of
from ...golden.reference.exact import depth_complexity
from ..engines.activity_record import ACTIVITY_KINDS
from ..frames.rendering import Rendering
from ..support.any_characters import readable
from .activity_chart import activity_chart, timeline_chart
from .card_groups import card_groups
from .frame_facts import DISPLAY_LIST, report_facts
from .frame_pictures import color_difference, data_uri, depth_difference, depth_pictures, png
from .page import page_environment
from .region_pictures import load_chart, region_picture
from .work_chart import work_chart

#: About as wide as a picture is on the page.
PAGE_PICTURE_PIXELS = 320

#: Everything that ``write_report`` writes.
REPORT_FILES = ("report.html", "report.json", "rtl.png", "golden.png", "difference.png",
                DISPLAY_LIST)


def write_report(rendering: Rendering, folder: Path) -> None:
    """Write ``REPORT_FILES`` to ``folder``, which exists."""
    facts = report_facts(rendering)
    write_files(rendering, folder, facts, report_page(rendering, facts))


def write_files(rendering: Rendering, folder: Path, facts: dict[str, Any], page: str) -> None:
    """``REPORT_FILES`` with these facts and that page."""
    (folder / "report.json").write_text(json.dumps(facts, indent=2) + "\n", encoding="utf-8")
    (folder / "rtl.png").write_bytes(png(rendering.simulation.video))
    (folder / "golden.png").write_bytes(png(rendering.comparison.expected))
    (folder / "difference.png").write_bytes(png(color_difference(rendering)))
    rendering.scene.display_list.save(folder / DISPLAY_LIST)
    (folder / "report.html").write_text(readable(page), encoding="utf-8")


def report_page(rendering: Rendering, facts: dict[str, Any], template: str = "report.html",
                **more: Any) -> str:
    """The page, complete in itself: pictures and chart are inside it; ``more`` is for a template
    that extends this one."""
    environment = page_environment()
    environment.filters["hexadecimal"] = _hexadecimal
    # A picture larger than its place loses pixels there: a lone red one must not be among them.
    reach = max(rendering.simulation.video.shape) // PAGE_PICTURE_PIXELS
    rows = [("Colour", "from the video pins", data_uri(rendering.simulation.video),
             data_uri(rendering.comparison.expected),
             data_uri(color_difference(rendering, reach)))]
    if rendering.simulation.depth is not None:
        machine_depth, golden_depth = depth_pictures(rendering)
        rows.append(("Depth", "read back, near is light", data_uri(machine_depth),
                     data_uri(golden_depth), data_uri(depth_difference(rendering, reach))))
    return environment.get_template(template).render(
        facts,
        rows=rows,
        **more,
        chart=work_chart(rendering.simulation.work),
        activity_charts=_activity_charts(rendering),
        region_pictures=_region_pictures(rendering, facts),
        activity_kinds=ACTIVITY_KINDS,
        groups=card_groups(rendering.configuration),
        display_list=_display_list_facts(rendering),
        exact=_is_exact(rendering),
    )


def _activity_charts(rendering: Rendering) -> list[str]:
    record = rendering.simulation.activity
    return [] if record is None else [activity_chart(record), timeline_chart(record)]


def _region_pictures(rendering: Rendering, facts: dict[str, Any]) -> list[str]:
    """Who drew which region, and the work of each."""
    if rendering.regions is None:
        return []
    return [data_uri(region_picture(rendering.regions, rendering.simulation.video)),
            load_chart(facts["regions"])]


def _is_exact(rendering: Rendering) -> bool:
    return rendering.configuration.fraction_bits >= rendering.comparison.exact_fraction_bits


def _display_list_facts(rendering: Rendering) -> dict[str, Any]:
    display_list = rendering.scene.display_list
    organisation = organisation_of(rendering.configuration)
    complexity = depth_complexity(display_list, **organisation.resolution.shifts)
    covered = int((complexity > 0).sum())
    return {
        "coordinate_bits": display_list.coordinate_bits,
        "sub_bits": display_list.sub_bits,
        "colors": "one colour a triangle" if display_list.flat else "a colour at each vertex",
        "background": display_list.background,
        "covered": covered,
        "pixels": complexity.size,
        "mean_complexity": complexity.sum() / covered if covered else 0.0,
        "greatest_complexity": int(complexity.max(initial=0)),
    }


def _hexadecimal(color: tuple[int, int, int]) -> str:
    return "#{:02x}{:02x}{:02x}".format(*color)
