"""Writes an atlas: one page, JSON, CSV, and the map as a picture."""

from __future__ import annotations

import base64
import io
import json
from pathlib import Path
from typing import Any

from ..reports.page import chart_style, page_environment, svg_element
from ..support.any_characters import readable
from ..support.measurement_cache import measured_once, package_hash
from .atlas import Atlas
from .atlas_facts import atlas_csv, atlas_facts
from .atlas_map import finest
from .atlas_table import headline, node_checks, tables

#: Everything that ``write_atlas`` writes.
ATLAS_FILES = ("atlas.html", "atlas.json", "atlas.csv", "atlas.png")

PICTURE_DPI = 110
PICTURE_COLORS = 64


def write_atlas(atlas: Atlas, folder: Path) -> None:
    """Write ``ATLAS_FILES`` to ``folder``, which exists."""
    facts = atlas_facts(atlas)
    charts = _charts(atlas, facts)
    (folder / "atlas.json").write_text(json.dumps(facts, indent=1) + "\n", encoding="utf-8")
    (folder / "atlas.csv").write_text(atlas_csv(atlas), encoding="utf-8")
    (folder / "atlas.png").write_bytes(base64.b64decode(charts["png"]))
    (folder / "atlas.html").write_text(readable(atlas_page(atlas, facts, charts)),
                                       encoding="utf-8")


def atlas_page(atlas: Atlas, facts: dict[str, Any], charts: dict[str, str]) -> str:
    """The page, complete in itself."""
    return page_environment().get_template("atlas.html").render(
        facts, headline=headline(atlas), precision=finest(atlas), charts=charts,
        tables=tables(atlas), checks=node_checks(atlas))


def _charts(atlas: Atlas, facts: dict[str, Any]) -> dict[str, str]:
    """Each as an ``<svg>`` element, and ``png``, the map in base64; kept, since whoever asks again
    for points that are known would wait for little else."""
    shown = {name: facts[name] for name in ("map", "points")}
    asked = repr((atlas.options.sizes, atlas.options.fraction_bits, atlas.options.asked_cages()))
    return measured_once(["atlas charts", package_hash(), asked, json.dumps(shown)],
                         lambda: _drawn(atlas))


def _drawn(atlas: Atlas) -> dict[str, str]:
    # They take a second to load.
    from PIL import Image

    from .charts import error_figure, limits_figure, map_figure

    with chart_style():
        found = {"map": svg_element(map_figure(atlas), "The best kind of cage by four measures"),
                 "limits": svg_element(limits_figure(atlas), "What limits each cage"),
                 "error": ""}
        error = error_figure(atlas)
        if error is not None:
            found["error"] = svg_element(error, "Speed against error")
        drawn, picture = io.BytesIO(), io.BytesIO()
        map_figure(atlas).savefig(drawn, format="png", dpi=PICTURE_DPI, facecolor="white")
    # Few colours: a quarter of the bytes.
    Image.open(drawn).convert("RGB").quantize(PICTURE_COLORS).save(picture, "PNG", optimize=True)
    return found | {"png": base64.b64encode(picture.getvalue()).decode()}
