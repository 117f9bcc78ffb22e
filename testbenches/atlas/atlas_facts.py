"""An atlas as plain numbers, lists and words: ``atlas.json``, and its points as ``atlas.csv``."""

from __future__ import annotations

import csv
import io
from collections.abc import Iterator
from typing import Any

from .atlas import Atlas
from .atlas_map import atlas_map, kind_of, winners
from .points.atlas_point import AtlasPoint, Figures


def atlas_facts(atlas: Atlas) -> dict[str, Any]:
    """Everything the page tells.

    The names are part of the command line's contract: add to them, do not change them.

    ``command_line`` ``wall_seconds`` ``warnings``
    ``differences``  lines, of points whose machine, picture or process is wrong
    ``recalled``     points that were measured before
    ``map``          of each of fastest, least_memory, least_traffic, smallest a list of objects:
                     scene, size, elements, precision; best, kind, figure of the best cage; second,
                     the best of the other kinds, ahead, how many times as much it has, or None;
                     ranked, of all cages label and figure
    ``winners``      of each measure: kind, and in how many cells of the map it is the best
    ``points``       a list of objects, in the order asked for:

        ``scene`` ``size`` ``cage`` (label) ``cards`` ``retained`` ``regions`` ``objects_in``
        (where it makes triangles of objects: nodes, elements, controller; None: it is sent
        triangles) ``kind`` ``fraction_bits`` (as asked for)
        ``machine``      organisation, elements, nodes, memory_units, fraction_bits, triangle_bits,
                         pixel_bits (of a pixel that is sent)
        ``source``       model or rtl: who says draw and merge
        ``triangles`` ``fragments``
        ``draw`` ``merge``  clocks; ``work``, of a frame of many, without the wait for a scan;
        ``scan``         clocks of a scan, ``scans``, how many whole ones a frame lasts
        ``limit``        what takes longest: broadcast, busiest element, memory ports, waiting,
                         merge, set-up; ``bounds``, clocks that each of them takes at least
        ``memory``       bits: pictures, lists, meshes, maps, frame_units, queues, tables;
                         ``memory_bits``
        ``cells``        flip-flops, gates and partial products of all boards, by the fit to
                         counted ones
        ``traffic``      bits of a picture: host, nodes (pixels, or objects that elements pass on),
                         all, and on the busiest_link; once, those of lists or meshes that are
                         loaded before the first picture, which all leaves out
        ``error``        bound in LSB; pixels, wrong_pixels, depth_maximum, depth_mean,
                         depth_anywhere, color_maximum, against the exact picture
        ``simulated``    None, or engine, frame, load, model (its draw, merge, work, memory_bits),
                         pixels_compared, depths_compared, fragments, pixels_sent, seconds
        ``node_check``   None, or node, nodes, elements, of_node (its elements), triangles, engine,
                         pixels_compared; and model and rtl of fragments, clocks, pixels_in and, of
                         a tree, merge

    ``failures``     objects: scene, size, cage, fraction_bits, reason, failed (False: there can be
                     no such machine)
    """
    return {
        "command_line": atlas.command_line,
        "wall_seconds": atlas.wall_seconds,
        "warnings": list(atlas.warnings),
        "differences": atlas.differences,
        "recalled": atlas.recalled,
        "winners": winners(atlas),
        "map": {name: [{
            "scene": cell.scene, "size": list(cell.size), "elements": cell.elements,
            "precision": cell.precision, "best": place.best.point.cage.label,
            "kind": place.best.kind, "figure": place.best.figure,
            "second": place.second, "ahead": place.ahead,
            "ranked": [{"cage": each.point.cage.label, "figure": each.figure}
                       for each in place.ranked],
        } for cell, place in cells.items()] for name, cells in atlas_map(atlas).items()},
        "points": [_asked(point) | figures for point, figures in atlas.figures.items()],
        "failures": [_asked(point) | {"reason": failure.reason, "failed": failure.failed}
                     for point, failure in atlas.failures.items()],
    }


def _asked(point: AtlasPoint) -> dict[str, Any]:
    cage = point.cage
    return {"scene": point.scene.name, "size": list(point.scene.size), "cage": cage.label,
            "cards": cage.cards, "retained": cage.retained,
            "regions": None if cage.regions is None else list(cage.regions),
            "objects_in": cage.objects, "kind": kind_of(cage), "fraction_bits": point.fraction_bits}


def atlas_csv(atlas: Atlas) -> str:
    """A line for each point that has figures; what is an object in ``atlas.json`` is a column for
    each of its numbers, with a dot between the names."""
    rows = [dict(_flat(_asked(point) | figures)) for point, figures in atlas.figures.items()]
    columns = list(dict.fromkeys(name for row in rows for name in row))
    text = io.StringIO()
    writer = csv.DictWriter(text, columns, restval="", lineterminator="\n")
    writer.writeheader()
    writer.writerows(rows)
    return text.getvalue()


def _flat(facts: Figures, before: str = "") -> Iterator[tuple[str, Any]]:
    for name, value in facts.items():
        if isinstance(value, dict):
            yield from _flat(value, f"{before}{name}.")
        elif isinstance(value, list):
            yield before + name, "x".join(map(str, value))
        elif value is not None:
            yield before + name, value
