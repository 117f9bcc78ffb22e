"""The plan of a scene's machine, with its cards, its cycles and the cells it saves."""

from __future__ import annotations

import shlex
from collections.abc import Sequence
from dataclasses import asdict, dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

from ....golden.cycles.cycle_estimate import CycleEstimate, cards_for_cycles, estimate_cycles
from ....golden.planning.machine_plan import Plan, plan, triangle_bits
from ....golden.scene_display_list import SceneDisplayList
from ....golden.specification.display_list import DisplayList
from ....golden.specification.errors import InputError
from ...machine_options import (
    MachineOptions,
    load_scene,
    option_words,
    resolution_warnings,
)
from ...views.asked_views import AskedViews

if TYPE_CHECKING:
    from ...export.cell_count import Cells

#: How far the estimate of cycles is off in the frames that the tests simulate.
CYCLE_ACCURACY = 0.15


@dataclass(frozen=True)
class PlannedPictures:
    """What one machine for several pictures has to do.

    ``cycles``     that each is estimated to take
    ``slowest``    the number of the one that takes most, counted from 0, as reports do
    ``triangles``  that this one has
    """

    cycles: tuple[int, ...]
    slowest: int
    triangles: int


@dataclass(frozen=True, eq=False)
class ScenePlan:
    """A plan and what follows from it.

    ``scene``     of several pictures, the first
    ``pictures``  None where one picture is planned for
    ``estimate``  cycles of a frame on the planned machine; of several pictures, of the slowest
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
    pictures: PlannedPictures | None = None

    @property
    def exact(self) -> bool:
        """No picture has a depth or a colour that is off."""
        needed = self.plan.needs.exact_fraction_bits
        return self.plan.configuration.fraction_bits >= needed


def plan_scene(scene: str | Path, options: MachineOptions | None = None,
               cycles: int | None = None, count: bool = False,
               asked: AskedViews | None = None) -> ScenePlan:
    """Plan the machine for ``scene``; the same that ``render`` and ``export`` build.

    ``cycles`` chooses the cards that are estimated to draw a frame in so many; ``count`` has
    yosys count cells, some ten seconds; ``asked`` are several pictures, which one machine draws.
    Raises ``InputError`` for whatever cannot be used.
    """
    asked = asked or AskedViews()
    options = options or MachineOptions()
    if cycles is not None and options.cards is not None:
        raise InputError("--cycles: chooses the cards itself; leave out --cards")
    if cycles is not None and (options.retain or options.list_words is not None):
        raise InputError("--cycles: chooses cards of one node, which keeps no list; leave out "
                         "--retain and --list-words")
    views = asked.lists(scene, options)
    loaded = load_scene(scene, options) if views is None else views.first
    lists = [loaded.display_list] if views is None else views
    options, planned, each = _planned(lists, options, cycles)
    slowest = _slowest(each)
    return ScenePlan(
        scene=loaded,
        plan=planned,
        estimate=each[slowest],
        budget=cycles,
        cells=_cells(planned) if count else None,
        command=shlex.join(["cardcage", "render", str(scene), *option_words(options),
                            *asked.words()]),
        warnings=(*loaded.notes, *resolution_warnings(planned.configuration)),
        pictures=None if views is None else PlannedPictures(
            tuple(estimate.total for estimate in each), slowest, lists[slowest].triangles),
    )


def _planned(lists: Sequence[DisplayList], options: MachineOptions, cycles: int | None
             ) -> tuple[MachineOptions, Plan, list[CycleEstimate]]:
    """One machine for all of them, on the cards that were asked for or are fast enough for each;
    and how long it takes for each."""
    fields = {name: value for name, value in options.for_plan().items()
              if name not in ("cards", "max_error", "retain")}
    hard = [0]
    while True:
        if cycles is not None:
            options = replace(options, cards=cards_for_cycles([lists[number] for number in hard],
                                                              cycles, **fields))
        planned = plan(lists, **options.for_plan())
        each = [estimate_cycles(planned.configuration, one,
                                retained=planned.configuration.list_words > 0) for one in lists]
        # To try all cards on all lists would take long; those for a few, the hardest, mostly do.
        slowest = _slowest(each)
        if cycles is None or each[slowest].total <= cycles or slowest in hard:
            return options, planned, each
        hard.append(slowest)


def _slowest(each: Sequence[CycleEstimate]) -> int:
    """The number of the first that takes most."""
    return max(range(len(each)), key=lambda number: each[number].total)


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
    pictures = planned.pictures
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
        # One picture is told as ever.
        **({} if pictures is None else {"pictures": {
            "count": len(pictures.cycles), "exact": planned.exact, "slowest": pictures.slowest,
            "slowest_triangles": pictures.triangles, "cycles": list(pictures.cycles)}}),
    }
