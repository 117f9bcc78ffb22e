"""What every kind of merge costs on sixteen nodes: clocks, traffic, memory, logic.

Cages are simulated, lists retained; boards on an ECP5 are those that ``cardcage boards`` measures.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

from ...golden.scene_display_list import SceneDisplayList
from ...golden.specification.card_order import (
    CHAIN_MERGE,
    DIRECT_MERGE,
    FRAME_UNIT,
    MEMORY_UNIT,
    PROCESSING_ELEMENT,
    SNOOP_MERGE,
    TREE_MERGE,
    parse_cards,
)
from ...golden.specification.errors import InputError
from ..comparison.cage import Cage, CageJob, Refused
from ..comparison.comparison_facts import cage_facts
from ..machine_options import MachineOptions
from ..support.machine_error import MachineError
from ..support.measurement_cache import measured_once, package_hash
from .figure_scenes import FigureScene, Size

#: Elements of every cage, each a node.
NODES = 16

#: Memory units of each element.
UNITS = 2

#: Of the screen at most: cages of so many nodes simulate slowly.
MOST_SIDE = 256

#: The scenes, by their names among the figures.
MERGE_SCENES = ("teapot", "sphereflake")


@dataclass(frozen=True)
class BoardFigures:
    """On an ECP5 of speed grade 6: LUT4 + 2 CCU2C, and the median clock rate."""

    luts: int
    mhz: float


@dataclass(frozen=True)
class MergeCage:
    """``boards``: by the letter of each card what it is placed as, of ``fpga.boards.BOARDS``; those
    that are of no node, whose size is that of the cage, as they are in this cage."""

    merge: str
    cards: str
    boards: Mapping[str, str]

    def luts(self, boards: Mapping[str, BoardFigures]) -> int | None:
        """Of all cards; None where some of them were not measured."""
        if not all(name in boards for name in self.boards.values()):
            return None
        return sum(boards[self.boards[card]].luts for card in parse_cards(self.cards))


def _boards(unit: str, merge: str, card: str) -> dict[str, str]:
    return {PROCESSING_ELEMENT: "element", MEMORY_UNIT: unit, merge: card}


CAGES = (
    MergeCage(CHAIN_MERGE, f"{NODES}x(PMMC)",
              _boards("unit-of-chain", CHAIN_MERGE, "chain-merge")),
    MergeCage(TREE_MERGE, f"{NODES}x(PMMT)", _boards("unit-of-tree", TREE_MERGE, "tree-merge")),
    MergeCage(SNOOP_MERGE, f"{NODES}x(PMMS)FF",
              _boards("unit-of-snoop", SNOOP_MERGE, "snoop-merge") | {FRAME_UNIT: "frame-unit"}),
    MergeCage(DIRECT_MERGE, f"{NODES}xP D {NODES}xM",
              {PROCESSING_ELEMENT: "element-of-direct", MEMORY_UNIT: "unit-of-direct",
               DIRECT_MERGE: "direct-merge"}),
)


@dataclass(frozen=True)
class MergeCosts:
    """A cage that drew a scene; ``facts`` as in ``comparison.json``, ``board`` of its merge card
    and ``cage_luts`` of all its cards, where they were measured."""

    cage: MergeCage
    scene: str
    facts: dict[str, Any]
    board: BoardFigures | None
    cage_luts: int | None

    @property
    def fragments_per_clock(self) -> float:
        """Drawn and merged."""
        cycles = self.facts["cycles"]
        return float(self.facts["fragments"] / max(cycles["draw"] + cycles["merge"], 1))

    @property
    def per_lut(self) -> float | None:
        """Fragments a clock for each LUT of the cage."""
        return None if self.cage_luts is None else self.fragments_per_clock / self.cage_luts

    @property
    def differences(self) -> list[str]:
        return [f"{self.cage.cards}, {self.scene}: {line}" for line in self.facts["differences"]]


@dataclass(frozen=True)
class MergeJob:
    cage: MergeCage
    scene: FigureScene
    size: Size
    engine: str

    def run(self) -> dict[str, Any]:
        """The facts.  Raises ``InputError`` and ``MachineError``."""
        return measured_once([package_hash(), "merge costs", repr(self)], self._measure)

    def _measure(self) -> dict[str, Any]:
        scene = SceneDisplayList(self.scene.display_list(self.size), self.scene.name)
        run = CageJob(Cage(self.cage.cards, retained=True), scene,
                      MachineOptions(memory_ports=2, packet=1, shading="flat"), self.engine).run()
        if isinstance(run, Refused):
            raise (MachineError if run.failed else InputError)(str(run))
        return cage_facts(run)


def merge_size(size: Size) -> Size:
    """Of the cages' screen, where the figures have ``size``."""
    width, height = size
    return min(width, MOST_SIDE), min(height, MOST_SIDE)


def board_figures(measure: bool, step: Callable[[str], None]) -> dict[str, BoardFigures]:
    """Those of all boards of ``CAGES`` that were measured before; all of them where they are to be
    measured, some minutes each.  Raises ``InputError`` where the tools are missing or fail."""
    from ..fpga.boards import BOARDS  # loads Amaranth
    from ..fpga.place_and_route import place_and_route, recall_placement
    from ..speed.cases import SIZE

    found = {}
    cages = {name: cage.cards for cage in CAGES for name in cage.boards.values()}
    for name, cards in cages.items():
        board = BOARDS[name]
        part = replace(board, cage=board.cage and cards).part("P" + "M" * UNITS, SIZE, SIZE)
        if measure:
            def board_step(doing: str, name: str = name) -> None:
                step(f"{name}: {doing}")

            board_step("synthesising")
            placed = place_and_route(part, (1,), board_step)
        else:
            recalled = recall_placement(part, (1,))
            if recalled is None:
                continue
            placed = recalled
        found[name] = BoardFigures(placed.luts, placed.median_mhz)
    return found


def merge_costs(jobs: Sequence[MergeJob], facts: Sequence[dict[str, Any]],
                boards: Mapping[str, BoardFigures]) -> list[MergeCosts]:
    """What the jobs found, with their boards."""
    return [MergeCosts(job.cage, job.scene.name, found,
                       boards.get(job.cage.boards.get(job.cage.merge, "")), job.cage.luts(boards))
            for job, found in zip(jobs, facts, strict=True)]
