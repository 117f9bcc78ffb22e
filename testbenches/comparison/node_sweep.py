"""Cages of one kind with more and more nodes: how much faster they are.

A cage's smallest piece that repeats, ``PMMC`` of ``4x(PMMC)``, is taken as often as there are to
be nodes; in a cage without merge cards it is an element with its units.  Each cage draws the scene
as it is, and one that grows with the machine (``grown``).  The time of a frame is what drawing and
merging take, without the wait for the next scan: by the cycle model of each cage, and simulated of
the smaller ones.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from itertools import groupby
from math import gcd

import numpy as np

from ...golden.cycles.cycle_model import CyclePrediction, predict_cycles
from ...golden.cycles.merge_clocks import predict_merge
from ...golden.planning.machine_plan import plan
from ...golden.scene_display_list import SceneDisplayList
from ...golden.specification.card_order import (
    DIRECT_MERGE,
    FRAME_UNIT,
    merge_card,
    parse_cards,
)
from ...golden.specification.configuration import MachineConfiguration, Packet
from ...golden.specification.display_list import DisplayList
from ...golden.specification.errors import InputError
from ...golden.specification.fields.making import Objects
from ..frames.region_figures import RegionTables
from ..frames.setup_timing import setup_timing
from .cage import Cage, CageJob, CageRun, Refused


def repeated_piece(cards: str) -> str:
    """The shortest order of cards of which ``cards`` is a repetition; of frame units there is no
    more than one set, and where nodes merge directly elements and units repeat apart.

    >>> repeated_piece("4x(PMMC)"), repeated_piece("PMMPMM"), repeated_piece("PMMPM")
    ('PMMC', 'PMM', 'PMMPM')
    >>> repeated_piece("4x(PMMS)FF"), repeated_piece("4xP D 8xM")
    ('PMMSFF', 'PDMM')
    """
    spelled = parse_cards(cards)
    if DIRECT_MERGE in spelled:
        elements, _, units = spelled.partition(DIRECT_MERGE)
        copies = gcd(len(elements), len(units)) or 1
        return elements[::copies] + DIRECT_MERGE + units[::copies]
    nodes = spelled.rstrip(FRAME_UNIT)
    return nodes[:(nodes + nodes).find(nodes, 1)] + spelled[len(nodes):]


def repeated(piece: str, copies: int) -> str:
    """The cards of a cage of so many.

    >>> repeated("PMMC", 4), repeated("PMMSFF", 4), repeated("PDMM", 4), repeated("PMM", 1)
    ('4x(PMMC)', '4x(PMMS)FF', '4x(P)D4x(MM)', 'PMM')
    """
    if copies == 1:
        return piece
    elements, direct, units = piece.partition(DIRECT_MERGE)
    if direct:
        return f"{copies}x({elements}){direct}{copies}x({units})"
    nodes = piece.rstrip(FRAME_UNIT)
    return f"{copies}x({nodes}){piece[len(nodes):]}"


def grown(display_list: DisplayList, copies: int, packet: Packet = 1) -> DisplayList:
    """``copies`` of a list one after the other, each wholly before those drawn earlier.

    Each begins a packet further on, so that nodes get other triangles of it than of the copy
    before: every node draws as much as one did of the list alone, all over the picture.  A single
    copy is the list itself, objects included; of several copies only triangles are known.
    """
    if copies == 1:
        return display_list
    thickness = ((1 << display_list.depth_bits) - 1) // copies
    step = packet if isinstance(packet, int) else 0  # each node has one packet

    def copy(number: int) -> DisplayList:
        turned = display_list.chosen(np.roll(np.arange(display_list.triangles), number * step))
        return replace(turned, depth=turned.depth // copies + (copies - 1 - number) * thickness)

    first, *others = (copy(number) for number in range(copies))
    return first.followed_by(*others)


@dataclass(frozen=True)
class FrameTime:
    """Clocks to draw a frame, and to merge it."""

    draw: int
    merge: int

    @property
    def total(self) -> int:
        return self.draw + self.merge


def predicted_drawing(configuration: MachineConfiguration, display_list: DisplayList,
                      retained: bool) -> CyclePrediction:
    """What the cycle model says; where regions are dealt out, by what the scene itself costs."""
    table = (None if configuration.regions is None else
             RegionTables(configuration, [display_list] * 2).table(1))
    return predict_cycles(configuration, display_list, setup=setup_timing(configuration),
                          retained=retained, table=table)


def predicted_time(configuration: MachineConfiguration, display_list: DisplayList,
                   retained: bool) -> FrameTime:
    """The clocks of ``predicted_drawing``, and those to merge."""
    draw = predicted_drawing(configuration, display_list, retained).cycles
    return FrameTime(round(draw), predict_merge(configuration, display_list))


@dataclass(frozen=True)
class Place:
    """Where a point lies: ``piece`` repeated ``nodes`` times, and the scene it draws."""

    piece: str
    retained: bool
    growing: bool
    nodes: int
    regions: tuple[int, int] | None = None
    objects: Objects | None = None

    @property
    def cage(self) -> Cage:
        return Cage(repeated(self.piece, self.nodes), self.retained, self.regions, self.objects)

    @property
    def copies(self) -> int:
        return self.nodes if self.growing else 1


@dataclass(frozen=True)
class Point:
    """``simulated`` is None where only the model was asked, or the cage delivers none."""

    place: Place
    triangles: int
    model: FrameTime
    simulated: FrameTime | None


@dataclass(frozen=True)
class PointJob:
    """A point that is to be found; ``simulate``: not by the model alone."""

    place: Place
    job: CageJob
    simulate: bool

    def run(self) -> tuple[Point, CageRun | Refused | None] | Refused:
        place, cage = self.place, self.place.cage
        options = cage.options(self.job.options)
        try:
            settled = options.for_plan()
            listed = grown(self.job.scene.display_list, place.copies, options.packet or 1)
            configuration = plan(listed, **settled).configuration
        except InputError as error:
            return Refused(cage, str(error))
        model = predicted_time(configuration, listed, place.retained)
        run = None
        if self.simulate:
            run = replace(self.job, cage=cage, memories=False, scene=SceneDisplayList(
                listed, self.job.scene.name)).run()
        return Point(place, listed.triangles, model, time_of(run)), run


def time_of(run: CageRun | Refused | None) -> FrameTime | None:
    return FrameTime(run.clocks.draw, run.clocks.merge) if isinstance(run, CageRun) else None


def places(cages: Sequence[Cage], nodes: Sequence[int]) -> Iterator[Place]:
    """The points of all curves, each once: with one node nothing has grown yet, and a scene of
    objects does not grow."""
    kinds: dict[tuple[str, Cage], None] = {}
    for cage in cages:
        if cage.spelled is not None:
            kinds[repeated_piece(cage.cards), replace(cage, cards="")] = None
    for piece, kind in kinds:
        for growing in (False, True) if kind.objects is None else (False,):
            for number in sorted(set(nodes)):
                if not growing or number > 1:
                    yield Place(piece, kind.retained, growing, number, kind.regions, kind.objects)


@dataclass(frozen=True)
class Curve:
    """Points with more and more nodes, of one kind of cage and one way to choose the scene."""

    piece: str
    retained: bool
    growing: bool
    points: Sequence[Point]
    regions: tuple[int, int] | None = None
    objects: Objects | None = None

    @property
    def label(self) -> str:
        piece = self.piece if merge_card(self.piece) else f"{self.piece}, one node"
        if self.regions is not None:
            piece += ", {}x{} regions".format(*self.regions)
        if self.objects is not None:
            piece += f", objects made in {self.objects}"
        return f"{piece}, retained" if self.retained else piece

    def speed_ups(self) -> list[tuple[Point, float, float | None]]:
        """Of each point by the model and simulated: triangles drawn a clock, against those of
        the first point, simulated against simulated where that was."""
        first = self.points[0]
        return [(point, _rate(point.triangles, point.model) / _rate(first.triangles, first.model),
                 None if point.simulated is None else _rate(point.triangles, point.simulated)
                 / _rate(first.triangles, first.simulated or first.model))
                for point in self.points]


def _rate(triangles: int, time: FrameTime) -> float:
    return max(triangles, 1) / max(time.total, 1)


def curves_of(points: Sequence[Point]) -> list[Curve]:
    """The curves, those of the scene as it is first; each scene that grows begins as it is."""

    def key(point: Point) -> tuple[bool, str, bool, tuple[int, int], str]:
        place = point.place
        return (place.growing, place.piece, place.retained, place.regions or (0, 0),
                place.objects or "")

    begin = [replace(point, place=replace(point.place, growing=True)) for point in points
             if point.place.nodes == 1 and point.place.objects is None]
    ordered = sorted([*points, *begin], key=lambda point: (*key(point), point.place.nodes))
    curves = [list(some) for _, some in groupby(ordered, key)]
    return [Curve(place.piece, place.retained, place.growing, some, place.regions, place.objects)
            for some in curves for place in [some[0].place]]
