"""How far what comes out depends on costs that the thesis does not print, or prints wrongly."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import Any

from ....support.measurement_cache import measured_once, package_hash
from ..scenes.spheres import NODES, SCALE, Size
from .costs import COSTS, MICROSECOND, Costs
from .methods import Scene
from .times import BROADCAST_STRIPS, GRID, LINES, METHODS, NODE, STRIPS, USUAL_HOST

#: On the most nodes, so many spheres.
SPHERES = 512

#: What is shown.
SHOWN = (USUAL_HOST, NODE, STRIPS, GRID, LINES, BROADCAST_STRIPS)


#: A scene of so many spheres where what an axis varies has a value.
Changed = Callable[[Size, float], Scene]


@dataclass(frozen=True)
class Axis:
    """``name`` and ``unit`` of what is varied, ``usual``, what it is otherwise, and ``values``."""

    name: str
    unit: str
    usual: float
    values: Sequence[float]
    scene: Changed


def _at_costs(changed: Callable[[float], Costs]) -> Changed:
    return lambda size, value: Scene.of(size, 0, SPHERES, changed(value))


def _drawing(factor: float) -> Costs:
    return replace(COSTS, polygon=COSTS.polygon * factor, line=COSTS.line * factor,
                   pixel=COSTS.pixel * factor)


TESSELLATING = "tessellating a polygon"
BYTE = "a byte of a message"
DRAWING = "drawing, all of it"
SIZE_OF_SPHERES = "scale of a sphere"
SCREEN = "side of the screen"

AXES = (
    Axis(TESSELLATING, "µs", COSTS.tessellate / MICROSECOND,
         (1, 3, 10, 30, 75, 150, 300, 600, 1500),
         _at_costs(lambda value: replace(COSTS, tessellate=value * MICROSECOND))),
    Axis(BYTE, "µs", COSTS.byte / MICROSECOND, (0.04, 0.13, 0.4, 1.3, 4, 13, 40, 400, 4000),
         _at_costs(lambda value: replace(COSTS, byte=value * MICROSECOND))),
    Axis(DRAWING, "times as much", 1.0, (0.01, 0.03, 0.1, 0.3, 1, 3, 10, 30, 100),
         _at_costs(_drawing)),
    Axis(SCREEN, "pixels", 512, (64, 96, 128, 192, 256, 384, 512, 768, 1024),
         lambda size, value: Scene.of((int(value), int(value)), 0, SPHERES)),
    Axis(SIZE_OF_SPHERES, "of half the screen", SCALE, (0.03, 0.05, 0.1, 0.15, 0.25, 0.4, 0.6, 0.9),
         lambda size, value: Scene.of(size, 0, SPHERES, scale=value)),
)


@dataclass(frozen=True)
class SensitivityJob:
    """Of one of ``AXES``, by its name."""

    axis: str
    size: Size

    def run(self) -> Sensitivity:
        return Sensitivity(**measured_once(
            [package_hash(), "blazek's sensitivity", repr(self)], self._measure))

    def _measure(self) -> dict[str, Any]:
        axis = axis_of(self.axis)
        return {"axis": axis.name, "speed_up": {
            method: [speed_up(method, axis.scene(self.size, value)) for value in axis.values]
            for method in SHOWN}}


@dataclass(frozen=True)
class Sensitivity:
    """``speed_up`` of each method of ``SHOWN``, along the values of the axis of that name."""

    axis: str
    speed_up: dict[str, list[float]]


def axis_of(name: str) -> Axis:
    return next(axis for axis in AXES if axis.name == name)


def speed_up(method: str, scene: Scene) -> float:
    """On the most nodes."""
    one, most = (METHODS[method](scene, nodes).seconds for nodes in (1, NODES[-1]))
    return one / most


def sensitivity_jobs(size: Size) -> list[SensitivityJob]:
    return [SensitivityJob(axis.name, size) for axis in AXES]
