"""The figures of a study of precision, as plain numbers, lists and words: ``precision.json``."""

from __future__ import annotations

from dataclasses import asdict
from typing import Any

from ...golden.organisations.organisation_of import organisation_of
from .precision_chart import PEER_CASE, PEER_DEPTH_BITS, measured_peers, own_points, pareto_front
from .scene_precision import Precision, PrecisionRow


def precision_facts(precision: Precision) -> dict[str, Any]:
    """Everything the report tells but the plot.

    The names are part of the command line's contract: add to them, do not change them.
    """
    machine = precision.machine
    return {
        "good": not precision.problems(),
        "problems": precision.problems(),
        "scene": precision.scene.name,
        "command_line": precision.command_line,
        "triangles": precision.scene.display_list.triangles,
        "machine": {
            "cards": machine.cards,
            "processing_elements": machine.processing_elements,
            "memory_units": machine.units,
            "width": machine.width,
            "height": machine.height,
            "picture_width": organisation_of(machine).resolution.width,
            "picture_height": organisation_of(machine).resolution.height,
            "sub_bits": machine.sub_bits,
            "depth_bits": machine.depth_bits,
            "shading": machine.shading,
        },
        "extent": precision.extent,
        "exact_fraction_bits": machine.fraction_bits,
        "fraction_bits": [_row(precision, row) for row in precision.rows],
        # Found among the rows whose speed is known, by fragments a clock and a second.
        "pareto_front": {
            panel: [point.label for point in pareto_front(own_points(precision, panel))]
            for panel in ("clock", "second")
        },
        "float32": asdict(precision.float32),
        "formats": [asdict(point) for point in precision.formats],
        "needs": precision.missing_tools,
        "peers": _peers(),
        "warnings": list(precision.warnings),
        "wall_seconds": precision.wall_seconds,
    }


def _peers() -> list[dict[str, Any]]:
    return [{"name": peer.name, "case": PEER_CASE, "cycles_per_fragment": 1 / rate,
             "depth_error_lsb": peer.depth_error_lsb, "depth_bits": PEER_DEPTH_BITS,
             "mhz": peer.ecp5_mhz} for peer, rate in measured_peers()]


def _row(precision: Precision, row: PrecisionRow) -> dict[str, Any]:
    return {
        **asdict(row.point),
        "within_bound": row.point.within_bound,
        "simulated": row.frame is not None,
        "frame": None if (frame := precision.frame(row)) is None else asdict(frame),
        "fragments_per_clock": precision.fragments_per_clock(row),
        "placement": None if row.placement is None else row.placement.facts(),
        "megafragments_per_second": precision.megafragments_per_second(row),
    }
