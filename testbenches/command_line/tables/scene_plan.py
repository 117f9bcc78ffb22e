"""The plan of a scene's machine, with its cards, its cycles and the cells it saves."""

from __future__ import annotations

import shlex
from dataclasses import asdict, dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

from ....golden.cycles.cycle_estimate import CycleEstimate, cards_for_cycles, estimate_cycles
from ....golden.planning.machine_plan import Plan, plan, triangle_bits
from ....golden.scene_display_list import SceneDisplayList
from ....golden.specification.errors import InputError
from ...machine_options import (
    MachineOptions,
    load_scene,
    option_words,
    resolution_warnings,
)

if TYPE_CHECKING:
    from ...export.cell_count import Cells

#: How far the estimate of cycles is off in the frames that the tests simulate.
CYCLE_ACCURACY = 0.15


@dataclass(frozen=True, eq=False)
class ScenePlan:
    """A plan and what follows from it.

    ``estimate``  cycles of a frame on the planned machine
    ``budget``    the cycles its cards were chosen for, if any
    ``cells``     of a processing element: planned, full; None where they are not counted
    ``command``   that renders the scene on the planned machine
    ``warnings``  one line each
    """

    scene: SceneDisplayList
    plan: Plan
    estimate: CycleEstimate
    budget: int | None
    cells: tuple[Cells, Cells] | None
    command: str
    warnings: tuple[str, ...]


def plan_scene(scene: str | Path, options: MachineOptions | None = None,
               cycles: int | None = None, count: bool = False) -> ScenePlan:
    """Plan the machine for ``scene``; the same that ``render`` and ``export`` build.

    ``cycles`` chooses the cards that are estimated to draw a frame in so many; ``count`` has
    yosys count cells, some ten seconds.  Raises ``InputError`` for whatever cannot be used.
    """
    options = options or MachineOptions()
    if cycles is not None and options.cards is not None:
        raise InputError("--cycles: chooses the cards itself; leave out --cards")
    if cycles is not None and (options.retain or options.list_words is not None):
        raise InputError("--cycles: chooses cards of one node, which keeps no list; leave out "
                         "--retain and --list-words")
    loaded = load_scene(scene, options)
    if cycles is not None:
        fields = {name: value for name, value in options.for_plan().items()
                  if name not in ("cards", "max_error", "retain")}
        options = replace(options, cards=cards_for_cycles(loaded.display_list, cycles, **fields))
    planned = plan(loaded.display_list, **options.for_plan())
    return ScenePlan(
        scene=loaded,
        plan=planned,
        estimate=estimate_cycles(planned.configuration, loaded.display_list,
                                 retained=planned.configuration.list_words > 0),
        budget=cycles,
        cells=_cells(planned) if count else None,
        command=shlex.join(["cardcage", "render", str(scene), *option_words(options)]),
        warnings=(*loaded.notes, *resolution_warnings(planned.configuration)),
    )


def _cells(planned: Plan) -> tuple[Cells, Cells]:
    # They load Amaranth: only those who count wait for it.
    from ....hdl.processing_element.processing_element import ProcessingElement
    from ...export.cell_count import count_cells

    machine, full = (count_cells(ProcessingElement(configuration=configuration))
                     for configuration in (planned.configuration, planned.full))
    return machine, full


def plan_facts(planned: ScenePlan) -> dict[str, Any]:
    """The plan as plain numbers, lists and words: what ``--json`` prints."""
    machine, estimate = planned.plan.configuration, planned.estimate
    return {
        "scene": planned.scene.name,
        "command": planned.command,
        "machine": asdict(machine) | {
            "depth_plane_bits": machine.depth_plane_bits,
            "channel_plane_bits": (None if machine.shading == "flat" else
                                   machine.channel_plane_bits),
            "memory_units": machine.units,
            "processing_elements": machine.processing_elements,
        },
        "needs": asdict(planned.plan.needs),
        "lines": [asdict(line) for line in planned.plan.lines],
        "triangle_bits": {"planned": triangle_bits(machine),
                          "full": triangle_bits(planned.plan.full)},
        "cycles": {"estimated": estimate.total, "budget": planned.budget,
                   "accuracy": CYCLE_ACCURACY,
                   "fragments": estimate.fragments.tolist()},
        "cells": (None if planned.cells is None else
                  dict(zip(("planned", "full"), map(asdict, planned.cells), strict=True))),
        "warnings": list(planned.warnings),
    }
