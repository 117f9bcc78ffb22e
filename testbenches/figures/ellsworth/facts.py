"""The figures of the page as plain numbers, lists and words: ``ellsworth.json``."""

from __future__ import annotations

from dataclasses import asdict
from typing import Any

from .claims import claims_of, claims_of_overlap, summary
from .dealing.cures import CURES
from .dealing.dealing_job import HOW
from .dealing.model_dealing import ModelDealing
from .dealing.screen_grids import RATIOS
from .ellsworth import Ellsworth
from .findings import best_cure, cure_gain, findings
from .frame_time import (
    COSTS,
    SENDING,
    best_ratio,
    best_where_sending_costs,
    mean_times,
    relative_times,
)
from .frame_time import RATIOS as TIMED_RATIOS

#: What ``cardcage figures`` calls the paper.
PAPER = "ellsworth"


def ellsworth_facts(found: Ellsworth) -> dict[str, Any]:
    """The names are part of the command line's contract: add to them, do not change them.

    ``paper`` ``command_line`` ``size``
    ``equal`` ``differences``   whether machines did as the golden models say, and lines where not
    ``processors`` ``ratios``   along figure 4, and its curves
    ``models``     of each: model, scene, frames, turn, zoom; means of the frames: facing,
                   triangles (that may cover a pixel), fragments, box; ``overlap`` by the number of
                   regions; ``utilisation``: by what the table is made of and ratio, along the
                   processors; ``relative_time``: by processors, along ``timed_ratios``, and
                   mean_times of these; best_ratio; best_ratio_by_sending: along ``sending``;
                   ``claims``: claim, came_out, numbers
    ``costs`` ``timed_ratios`` ``sending``   of figure 5
    ``overlaps``   side, regions, columns, rows, region, box, measured, expected,
                   expected_of_centres
    ``cures``      name, needs, gain (of utilisation, the mean of all), utilisation: of each model
                   by processors
    ``best_cure`` ``best_cure_of_counters``  names
    ``points``     measured in RTL: model, processors, columns, rows, ratio, utilisation and
                   golden's of each frame, the first by the static table, the others by the last
                   frame's clocks; differences, equal
    ``claims``     of all models together: claim, scenes (how many), failed (which), came_out;
                   ``overlap_claims`` of triangles of any scene
    ``findings``   lines
    ``wall_seconds``
    """
    cured = any(model.cure_processors for model in found.models)
    return {
        "paper": PAPER,
        "command_line": found.command_line,
        "size": list(found.size),
        "equal": not found.differences,
        "differences": found.differences,
        "processors": found.models[0].processors,
        "ratios": list(RATIOS),
        "models": [_model(model) for model in found.models],
        "costs": asdict(COSTS),
        "timed_ratios": list(TIMED_RATIOS),
        "sending": list(SENDING),
        "overlaps": [asdict(each) | {
            "regions": each.regions, "expected": each.expected,
            "expected_of_centres": each.expected_of_centres} for each in found.overlaps],
        "cures": [{"name": cure.name, "needs": cure.needs,
                   "gain": cure_gain(found.models, cure), "utilisation": {
                       model.model.name: {str(each): model.cured(cure.name, each)
                                          for each in model.cure_processors}
                       for model in found.models}} for cure in CURES] if cured else [],
        "best_cure": best_cure(found.models).name if cured else None,
        "best_cure_of_counters": best_cure(found.models, "counters").name if cured else None,
        "points": [asdict(point) | {"ratio": point.ratio, "equal": not point.differences}
                   for point in found.points],
        "claims": [asdict(claim) | {"came_out": claim.came_out}
                   for claim in summary(found.models, found.overlaps)],
        "overlap_claims": [asdict(verdict) for verdict in claims_of_overlap(found.overlaps)],
        "findings": findings(found.models),
        "wall_seconds": found.wall_seconds,
    }


def _model(model: ModelDealing) -> dict[str, Any]:
    return {
        "model": model.model.name, "scene": model.model.scene, "frames": model.model.frames,
        "turn": model.model.turn, "zoom": model.model.zoom, "facing": model.given,
        "triangles": model.drawn, "fragments": model.fragments, "box": list(model.box),
        "overlap": {regions: model.overlap(int(regions)) for regions in model.found["visits"]},
        "utilisation": {how: {str(ratio): model.curve(ratio, how) for ratio in RATIOS}
                        for how in HOW},
        "relative_time": {str(each): times for each, times in relative_times(model).items()},
        "mean_times": mean_times(model),
        "best_ratio": best_ratio(model),
        "best_ratio_by_sending": [best_where_sending_costs(model, factor) for factor in SENDING],
        "claims": [asdict(verdict) for verdict in claims_of(model)],
    }
