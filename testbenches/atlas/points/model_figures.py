"""What the models say of a point: clocks, memory, logic, traffic, error, and what limits it."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any

from ....golden.cycles.cycle_model import CyclePrediction
from ....golden.cycles.merge_clocks import predict_merge
from ....golden.merging.cage import merge_cage, sent_pixel_bits
from ....golden.merging.traffic import Traffic
from ....golden.organisations.organisation_of import organisation_of
from ....golden.planning.machine_plan import triangle_bits
from ....golden.reference.exact import depth_complexity
from ....golden.specification.card_order import MEMORY_UNIT
from ....golden.specification.commands import command_bits
from ....golden.specification.configuration import MachineConfiguration
from ....golden.specification.display_list import DisplayList
from ...comparison.node_sweep import predicted_drawing
from .atlas_point import AtlasPoint, Figures
from .board_sizes import cells_of_cage
from .memory_bits import memory_bits
from .object_link import ObjectLink, object_link
from .precision_error import precision_error

#: Commands of a frame besides its triangles: its start, its end, and to draw the lists.
FRAME_COMMANDS, LIST_COMMANDS = 2, 1

#: And before the lists are loaded.
CLEAR_COMMANDS = 1

#: Drawing that takes so many times longer than each part of it would alone is limited by none of
#: these: elements wait, one after another, for what each alone would have had time for.
WAITING = 1.25

#: What can limit a point, by the names that ``CyclePrediction.bounds`` has for them.
LIMITS = {"broadcast": "broadcast", "busiest element": "busiest element",
          "busiest port": "memory ports", "waiting": "waiting", "merge": "merge",
          "set-up": "set-up"}


@dataclass(frozen=True, eq=False)
class Work:
    """What does not depend on precision, but where the machine sets triangles up; ``kept``, the
    triangles that may cover a pixel; ``link``, what the host says of objects."""

    prediction: CyclePrediction
    merge: int
    traffic: Traffic | None
    fragments: int
    kept: int
    link: ObjectLink | None


def work_of(configuration: MachineConfiguration, display_list: DisplayList, retained: bool
            ) -> Work:
    """By the cycle model and the golden merge."""
    organisation = organisation_of(configuration)
    prediction = predicted_drawing(configuration, display_list, retained)
    return Work(
        prediction, predict_merge(configuration, display_list),
        merge_cage(configuration, display_list)[1] if organisation.merges else None,
        int(depth_complexity(display_list, **organisation.resolution.shifts).sum()),
        len(prediction.finished), object_link(configuration, display_list))


def of_any_precision(configuration: MachineConfiguration) -> MachineConfiguration:
    """Machines for which this is the same take the same clocks.  A set-up's divisions take longer,
    the more bits they find."""
    if configuration.setup == "hardware":
        return configuration
    return replace(configuration, fraction_bits=0, depth_integer_bits=0, channel_integer_bits=0,
                   order_bits=0)


def model_figures(point: AtlasPoint, configuration: MachineConfiguration, work: Work) -> Figures:
    """All figures of a point; ``atlas.facts`` says what each is."""
    draw, merge = round(work.prediction.cycles), work.merge
    memory = memory_bits(configuration)
    return {
        "machine": _machine(configuration),
        "triangles": point.scene.load().display_list.triangles,
        "fragments": work.fragments,
        "source": "model",
        **clock_figures(configuration, draw, merge),
        "limit": limit(work.prediction, merge),
        "bounds": {name: round(bound) for name, bound in work.prediction.bounds.items()}
        | {"merge": merge},
        "memory": memory,
        "memory_bits": sum(memory.values()),
        "cells": cells_of_cage(configuration),
        "traffic": traffic_figures(configuration, point, work),
        "error": precision_error(point.scene, configuration),
        "simulated": None,
        "node_check": None,
    }


def clock_figures(configuration: MachineConfiguration, draw: int, merge: int) -> dict[str, Any]:
    """``work``: what a frame takes of many, without the wait for the next scan.  On a bus the next
    one is drawn while one is merged."""
    work = max(draw, merge) if configuration.snoops else draw + merge
    scan = configuration.cycles_per_scan
    return {"draw": draw, "merge": merge, "work": work, "scan": scan,
            "scans": max(1, -(-work // scan))}


def limit(prediction: CyclePrediction, merge: int) -> str:
    """What takes longest of a frame, of ``LIMITS``."""
    if merge > prediction.cycles:
        return LIMITS["merge"]
    if prediction.cycles > WAITING * prediction.bound:
        return LIMITS["waiting"]
    return LIMITS[prediction.binding]


def traffic_figures(configuration: MachineConfiguration, point: AtlasPoint, work: Work
                    ) -> dict[str, int]:
    """Bits of a picture: from the host, between nodes or neighbouring elements, both, and on the
    busiest piece of the backplane between two of these; and from the host once, before the first
    picture."""
    if (link := work.link) is not None:
        drawn, once = link.frame, link.once
    elif point.cage.retained:
        drawn, once = LIST_COMMANDS, CLEAR_COMMANDS + work.kept
    else:
        drawn, once = work.kept, 0
    if configuration.regions is not None and configuration.balancer == "host" \
            and configuration.balance != "static":
        drawn += configuration.dealt_regions.count
    host = (FRAME_COMMANDS + drawn) * command_bits(configuration)
    sent, busiest, bits = 0, 0, sent_pixel_bits(configuration)
    if work.traffic is not None:
        sent, busiest = work.traffic.pixels, work.traffic.busiest_piece
    elif link is not None:
        sent, busiest, bits = link.passed, link.busiest_piece, link.passed_bits
    return {"host": host, "nodes": sent * bits, "all": host + sent * bits,
            "busiest_link": busiest * bits, "once": once * command_bits(configuration)}


def _machine(configuration: MachineConfiguration) -> dict[str, Any]:
    organisation = organisation_of(configuration)
    return {
        "organisation": organisation.name,
        "elements": configuration.processing_elements,
        "nodes": organisation.nodes,
        "memory_units": configuration.cards.count(MEMORY_UNIT),
        "fraction_bits": configuration.fraction_bits,
        "triangle_bits": triangle_bits(configuration),
        "pixel_bits": sent_pixel_bits(configuration) if organisation.merges else 0,
    }
