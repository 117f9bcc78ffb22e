"""The figures of a comparison, as plain numbers, lists and words: ``comparison.json``."""

from __future__ import annotations

from dataclasses import asdict
from typing import Any

from ...golden.organisations.machine_facts import machine_facts
from ..reports.object_facts import object_facts
from ..reports.region_facts import region_facts
from .cage import CageRun
from .compare_cages import CageComparison
from .node_sweep import Curve, FrameTime
from .view_spread import spreads


def comparison_facts(comparison: CageComparison) -> dict[str, Any]:
    """Everything the page tells but the pictures.

    The names are part of the command line's contract: add to them, do not change them.

    ``scene`` ``command_line`` ``triangles``
    ``identical``     all cages show one picture, and it and every counter are as golden
    ``equal``         each picture and every counter is as golden; with too few ``--words`` cages
                      may show pictures of different resolutions and still be equal
    ``differences``   lines, of what is not
    ``pictures``      labels of the cages that show one picture, a list for each picture
    ``cages``         a list of objects, in the order in which the cages were asked for:

        ``label`` ``cards`` ``retained`` ``objects_in`` (where the cage's own name says that
        triangles of objects are made; else None) ``machine`` (every field, and what follows from
        it)
        ``equal`` ``differences`` ``pixels`` ``depth`` (compared, different)
        ``cycles``        boot, load (None without lists), draw, merge, frame, scan; bound_by:
                          draw, merge or scan, of which a frame takes as long as one, or some
        ``latency``       triangle, pixel, merged, pins; None where nothing is seen
        ``fragments``     of a frame, ``busiest_node_share`` of them
        ``nodes``         fragments and sent of each, and what golden says
        ``traffic``       pixels, bits, busiest_link (pixels, bits), pixel_bits, links (pixels of
                          each piece between two nodes), steps (pixels of the longest send)
        ``memory``        bits in all, memories (words, bits, instances)
        ``cells``         flip_flops, gates, multipliers; None where they were not counted
        ``regions``       where they are dealt out: ``reports.region_facts``, of the frame measured;
                          else None
        ``views``         where several were asked for, how many, and the least, mean and greatest
                          draw, merge, fragments, busiest_node_share, pixels_sent; else None
        ``engine`` ``simulated_cycles`` ``seconds`` ``build_seconds``

    ``refused``       objects: label, cards, retained, regions, objects_in, reason, failed (it was
                      built, and delivered no picture)
    ``sweep``         objects, of each curve: label, cards (that repeat), retained, regions,
                      objects_in, growing (the scene does, with the nodes), points: nodes,
                      triangles, model and simulated (draw, merge, total, speed_up; simulated may be
                      None)
    ``warnings`` ``wall_seconds``
    """
    return {
        "scene": comparison.scene.name,
        "command_line": comparison.command_line,
        "triangles": comparison.scene.display_list.triangles,
        "identical": comparison.identical,
        "equal": comparison.equal,
        "differences": comparison.differences,
        "pictures": [[run.cage.label for run in group] for group in comparison.pictures],
        "cages": [cage_facts(run) for run in comparison.runs],
        "refused": [{"label": each.cage.label, "cards": each.cage.cards,
                     "retained": each.cage.retained, "regions": each.cage.regions,
                     "objects_in": each.cage.objects, "reason": each.reason, "failed": each.failed}
                    for each in comparison.refused],
        "sweep": [_curve(curve) for curve in comparison.curves],
        "warnings": comparison.warnings,
        "wall_seconds": comparison.wall_seconds,
    }


def cage_facts(run: CageRun) -> dict[str, Any]:
    compared, simulation = run.comparison, run.simulation
    return {
        "label": run.cage.label,
        "cards": run.cage.cards,
        "retained": run.cage.retained,
        "objects_in": run.cage.objects,
        "machine": machine_facts(run.configuration),
        "equal": not run.differences,
        "differences": list(run.differences),
        "pixels": {"compared": compared.pixels_compared, "different": compared.pixels_different},
        "depth": {"compared": compared.depths_compared, "different": compared.depths_different},
        "cycles": {**asdict(run.clocks), "scan": run.configuration.cycles_per_scan,
                   "bound_by": run.bound_by},
        "latency": None if run.latency is None else asdict(run.latency)
        | {"pixel": list(run.latency.pixel)},
        "fragments": run.fragments,
        "busiest_node_share": run.busiest_share,
        "nodes": [asdict(node) for node in run.nodes],
        "traffic": _traffic(run),
        "memory": {"bits": run.memory_bits,
                   "memories": [asdict(memory) for memory in run.memories]},
        "cells": run.cells,
        "regions": region_facts(run.regions),
        "objects": object_facts(run.objects),
        "link_words": run.link_words,
        "views": _views(run),
        "engine": simulation.engine,
        "simulated_cycles": simulation.cycles,
        "seconds": simulation.seconds,
        "build_seconds": simulation.build_seconds,
    }


def _views(run: CageRun) -> dict[str, Any] | None:
    if not run.views:
        return None
    return {"views": len(run.views),
            **{name: asdict(spread) for name, spread in spreads(run.views).items()}}


def _traffic(run: CageRun) -> dict[str, Any]:
    traffic = run.traffic
    return {
        "pixels": traffic.pixels,
        "bits": traffic.bits,
        "busiest_link": {"pixels": traffic.busiest_piece,
                         "bits": traffic.busiest_piece * traffic.pixel_bits},
        "pixel_bits": traffic.pixel_bits,
        "links": traffic.pieces.tolist(),
        "steps": traffic.steps,
    }


def _curve(curve: Curve) -> dict[str, Any]:
    def time(found: FrameTime | None, speed_up: float | None) -> dict[str, Any] | None:
        return None if found is None else {
            "draw": found.draw, "merge": found.merge, "total": found.total, "speed_up": speed_up}

    return {
        "label": curve.label,
        "cards": curve.piece,
        "retained": curve.retained,
        "regions": curve.regions,
        "objects_in": curve.objects,
        "growing": curve.growing,
        "points": [{"nodes": point.place.nodes, "triangles": point.triangles,
                    "model": time(point.model, model),
                    "simulated": time(point.simulated, simulated)}
                   for point, model, simulated in curve.speed_ups()],
    }
