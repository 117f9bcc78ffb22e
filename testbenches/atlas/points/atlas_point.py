"""A point of the atlas: one scene on one cage, at one size and one precision."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any, Literal

from ....golden.planning.machine_plan import plan
from ....golden.specification.configuration import MachineConfiguration
from ...comparison.cage import Cage
from ...machine_options import MachineOptions
from .atlas_scene import AtlasScene

FractionBits = int | Literal["exact"]

#: What is known of a point: words, numbers, and objects of these.
Figures = dict[str, Any]


@dataclass(frozen=True)
class AtlasPoint:
    """Everything that a result depends on.

    ``cage``           its cards, and how it is used: lists, regions
    ``fraction_bits``  of depth and colour
    ``options``        of the machine, whatever the cage
    ``simulate``       in RTL as well; else the models alone are asked
    ``check_node``     simulate one of its nodes, with what the model says of its ports
    ``engine``         that simulates; None where nothing is simulated
    """

    scene: AtlasScene
    cage: Cage
    fraction_bits: FractionBits
    options: MachineOptions
    simulate: bool = False
    check_node: bool = False
    engine: str | None = None

    @property
    def label(self) -> str:
        width, height = self.scene.size
        return (f"{self.scene.name} {width}x{height} on {self.cage.label}, {self.fraction_bits} "
                "fraction bits")

    @property
    def asked(self) -> MachineOptions:
        """Of all cages; what is for some kinds alone ``Cage.options`` leaves out."""
        return replace(self.options, size=self.scene.size, fraction_bits=self.fraction_bits)

    def machine(self) -> MachineConfiguration:
        """The one that its scene needs.  Raises ``InputError``."""
        display_list = self.scene.load().display_list
        return plan(display_list, **self.cage.options(self.asked).for_plan()).configuration


@dataclass(frozen=True)
class Failure:
    """A point without figures: ``failed``, its machine or its picture is wrong, or its process
    ended; else there can be no such machine."""

    reason: str
    failed: bool
