"""A comparison of cages for people: tables on a terminal, aligned lines elsewhere."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import astuple
from itertools import groupby

from ...golden.organisations.organisation_of import organisation_of
from ..frames.object_figures import ObjectFigures
from ..frames.region_figures import RegionFigures
from ..support.counted import counted
from ..support.text_table import TextTable, print_tables, tables_text
from .cage import CageRun
from .compare_cages import CageComparison
from .node_sweep import Curve
from .view_spread import spreads

#: What is told only of several views.
OF_VIEWS = "over all views: least / mean / greatest"

#: What is told only where some cage has regions.
OF_REGIONS = "regions dealt out"

#: What is told only where some cage makes triangles of objects.
OF_OBJECTS = "objects"

#: Stands for a figure that a cage does not have.
NOTHING = "-"

#: Who makes the triangles of objects.
_PLACES: dict[str | None, str] = {
    None: "the host", "controller": "the controller", "nodes": "nodes", "elements": "elements"}

#: The rows of the table, under their headings.
Rows = dict[str, Callable[[CageRun], str]]


def _latency(name: str) -> Callable[[CageRun], str]:
    return lambda run: NOTHING if run.latency is None else f"{getattr(run.latency, name):,}"


def _sent(figure: Callable[[CageRun], int]) -> Callable[[CageRun], str]:
    return lambda run: f"{figure(run):,}" if run.configuration.merge else NOTHING


def _of_regions(figure: Callable[[RegionFigures], str]) -> Callable[[CageRun], str]:
    return lambda run: NOTHING if run.regions is None else figure(run.regions)


def _of_objects(figure: Callable[[ObjectFigures], str]) -> Callable[[CageRun], str]:
    return lambda run: NOTHING if run.objects is None else figure(run.objects)


def _cells(name: str) -> Callable[[CageRun], str]:
    return lambda run: NOTHING if run.cells is None else f"{run.cells[name]:,}"


def _spread(name: str, form: str = "{:,.0f}") -> Callable[[CageRun], str]:
    """Least, mean and greatest over all views."""
    def figure(run: CageRun) -> str:
        if not run.views or (name == "pixels_sent" and not run.configuration.merge):
            return NOTHING
        return " / ".join(form.format(number) for number in astuple(spreads(run.views)[name]))

    return figure


FIGURES: dict[str, Rows] = {
    "clocks": {
        "load the lists, once": lambda run: (NOTHING if run.clocks.load is None
                                             else f"{run.clocks.load:,}"),
        "draw": lambda run: f"{run.clocks.draw:,}",
        "merge": lambda run: f"{run.clocks.merge:,}",
        "a frame": lambda run: f"{run.clocks.frame:,}",
        "which is bound by": lambda run: run.bound_by,
    },
    "clocks from the last triangle": {
        "until the picture is complete": _latency("merged"),
        "until its pixel is on the pins": _latency("pins"),
    },
    "work": {
        "fragments": lambda run: f"{run.fragments:,}",
        "of the busiest node": lambda run: f"{100 * run.busiest_share:.1f} %",
    },
    OF_REGIONS: {
        "utilisation, as counted": _of_regions(lambda regions: f"{regions.utilisation:.1%}"),
        "of the busiest element": _of_regions(
            lambda regions: f"{int(regions.loads.max()):,} {regions.counted}"),
    },
    OF_OBJECTS: {
        "their triangles are made in": lambda run: _PLACES[run.configuration.objects],
        "triangles made": _of_objects(
            lambda objects: f"{sum(each.made for each in objects.golden):,}"),
        "triangles made at the busiest place": _of_objects(
            lambda objects: f"{max(each.made for each in objects.golden):,}"),
        "triangles dropped in set-up": _of_objects(
            lambda objects: f"{sum(each.dropped for each in objects.golden):,}"),
        "words on the host link, meshes or lists included": lambda run: f"{run.link_words:,}",
    },
    "sent between nodes": {
        "pixels": _sent(lambda run: run.traffic.pixels),
        "pixels on the busiest link": _sent(lambda run: run.traffic.busiest_piece),
        "bits": _sent(lambda run: run.traffic.bits),
        "bits on the busiest link": _sent(
            lambda run: run.traffic.busiest_piece * run.traffic.pixel_bits),
    },
    OF_VIEWS: {
        "clocks to draw": _spread("draw"),
        "clocks to merge": _spread("merge"),
        "fragments of a view": _spread("fragments"),
        "of its busiest node": _spread("busiest_node_share", "{:.1%}"),
        "pixels sent for it": _spread("pixels_sent"),
    },
    "memory": {"bits": lambda run: f"{run.memory_bits:,}"},
    "cells": {
        "flip-flops": _cells("flip_flops"),
        "gates": _cells("gates"),
        "multiplier bits": _cells("multipliers"),
    },
}


def figures(comparison: CageComparison) -> dict[str, list[tuple[str, list[str]]]]:
    """Heading → rows, of each its name and a figure for each cage."""
    left_out = set()
    if all(run.cells is None for run in comparison.runs):
        left_out.add("cells")
    if not any(run.views for run in comparison.runs):
        left_out.add(OF_VIEWS)
    if all(run.regions is None for run in comparison.runs):
        left_out.add(OF_REGIONS)
    if all(run.objects is None for run in comparison.runs):
        left_out.add(OF_OBJECTS)
    return {heading: [(name, [figure(run) for run in comparison.runs])
                      for name, figure in rows.items()]
            for heading, rows in FIGURES.items() if heading not in left_out}


def tables(comparison: CageComparison) -> list[TextTable]:
    """The figures, and the speed-ups of the sweep."""
    found = []
    if comparison.runs:
        found.append(TextTable(
            "the cages", ("", *(run.cage.label for run in comparison.runs)),
            tuple(row for heading, rows in figures(comparison).items() for row in (
                (heading, *[""] * len(comparison.runs)),
                *((f"  {name}", *words) for name, words in rows)))))
    for growing, curves in groupby(comparison.curves, lambda curve: curve.growing):
        found.append(speed_ups(list(curves), growing))
    return found


def speed_ups(curves: list[Curve], growing: bool) -> TextTable:
    """Of one kind of scene: a line for each kind of cage, simulated beside the model's."""
    nodes = sorted({point.place.nodes for curve in curves for point in curve.points})
    rows = []
    for curve in curves:
        cells = dict.fromkeys(nodes, NOTHING)
        for point, model, simulated in curve.speed_ups():
            cells[point.place.nodes] = f"{model:.2f}" + (
                "" if simulated is None else f" ({simulated:.2f})")
        rows.append((curve.label, *cells.values()))
    scene = "a scene that grows with the machine" if growing else "the scene as it is"
    return TextTable(f"speed-up, {scene}: by the cycle model (simulated)",
                     ("nodes", *map(str, nodes)), tuple(rows))


def headline(comparison: CageComparison) -> list[str]:
    """The verdict first."""
    runs = comparison.runs
    on_all = f"all {len(runs)} cages" if len(runs) > 1 else "the one cage"
    if not comparison.equal:
        lines = [f"DIFFERENT: {line}" for line in comparison.differences]
    elif comparison.identical:
        compared = runs[0].comparison
        lines = [f"identical on {on_all}: {compared.pixels_compared:,} colours and "
                 f"{compared.depths_compared:,} depths, all fragments, all pixels sent"]
    else:
        lines = [f"each as its golden picture, but {len(comparison.pictures)} pictures: "
                 + "; ".join(_picture(group) for group in comparison.pictures)]
    if any(run.views for run in runs):
        views = len(next(run.views for run in runs if run.views))
        lines.append(f"{counted(views, 'view')} of it on each, compared likewise; figures are of "
                     "the first, but for those of all")
    listed = comparison.scene.display_list
    return [*lines, f"{comparison.scene.name}: {counted(listed.triangles, 'triangle')} at "
            f"{listed.width}x{listed.height}"]


def _picture(group: list[CageRun]) -> str:
    width, height, *_ = organisation_of(group[0].configuration).resolution
    return f"{width}x{height} on {', '.join(run.cage.label for run in group)}"


def comparison_text(comparison: CageComparison) -> str:
    """Plain lines, the columns aligned."""
    return tables_text(headline(comparison), tables(comparison))


def comparison_table(comparison: CageComparison) -> None:
    """The same as tables on the terminal."""
    print_tables(headline(comparison), tables(comparison))
