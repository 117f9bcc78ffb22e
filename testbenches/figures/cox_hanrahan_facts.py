"""The figures of the page as plain numbers, lists and words: ``cox-hanrahan.json``."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import asdict
from typing import Any

from .assignments.assignment import ROUND_ROBIN
from .assignments.frame_times import AssignmentTimes, mean_times
from .claims import claims_of, summary
from .cox_hanrahan import CoxHanrahan
from .findings import area_of_equation_4, assignment_findings
from .merge_costs import MergeCosts
from .paper_table import contradictions, paper_rows
from .scene_traffic import NODES, SceneTraffic

#: What ``cardcage figures`` calls the paper.
PAPER = "cox-hanrahan"


def cox_hanrahan_facts(found: CoxHanrahan) -> dict[str, Any]:
    """The names are part of the command line's contract: add to them, do not change them.

    ``paper`` ``command_line`` ``size``
    ``equal`` ``differences``   whether machines did as the golden models say, and lines where not
    ``table``        of each scene: scene, source (its argument), row (of the paper's table), given,
                     triangles, mean_size, fragments, area, depth, pixels (drawn), drawn_depth
    ``paper_table``  its rows: what is printed, found_size, found_depth
    ``contradictions``  lines: what of it does not multiply out
    ``nodes``        along which the traffic is
    ``traffic``      of each scene, in pixels: least, maximum, expected (equation 4, of the pixels
                     drawn), expected_of_screen, expected_by_pixel (equation 3), expected_among (the
                     same among so many nodes); ``observed``: of each assignment sent, least, most,
                     over_least, busiest_node_share; ``claims``: claim, came_out, numbers
    ``area_of_equation_4``  a line
    ``claims``       of all scenes together: claim, scenes (how many), failed (which), came_out
    ``assignments``  maps: scene, nodes, times (assignment, keeps_order, draw, merge, in_turn,
                     overlapped, busiest, sent over the least); means: of each assignment against
                     round robin: draw, in_turn, overlapped; findings: lines
    ``merges``       cards, scene, cage (as in ``comparison.json``), merge_card (luts, mhz; None
                     where not measured), cage_luts, fragments_per_clock,
                     fragments_per_clock_and_lut
    ``points``       measured in RTL: cards, nodes, assignment, sent, golden, equal
    ``wall_seconds``
    """
    return {
        "paper": PAPER,
        "command_line": found.command_line,
        "size": list(found.size),
        "equal": not found.differences,
        "differences": found.differences,
        "table": [_row(scene) for scene in found.scenes],
        "paper_table": [asdict(row) | {"found_size": row.found_size,
                                       "found_depth": row.found_depth} for row in paper_rows()],
        "contradictions": contradictions(),
        "nodes": list(NODES),
        "traffic": [_traffic(scene) for scene in found.scenes],
        "area_of_equation_4": area_of_equation_4(),
        "claims": [asdict(claim) | {"came_out": claim.came_out} for claim in summary(found.scenes)],
        "assignments": _assignments(found.maps),
        "merges": [_merge(cost) for cost in found.merges],
        "points": [asdict(point) | {"equal": point.equal} for point in found.points],
        "wall_seconds": found.wall_seconds,
    }


def _row(scene: SceneTraffic) -> dict[str, Any]:
    return {"scene": scene.name, "source": scene.scene, "row": scene.row,
            "background": scene.background, "given": scene.given, "triangles": scene.triangles,
            "mean_size": scene.mean_size, "fragments": scene.fragments, "area": scene.area,
            "depth": scene.depth, "pixels": scene.pixels, "drawn_depth": scene.drawn_depth}


def _traffic(scene: SceneTraffic) -> dict[str, Any]:
    return {
        "scene": scene.name,
        "least": scene.pixels,
        "maximum": scene.fragments,
        "expected": scene.expected * scene.pixels,
        "expected_of_screen": scene.expected_of_screen * scene.pixels,
        "expected_by_pixel": scene.expected_by_pixel * scene.pixels,
        "expected_among": [ratio * scene.pixels for ratio in scene.expected_among],
        "observed": {curve.assignment: {
            "sent": list(curve.sent), "least": list(curve.least), "most": list(curve.most),
            "over_least": [scene.ratio(sent) for sent in curve.sent],
            "busiest_node_share": list(curve.busiest)} for curve in scene.curves},
        "claims": [asdict(verdict) for verdict in claims_of(scene)],
    }


def _assignments(maps: Sequence[AssignmentTimes]) -> dict[str, Any]:
    means = mean_times(maps, ROUND_ROBIN) if maps else {}
    return {
        "maps": [{"scene": each.scene, "nodes": each.nodes, "times": [
            asdict(time) | {"in_turn": time.in_turn, "overlapped": time.overlapped}
            for time in each.times]} for each in maps],
        "means": {name: mean._asdict() for name, mean in means.items()},
        "findings": assignment_findings(maps),
    }


def _merge(cost: MergeCosts) -> dict[str, Any]:
    return {"cards": cost.cage.cards, "scene": cost.scene, "cage": cost.facts,
            "merge_card": None if cost.board is None else asdict(cost.board),
            "cage_luts": cost.cage_luts, "fragments_per_clock": cost.fragments_per_clock,
            "fragments_per_clock_and_lut": cost.per_lut}
