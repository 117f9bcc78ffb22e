"""A finished rendering: what was asked, what the machine did, and the verdict."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

from ...golden.merging.traffic import Traffic
from ...golden.scene_display_list import SceneDisplayList
from ...golden.specification.configuration import MachineConfiguration
from .compare import Comparison
from .object_figures import ObjectFigures
from .region_figures import RegionFigures
from .responses import Simulation


@dataclass(frozen=True, eq=False)
class Rendering:
    """One frame of one scene on one machine, judged.

    ``command_line``  what the user typed, if anything
    ``warnings``      one line each
    ``wall_seconds``  from the scene's name to the verdict
    ``report``        where ``report.html`` is, if it was written
    ``traffic``       what is sent to merge its picture, by the golden model; None where there is
                      one node, or nodes were not asked for their counts
    ``regions``       what regions cost that are dealt out; None where there are none
    ``objects``       what was made of objects; None where the machine takes none
    ``wrong_counts``  a line for each count that is not the golden model's; all are ``warnings``
    """

    scene: SceneDisplayList
    configuration: MachineConfiguration
    simulation: Simulation
    comparison: Comparison
    command_line: str | None
    warnings: tuple[str, ...]
    wall_seconds: float
    report: Path | None = None
    traffic: Traffic | None = None
    regions: RegionFigures | None = None
    objects: ObjectFigures | None = None
    wrong_counts: tuple[str, ...] = ()

    @property
    def equal(self) -> bool:
        """The picture and every count are as the golden model has them."""
        return self.comparison.equal and not self.wrong_counts

    @property
    def fragments(self) -> int:
        """Fragments that the processing elements counted."""
        return sum(work.fragments for work in self.simulation.work)

    @property
    def efficiency(self) -> float:
        """Fragments per cycle and processing element while the frame was drawn."""
        cycles = self.configuration.processing_elements * self.simulation.draw_cycles
        return self.fragments / cycles if cycles else 0.0

    @property
    def cycles_per_second(self) -> float:
        """Simulated cycles per second of wall time."""
        return self.simulation.cycles / max(self.simulation.seconds, 1e-9)
