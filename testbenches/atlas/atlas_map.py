"""Which organisation is best at what, for which scene, size and number of elements."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from ...golden.specification.card_order import merge_card
from ...golden.specification.fields.making import Objects
from ..comparison.cage import Cage
from .atlas import Atlas
from .points.atlas_point import AtlasPoint, Figures, FractionBits


@dataclass(frozen=True)
class Measure:
    """What machines are compared by: the least figure is the best.

    ``best``  what the best one is called; ``unit`` of the figure
    """

    best: str
    unit: str
    figure: Callable[[Figures], int]


#: By their names in ``atlas.json``.
MEASURES = {
    "fastest": Measure("fastest", "clocks a frame", lambda figures: int(figures["work"])),
    "least_memory": Measure("least memory", "bits", lambda figures: int(figures["memory_bits"])),
    "least_traffic": Measure("least traffic", "bits a picture",
                             lambda figures: int(figures["traffic"]["all"])),
    "smallest": Measure("smallest", "cells", lambda figures: int(figures["cells"])),
}


@dataclass(frozen=True, order=True)
class Cell:
    """Of the map: machines that have as many elements and draw the same picture, equally exact."""

    scene: str
    size: tuple[int, int]
    elements: int
    precision: str


@dataclass(frozen=True)
class Ranked:
    """A point, and its figure of a measure."""

    point: AtlasPoint
    figure: int

    @property
    def kind(self) -> str:
        return kind_of(self.point.cage)


@dataclass(frozen=True)
class Place:
    """A cell of the map of one measure: the points, the best one first; of equal ones that which
    was asked for first."""

    ranked: tuple[Ranked, ...]

    @property
    def best(self) -> Ranked:
        return self.ranked[0]

    @property
    def other(self) -> Ranked | None:
        """The best machine of another kind; None where there is none."""
        return next((each for each in self.ranked if each.kind != self.best.kind), None)

    @property
    def second(self) -> str | None:
        """Its kind."""
        return None if self.other is None else self.other.kind

    @property
    def ahead(self) -> float | None:
        """How many times as much it has."""
        return None if self.other is None else self.other.figure / max(self.best.figure, 1)


def kind_of(cage: Cage) -> str:
    """What a cage is, but for how large it is: a name for people."""
    merge = merge_card(cage.spelled or "")
    named = KINDS[merge]
    if cage.regions is not None:
        named = "regions {}x{}".format(*cage.regions)
    if cage.objects is not None:
        named += f", {MAKERS[cage.objects]}"
    return f"{named}, lists" if cage.retained else named


#: Merge card → what a cage with it is called on the map.
KINDS = {None: "host broadcast", "C": "chain", "T": "tree", "S": "bus", "D": "direct"}

#: Where a cage makes the triangles of objects → what is said of that.
MAKERS: dict[Objects, str] = {"nodes": "objects in nodes", "elements": "objects in elements",
                              "controller": "objects at the controller"}


def finest(atlas: Atlas) -> FractionBits:
    """The most exact of the precisions that were asked for: the map is of that one."""
    bits = atlas.options.fraction_bits
    return "exact" if "exact" in bits else max(each for each in bits if each != "exact")


def atlas_map(atlas: Atlas) -> dict[str, dict[Cell, Place]]:
    """Name of a measure → cells, in the order in which scenes and sizes were asked for."""
    precision = finest(atlas)
    cells: dict[Cell, list[tuple[AtlasPoint, Figures]]] = {}
    for point, figures in atlas.figures.items():
        if point.fraction_bits == precision:
            cell = Cell(point.scene.name, point.scene.size, figures["machine"]["elements"],
                        str(precision))
            cells.setdefault(cell, []).append((point, figures))
    return {name: {cell: Place(tuple(sorted(
        (Ranked(point, measure.figure(figures)) for point, figures in points),
        key=lambda ranked: ranked.figure))) for cell, points in cells.items()}
        for name, measure in MEASURES.items()}


def kinds(atlas: Atlas) -> list[str]:
    """Of all cages that were asked for, in that order."""
    return list(dict.fromkeys(kind_of(cage) for cage in atlas.options.asked_cages()))


def winners(atlas: Atlas) -> dict[str, dict[str, int]]:
    """Of each measure: kind → in how many cells of the map it is the best, most first."""
    found = {}
    for name, cells in atlas_map(atlas).items():
        counts: dict[str, int] = {}
        for place in cells.values():
            counts[place.best.kind] = counts.get(place.best.kind, 0) + 1
        found[name] = dict(sorted(counts.items(), key=lambda item: -item[1]))
    return found
