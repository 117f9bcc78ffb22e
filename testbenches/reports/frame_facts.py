"""The figures of a rendering, as plain numbers, lists and words: ``report.json``."""

from __future__ import annotations

from typing import Any

from ...golden.merging.direct import DirectTraffic
from ...golden.organisations.machine_facts import machine_facts
from ..engines.activity_record import ACTIVITY_KINDS, ActivityRecord
from ..frames.compare import FirstDifference, PixelValue
from ..frames.rendering import Rendering
from ..frames.responses import Simulation
from .object_facts import object_facts
from .region_facts import region_facts

#: What was drawn, for replay.
DISPLAY_LIST = "display_list.npz"


def report_facts(rendering: Rendering) -> dict[str, Any]:
    """Everything the report tells but the pictures.

    The names are part of the command line's contract: add to them, do not change them.
    """
    simulation, comparison = rendering.simulation, rendering.comparison
    return {
        "equal": comparison.equal,
        "scene": rendering.scene.name,
        "command_line": rendering.command_line,
        "replay": _replay(rendering),
        "pixels": {
            "compared": comparison.pixels_compared,
            "different": comparison.pixels_different,
            "orphans": int(comparison.color_orphans.sum()),
        },
        "depth": {
            "compared": comparison.depths_compared,
            "different": comparison.depths_different,
            "orphans": int(comparison.depth_orphans.sum()),
            "max_error_lsb": comparison.depth_max_error,
        },
        "color": {"max_error": comparison.color_max_error},
        "machine": _machine(rendering),
        "triangles": rendering.scene.display_list.triangles,
        "fragments": rendering.fragments,
        "cycles": {
            "boot": simulation.boot_cycles,
            "draw": simulation.draw_cycles,
            "merged": simulation.merge_cycles,
            "total": simulation.cycles,
        },
        "efficiency": rendering.efficiency,
        "repeated_scans": simulation.repeated_scans,
        "per_pe": [
            {"node": work.node, "first_unit": work.first_unit, "units": work.units,
             "fragments": work.fragments, "busy": work.busy_cycles}
            for work in simulation.work
        ],
        "merging": merging_facts(rendering),
        "regions": region_facts(rendering.regions),
        "objects": object_facts(rendering.objects),
        "activity": _activity(simulation.activity),
        "engine": simulation.engine,
        "simulated_cycles_per_second": rendering.cycles_per_second,
        "build_seconds": simulation.build_seconds,
        "run_seconds": simulation.seconds,
        "wall_seconds": rendering.wall_seconds,
        "warnings": list(rendering.warnings),
        "first_difference": _first_difference(comparison.first_difference),
    }


def _replay(rendering: Rendering) -> str | None:
    """What draws the same again: the display list, a file beside the report; where the machine was
    sent objects, which that does not keep, the command line, if there was one."""
    return DISPLAY_LIST if rendering.objects is None else rendering.command_line


def _activity(record: ActivityRecord | None) -> dict[str, Any] | None:
    """Clocks of each kind: of every processing element, and of all of them bucket by bucket."""
    if record is None:
        return None
    timeline = record.counts.sum(axis=1)
    return {
        "clocks": record.clocks,
        "shares": record.shares(),
        "per_pe": [dict(zip((kind.name for kind in ACTIVITY_KINDS), counts, strict=True))
                   for counts in record.by_element.tolist()],
        "bucket_clocks": record.bucket_clocks,
        "timeline": {kind.name: timeline[:, kind.activity].tolist() for kind in ACTIVITY_KINDS},
    }


def merging_facts(rendering: Rendering) -> dict[str, Any] | None:
    """What the nodes sent to merge their pictures, by the machine's counters and by the golden
    model; None where there is one node, or its counters were not read.

    A chain's last card sends to the pins, which is no link.  Processing elements without pixels
    send every fragment, which memory units take.
    """
    simulation, traffic = rendering.simulation, rendering.traffic
    if traffic is None:
        return None
    golden = traffic.sent
    links = {send.sender for send in traffic.sends}
    counted = [pixels if node in links else 0 for node, pixels in enumerate(simulation.sent)]
    return {
        "pixels": counted,
        "golden_pixels": golden,
        "equal": counted == golden,
        "pixel_bits": traffic.pixel_bits,
        "total_bits": sum(counted) * traffic.pixel_bits,
        "busiest_link_pixels": traffic.busiest_piece,
        "steps": traffic.steps,
        **(_units(traffic, simulation) if isinstance(traffic, DirectTraffic) else {}),
    }


def _units(traffic: DirectTraffic, simulation: Simulation) -> dict[str, Any]:
    """What memory units took from all processing elements."""
    golden = traffic.taken.sum(axis=0).tolist()
    return {"taken": list(simulation.taken), "golden_taken": golden,
            "taken_equal": list(simulation.taken) == golden,
            "followed": list(simulation.followed)}


def _machine(rendering: Rendering) -> dict[str, Any]:
    return {
        **machine_facts(rendering.configuration),
        "total_units": rendering.simulation.total,
        "owned_units": rendering.simulation.owned,
        "exact_fraction_bits": rendering.comparison.exact_fraction_bits,
    }


def _first_difference(difference: FirstDifference | None) -> dict[str, Any] | None:
    if difference is None:
        return None
    fragments = difference.fragments
    return {
        "pixel": list(difference.pixel),
        "machine_pixel": list(difference.machine_pixel),
        "expected": {**_value(difference.expected), "primitive": difference.winner},
        "got": _value(difference.got),
        "fragments": [
            {"primitive": int(primitive), "depth": int(depth), "color": color.tolist()}
            for primitive, depth, color in zip(fragments.primitive, fragments.depth,
                                               fragments.color, strict=True)
        ],
    }


def _value(value: PixelValue) -> dict[str, Any]:
    return {"color": list(value.color), "depth": value.depth}
