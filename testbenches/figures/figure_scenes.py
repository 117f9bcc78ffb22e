"""The scenes of the figures: meshes, random triangles like those of the paper's table, and one
with its background first."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import Literal

import numpy as np

from ...golden.scene_argument import BuiltInScene, parse_scene
from ...golden.scene_display_list import make_display_list
from ...golden.specification.display_list import DisplayList
from ...golden.specification.errors import InputError
from .paper_table import PaperRow, paper_rows

#: Where a triangle behind all others stands in the list.
Background = Literal["first", "last"]

Size = tuple[int, int]

#: Of a triangle with its corners anywhere in a square, as a part of the square, on average.
MEAN_AREA = 11 / 144

#: Of the random triangles.
SEED = 1

MESHES = {"teapot": "teapot:tessellation=29", "sphereflake": "sphereflake",
          "spheres": "spheres:count=200,depth=3", "tetra": "tetra:depth=6",
          "terrain": "terrain:step=2"}

#: The row of the paper's table whose scene has its background first.
BACKGROUND_ROW = "Zinnia"


@dataclass(frozen=True)
class FigureScene:
    """``scene`` is a scene's name as for any command; ``row`` of the paper's table that it is made
    after, if it is; ``background`` where a triangle behind everything, and as large as the screen,
    stands in its list, if there is one."""

    name: str
    scene: str
    row: str = ""
    background: Background | None = None

    @property
    def given(self) -> int:
        """Its triangles, before any is left out."""
        parsed = parse_scene(self.scene)
        assert isinstance(parsed, BuiltInScene)
        return parsed.triangles + (self.background is not None)

    def display_list(self, size: Size) -> DisplayList:
        width, height = size
        display_list = make_display_list(self.scene, width=width, height=height,
                                         shading="flat").display_list
        return (display_list if self.background is None
                else with_background(display_list, self.background))


def with_background(display_list: DisplayList, place: Background) -> DisplayList:
    """The list in the nearer half of all depths, and one triangle behind it that covers the
    screen."""
    unit, width, height = 1 << display_list.sub_bits, display_list.width, display_list.height
    corners = np.array([[width, height], [-width, height], [width, -height]])
    behind = replace(display_list, position=(corners[None] * unit).astype(np.int32),
                     depth=np.full((1, 3), display_list.depth_limit),
                     color=np.full((1, 3, 3), 96, np.uint8))
    whole = behind.followed_by(replace(display_list, depth=display_list.depth // 2))
    return whole if place == "first" else whole.chosen(np.roll(np.arange(whole.triangles), -1))


def random_like(row: PaperRow, size: Size) -> str:
    """Random triangles of the row's mean size, by its counts, as many as make its depth."""
    count = max(1, round(row.found_depth * size[0] * size[1] / row.found_size))
    return f"random:n={count},size={_side(row):.2f},seed={SEED}"


def _side(row: PaperRow) -> float:
    """Of the square that each triangle lies in."""
    return math.sqrt(row.found_size / MEAN_AREA)


def figure_scenes(size: Size) -> list[FigureScene]:
    """In the order of the page.  Raises ``InputError`` where the screen is smaller than what the
    largest of the random triangles lie in."""
    largest = max(paper_rows(), key=_side)
    if _side(largest) > min(size):
        least = math.ceil(_side(largest))
        raise InputError(f"size: {size[0]}x{size[1]} is too small for triangles like those of "
                         f"{largest.name}; take {least}x{least} at least")
    found = [FigureScene(name, scene) for name, scene in MESHES.items()]
    places: tuple[Background, ...] = ("first", "last")
    for row in paper_rows():
        scene = random_like(row, size)
        found.append(FigureScene(f"random as {row.name}", scene, row.name))
        if row.name == BACKGROUND_ROW:
            found += [FigureScene(f"background {place}", scene, "", place) for place in places]
    return found
