"""One cage of a comparison: what is asked of it, and the run that answers."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any, get_args

import numpy as np

from ...golden.merging.cage import merge_cage
from ...golden.merging.traffic import Traffic
from ...golden.planning.machine_plan import plan
from ...golden.scene_display_list import SceneDisplayList
from ...golden.scenes.scene_files.values import nearest
from ...golden.specification.card_order import (
    DIRECT_MERGE,
    NODE_ENDS,
    merge_card,
    parse_cards,
)
from ...golden.specification.configuration import MachineConfiguration
from ...golden.specification.errors import InputError
from ...golden.specification.fields.making import Objects
from ..frames.compare import Comparison, compare
from ..frames.node_counts import NodeFigures, count_differences, node_figures, unit_differences
from ..frames.object_figures import ObjectFigures
from ..frames.region_figures import RegionFigures
from ..frames.responses import Simulation
from ..frames.wrong_counts import wrong_counts
from ..machine_options import MachineOptions, resolution_warnings
from ..support.machine_error import MachineError
from ..views.scene_frames import SceneFrames
from .cage_memory import Memory, cells_of, memories_of
from .frame_sequence import Clocks, FrameSequence, Latency
from .view_spread import ViewFigures, draw_views

#: Two times are the same if one is no more than so many times the other.
MEASURED_ALIKE = 1.05


#: Between what a cage is and where it makes the triangles of objects.
MADE_IN = "@"


@dataclass(frozen=True)
class Cage:
    """``cards`` as they were asked for; ``retained``: nodes draw lists that were loaded once;
    ``regions``: columns and rows of them that are dealt out, if any are; ``objects``: where it
    makes the triangles of objects, None as is asked of all cages."""

    cards: str
    retained: bool = False
    regions: tuple[int, int] | None = None
    objects: Objects | None = None

    @classmethod
    def named(cls, name: str, retained: bool = False) -> Cage:
        """``4x(PMM)``, with regions ``4x(PMM)/8x8``, or with the place where it makes the triangles
        of objects, ``4x(PMMT)@nodes``, ``4x(PMM)/8x8@elements``, ``4x(PMM)@controller``.

        What else cannot be read is taken for cards.  One that makes triangles keeps meshes, and no
        lists, whatever ``retained`` says.  Raises ``InputError`` for another place.

        >>> Cage.named("4x(PMM)/8x4")
        Cage(cards='4x(PMM)', retained=False, regions=(8, 4), objects=None)
        >>> Cage.named("2x(PMT)@nodes").label
        '2x(PMT)@nodes'
        """
        name, made, place = name.partition(MADE_IN)
        objects = _place(name, place) if made else None
        retained = retained and objects is None
        match = re.fullmatch(r"(.*?)\s*/\s*([0-9]{1,4})x([0-9]{1,4})\s*", name, re.DOTALL)
        if match is None:
            return cls(name, retained, None, objects)
        return cls(match[1], retained, (int(match[2]), int(match[3])), objects)

    @property
    def label(self) -> str:
        named = self.cards
        if self.regions is not None:
            named += "/{}x{}".format(*self.regions)
        if self.objects is not None:
            named += f"{MADE_IN}{self.objects}"
        return f"{named} retained" if self.retained else named

    @property
    def spelled(self) -> str | None:
        """The cards one by one; None where they cannot be read, which planning the cage says."""
        try:
            return parse_cards(self.cards)
        except InputError:
            return None

    @property
    def can_retain(self) -> bool:
        """It has nodes, which can draw from lists."""
        return merge_card(self.spelled or "") is not None and self.objects is None

    def options(self, asked: MachineOptions) -> MachineOptions:
        """What is asked of this cage, of all that is asked of every one."""
        merge = merge_card(self.spelled or "")
        dealing: dict[str, Any] = {name: None if self.regions is None else getattr(asked, name)
                                   for name in ("slots", "balance", "balancer")}
        forwards = self.makes_triangles(asked) == "elements"
        return replace(asked, cards=self.cards, retain=self.retained or None,
                       list_words=asked.list_words if self.retained else None,
                       regions=self.regions, **dealing,
                       packet=None if merge is None and not forwards else asked.packet,
                       queue=asked.queue if merge == DIRECT_MERGE else None,
                       **self._objects(asked))

    def makes_triangles(self, asked: MachineOptions) -> Objects | None:
        """Where this cage makes the triangles of objects: where its own name says, be there such a
        place or not, else where all cages are asked to and it can."""
        if self.objects is not None:
            return self.objects
        merge = merge_card(self.spelled or "")
        if asked.objects is None or self.retained or not {
                "nodes": merge in NODE_ENDS, "controller": merge is None,
                "elements": merge is None and self.regions is not None}[asked.objects]:
            return None
        return asked.objects

    def _objects(self, asked: MachineOptions) -> dict[str, Any]:
        """What is asked of a cage that makes triangles; another one is sent them, which, where all
        are asked to make triangles, it sets up by the same means."""
        place = self.makes_triangles(asked)
        fields: dict[str, Any] = {name: None if place is None else getattr(asked, name)
                                  for name in ("mesh_triangles", "meshes")}
        setup = asked.setup or ("fast" if place or asked.objects else None)
        return fields | {"objects": place, "setup": setup}


def _place(cage: str, place: str) -> Objects:
    """``InputError`` for one where no machine makes triangles."""
    known: dict[str, Objects] = {each: each for each in get_args(Objects)}
    if (found := known.get(place.strip())) is None:
        raise InputError(f"cage: {cage}{MADE_IN}{place}: {place.strip()!r} is no place where "
                         "triangles of objects are made, which comes last, as in "
                         f"4x(PMM)/1x4@elements; {nearest(place.strip(), known)}")
    return found


@dataclass(frozen=True)
class Refused:
    """A cage without figures: it cannot be built for the scene, or, ``failed``, delivers none."""

    cage: Cage
    reason: str
    failed: bool = False

    def __str__(self) -> str:
        return f"{self.cage.label}: {self.reason}"


@dataclass(frozen=True, eq=False)
class CageRun:
    """What a cage did with a scene.

    ``traffic``      as the machine counted its pixels
    ``nodes``        left to right
    ``memories``     every one there is, if they were asked for
    ``cells``        None where they were not counted
    ``differences``  a line each: what is not as the golden model has it
    ``warnings``     a line each
    ``views``        of all views that were asked for; all else is of the first one
    ``regions``      of the frame that is measured; None where none are dealt out
    ``objects``      likewise; None where the machine takes none
    ``link_words``   of 32 bits, on the host link for the first frame, meshes or lists included
    """

    cage: Cage
    configuration: MachineConfiguration
    simulation: Simulation
    comparison: Comparison
    clocks: Clocks
    latency: Latency | None
    nodes: Sequence[NodeFigures]
    traffic: Traffic
    memories: Sequence[Memory]
    cells: dict[str, int] | None
    differences: Sequence[str]
    warnings: Sequence[str]
    views: Sequence[ViewFigures] = ()
    regions: RegionFigures | None = None
    objects: ObjectFigures | None = None
    link_words: int = 0

    @property
    def fragments(self) -> int:
        return sum(node.fragments for node in self.nodes)

    @property
    def busiest_share(self) -> float:
        """The most fragments of a node, as a part of all; 0 where there are none."""
        return max(node.fragments for node in self.nodes) / max(self.fragments, 1)

    @property
    def bound_by(self) -> str:
        """``draw`` or ``merge``, if a frame takes as long as that, within a twentieth; else
        ``scan``: a picture is shown from the beginning of a scan on, so it takes whole scans."""
        parts = {"draw": self.clocks.draw, "merge": self.clocks.merge}
        busiest = max(parts, key=parts.__getitem__)
        # On a bus the next frame is drawn while one is merged.
        work = max(parts.values()) if self.configuration.snoops else sum(parts.values())
        return busiest if self.clocks.frame <= MEASURED_ALIKE * work else "scan"

    @property
    def memory_bits(self) -> int:
        return sum(memory.all_bits for memory in self.memories)


@dataclass(frozen=True)
class CageJob:
    """A cage that is to draw ``scene``; ``memories``: list them, ``cells``: count them, too.
    ``views``: the scene from all sides that were asked for, the first of which ``scene`` is."""

    cage: Cage
    scene: SceneDisplayList
    options: MachineOptions
    engine: str
    random_memory: int | None = None
    memories: bool = True
    cells: bool = False
    views: SceneFrames | None = None

    def run(self) -> CageRun | Refused:
        try:
            return self._run()
        except InputError as error:
            return Refused(self.cage, str(error))
        except MachineError as error:
            return Refused(self.cage, str(error), failed=True)

    def _run(self) -> CageRun:
        display_list = self.scene.display_list
        lists = display_list if self.views is None else self.views
        options = self.cage.options(self.options)
        configuration = plan(lists, **options.for_plan()).configuration
        policy = options.policy(configuration)
        frames = FrameSequence(configuration, display_list, self.engine, self.random_memory,
                               policy)
        simulation = frames.simulation
        comparison = compare(configuration, display_list, simulation)
        golden = merge_cage(configuration, display_list)[1]
        nodes = node_figures(configuration, display_list, simulation, golden)
        views = [] if self.views is None else draw_views(configuration, self.views, self.engine,
                                                         self.random_memory, policy)
        return CageRun(
            self.cage, configuration, simulation, comparison, frames.clocks,
            frames.latency(comparison.golden), nodes,
            replace(golden, sends=[send._replace(pixels=nodes[send.sender].sent)
                                   for send in golden.sends]),
            memories_of(configuration) if self.memories else [],
            cells_of(configuration) if self.cells else None,
            [*_picture_differences(comparison, frames), *count_differences(nodes),
             *unit_differences(simulation, golden),
             *wrong_counts(frames.regions, frames.objects), *_view_differences(views)],
            [*resolution_warnings(configuration), *_sent_triangles(self), *simulation.notes],
            views, frames.regions, frames.objects, frames.link_words)


def _picture_differences(comparison: Comparison, frames: FrameSequence) -> list[str]:
    found = []
    if (first := comparison.first_difference) is not None:
        found.append(f"{comparison.pixels_different:,} of {comparison.pixels_compared:,} colours "
                     f"and {comparison.depths_different:,} of {comparison.depths_compared:,} "
                     "depths differ, first at x {}, y {}".format(*first.pixel))
    scans = frames.shown_scans
    wrong = sum(not np.array_equal(scan.picture, frames.simulation.video) for scan in scans)
    if wrong:
        found.append(f"{wrong} of {len(scans)} scans, of frames of one scene, show another picture "
                     "than the last")
    return found


def _sent_triangles(job: CageJob) -> list[str]:
    place = job.options.objects
    if place is None or job.cage.makes_triangles(job.options) is not None:
        return []
    return [f"triangles are sent to it: objects are made in {place}, which it has not"]


def _view_differences(views: Sequence[ViewFigures]) -> list[str]:
    return [f"view {number}: {line}" for number, view in enumerate(views)
            for line in view.differences]
