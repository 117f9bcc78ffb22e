"""The figures of a sequence of pictures, as plain numbers, lists and words: ``report.json``."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from ...golden.scenes.camera import View
from ..frames.rendering import Rendering
from ..sequence.sequence_run import SequenceFrame
from .frame_facts import report_facts
from .object_facts import object_summary
from .region_facts import region_summary


def sequence_facts(rendering: Rendering, frames: Sequence[SequenceFrame], views: Sequence[View]
                   ) -> dict[str, Any]:
    """What the report of one picture tells, of ``rendering``, with the verdict on all of them, and
    under ``frames`` the figures of each."""
    facts = report_facts(rendering)
    facts["replay"] = rendering.command_line  # the display list is of one picture
    comparisons = [frame.comparison for frame in frames]
    facts["equal"] = all(frame.equal for frame in frames)
    facts["pixels"] |= {
        "compared": sum(each.pixels_compared for each in comparisons),
        "different": sum(each.pixels_different for each in comparisons)}
    facts["depth"] |= {
        "compared": sum(each.depths_compared for each in comparisons),
        "different": sum(each.depths_different for each in comparisons),
        "max_error_lsb": max(each.depth_max_error for each in comparisons)}
    facts["color"] = {"max_error": max(each.color_max_error for each in comparisons)}
    return facts | {"picture": next(frame.number for frame in frames
                                    if frame.simulation is rendering.simulation),
                    "frames": _frames(frames, views)}


def _frames(frames: Sequence[SequenceFrame], views: Sequence[View]) -> list[dict[str, Any]]:
    before = [None, *frames[:-1]]
    return [_frame(frame, view, last) for frame, view, last in zip(frames, views, before,
                                                                  strict=True)]


def _frame(frame: SequenceFrame, view: View, before: SequenceFrame | None) -> dict[str, Any]:
    simulation, comparison = frame.simulation, frame.comparison
    work = simulation.work
    fragments = sum(element.fragments for element in work)
    return {
        "number": frame.number,
        "view": None if view.direction is None else list(view.direction),
        "zoom": view.zoom,
        "equal": frame.equal,
        "pixels_different": comparison.pixels_different,
        "depths_compared": comparison.depths_compared,
        "depths_different": comparison.depths_different,
        "triangles": frame.triangles,
        # Of a picture whose counters were not read, nobody knows.
        "fragments": fragments if work else None,
        "draw": simulation.draw_cycles,
        "merged": simulation.merge_cycles,
        "shown": frame.shown,
        # From the picture before to this one, as the machine said that each is shown.
        "clocks": None if before is None else frame.shown - before.shown,
        "first_scan": frame.first_scan,
        "scans": frame.scans,
        "scans_before_next_start": frame.scans_before_next_start,
        "wrong_scans": frame.wrong_scans,
        "repeated_scans": simulation.repeated_scans,
        "a_picture_a_scan": before is not None and before.scans == 1,
        "efficiency": None if not work else (
            fragments / (len(work) * simulation.draw_cycles) if simulation.draw_cycles else 0.0),
        "per_pe": [{"fragments": element.fragments, "busy": element.busy_cycles}
                   for element in work],
        "sent": list(simulation.sent),
        "regions": None if frame.regions is None else region_summary(frame.regions),
        "objects": None if frame.objects is None else object_summary(frame.objects),
    }
