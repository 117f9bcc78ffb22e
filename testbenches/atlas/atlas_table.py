"""An atlas for people: the verdict, the map and the winners as tables."""

from __future__ import annotations

from ..support.counted import counted
from ..support.text_table import TextTable
from .atlas import Atlas
from .atlas_map import MEASURES, atlas_map, finest, winners


def headline(atlas: Atlas) -> list[str]:
    """The verdict first."""
    simulated = sum(figures["simulated"] is not None for figures in atlas.figures.values())
    checked = sum(figures["node_check"] is not None for figures in atlas.figures.values())
    lines = [f"FAILED: {line}" for line in atlas.differences]
    lines.append(f"{counted(len(atlas.figures), 'point')}, {len(atlas.figures) - simulated:,} by "
                 "the models"
                 + (f", {simulated:,} in RTL, every picture as golden" if simulated else "")
                 + (f"; {atlas.recalled:,} remembered" if atlas.recalled else ""))
    if checked:
        lines.append(f"one node of {counted(checked, 'large cage')} in RTL, its picture, fragments "
                     "and pixels as the models have them")
    lines += [f"{MEASURES[name].best}: " + ", ".join(
        f"{kind} {'once' if number == 1 else f'{number:,} times'}"
        for kind, number in counts.items())
        for name, counts in winners(atlas).items()]
    return lines


def tables(atlas: Atlas) -> list[TextTable]:
    """Of each measure the best cage in each cell of the map, and the checked nodes."""
    precision = finest(atlas)
    found = [TextTable(
        f"{MEASURES[name].best}, {MEASURES[name].unit}, {precision} fraction bits",
        ("scene", "size", "elements", "best", MEASURES[name].unit, "next kind"),
        tuple((cell.scene, "{}x{}".format(*cell.size), str(cell.elements),
               place.best.point.cage.label, f"{place.best.figure:,}",
               "-" if place.ahead is None else f"{place.second} x {place.ahead:.2f}")
              for cell, place in cells.items()))
        for name, cells in atlas_map(atlas).items()]
    checks = node_checks(atlas)
    return [*found, checks] if checks.rows else found


def node_checks(atlas: Atlas) -> TextTable:
    """Of each checked node the models' figures, and those of RTL."""
    rows = []
    for point, figures in atlas.figures.items():
        check = figures["node_check"]
        if check is None:
            continue
        both = [check.get(name) for name in ("fragments", "pixels_in", "clocks", "merge")]
        rows.append((point.scene.name, "{}x{}".format(*point.scene.size), point.cage.label,
                     f"{check['node']} of {check['nodes']}", f"{check['triangles']:,}",
                     *("-" if each is None else f"{each['model']:,} / {each['rtl']:,}"
                       for each in both)))
    return TextTable("one node of a large cage, by the models / in RTL",
                     ("scene", "size", "cage", "node", "triangles", "fragments", "pixels in",
                      "clocks", "merge"), tuple(rows))
