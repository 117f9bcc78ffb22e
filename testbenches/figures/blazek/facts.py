"""The figures of the page as plain numbers, lists and words: ``blazek.json``."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import asdict
from typing import Any

from .blazek import Blazek
from .claims import Methods, claims_of, claims_of_all, summary
from .findings import findings
from .his_machine.costs import COSTS
from .his_machine.his_claims import his_claims_of, his_summary, polygons_claim
from .his_machine.sensitivity import axis_of
from .our_machine.in_rtl import Point
from .scenes.speed_ups import SpeedUps
from .scenes.spheres import NODES, SPHERES
from .slips import slips

#: What ``cardcage figures`` calls the paper.
PAPER = "blazek"


def blazek_facts(found: Blazek) -> dict[str, Any]:
    """The names are part of the command line's contract: add to them, do not change them.

    ``paper`` ``command_line`` ``size``
    ``equal`` ``differences``   whether machines did as the golden models say, and lines where not
    ``nodes`` ``spheres``       along which all is listed
    ``his`` ``ours``   by method: ``time``, in seconds or clocks, ``merging`` of it, ``speed_up``
                       and ``efficiency``, a list by spheres of lists by nodes; of ours also
                       ``words`` of 32 bits on the host link, the mesh loaded anew
    ``costs``          of his machine, in seconds or bytes
    ``sensitivity``    axis, unit, usual, values, and speed_up by method along these
    ``points``         measured in RTL: decomposition, nodes, spheres, drawing, merging,
                       model_drawing, model_merging, off, equal
    ``claims``         of each machine: claim, scenes (how many), failed (which), came_out
    ``claims_by_spheres``   of each machine, by number of spheres: claim, came_out, numbers
    ``claims_of_all``  of each machine, those that are asked once: claim, scene, came_out, numbers
    ``slips``          printed, why, taken
    ``findings``       lines
    ``wall_seconds``
    """
    his, ours = Methods(found.times), Methods(found.clocks)
    return {
        "paper": PAPER,
        "command_line": found.command_line,
        "size": list(found.size),
        "equal": not found.differences,
        "differences": found.differences,
        "nodes": list(NODES),
        "spheres": list(SPHERES),
        "his": _curves(found.times),
        "ours": {name: facts | {"words": _rows(found.clocks[name].words)}
                 for name, facts in _curves(found.clocks).items()},
        "costs": asdict(COSTS),
        "sensitivity": [
            {"axis": each.axis, "unit": axis_of(each.axis).unit, "usual": axis_of(each.axis).usual,
             "values": list(axis_of(each.axis).values), "speed_up": each.speed_up}
            for each in found.sensitivity],
        "points": [_point(point) for point in found.points],
        "claims": {
            "his": [asdict(claim) | {"came_out": claim.came_out} for claim in (
                *summary(his), *his_summary(found.times, found.size))],
            "ours": [asdict(claim) | {"came_out": claim.came_out} for claim in summary(ours)]},
        "claims_by_spheres": {
            "his": {str(spheres): [asdict(verdict) for verdict in (
                *claims_of(his, spheres), *his_claims_of(found.times, found.size, spheres))]
                for spheres in SPHERES},
            "ours": {str(spheres): [asdict(verdict) for verdict in claims_of(ours, spheres)]
                     for spheres in SPHERES}},
        "claims_of_all": {
            "his": [asdict(verdict) for verdict in (
                *claims_of_all(his), polygons_claim(found.size))],
            "ours": [asdict(verdict) for verdict in claims_of_all(ours)]},
        "slips": [asdict(slip) for slip in slips()],
        "findings": findings(found.sensitivity, found.clocks, found.points, found.size),
        "wall_seconds": found.wall_seconds,
    }


def _curves(methods: Mapping[str, SpeedUps]) -> dict[str, dict[str, Any]]:
    return {name: {"time": _rows(method.time), "merging": _rows(method.merging),
                   "speed_up": _rows(method.speed_up), "efficiency": _rows(method.efficiency)}
            for name, method in methods.items()}


def _rows(value: Callable[[int, int], float]) -> list[list[float]]:
    return [[value(spheres, nodes) for nodes in NODES] for spheres in SPHERES]


def _point(point: Point) -> dict[str, Any]:
    return asdict(point) | {"off": point.off}
