"""Scenes times cages times sizes times precisions, each point by model or in RTL."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterable, Sequence
from contextlib import ExitStack
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

from ...golden.specification.card_order import MAXIMUM_NODES
from ...golden.specification.errors import InputError
from ..comparison.cage import Cage
from ..comparison.node_sweep import repeated, repeated_piece
from ..engines.choose_engine import AUTO, make_engine
from ..machine_options import MachineOptions
from ..support.atomic_output import atomic_folder, output_errors
from ..support.counted import counted
from ..support.interruption import saying
from .points.atlas_point import AtlasPoint, Failure, Figures, FractionBits
from .points.atlas_scene import AtlasScene
from .points.node_check import can_check_node
from .running.sweep import KEPT, Done, Sweep
from .running.workers import workers_for

#: Of few large triangles and of many small ones, of one layer and of several.
DEFAULT_SCENES = ("three_cubes", "crystals", "teapot", "capsid", "sphereflake")

#: One of each kind; with lists in the nodes and without.
DEFAULT_CAGES = ("4x(PMM)", "4x(PMM)/8x8", "4x(PMMC)", "4x(PMMT)", "4x(PMMS)FF", "4xPD8xM")

#: Of the default cages.
DEFAULT_NODES = (4, 16)

DEFAULT_SIZES = ((64, 64), (256, 256))

#: None, two, and as many as each scene needs.
DEFAULT_FRACTION_BITS: tuple[FractionBits, ...] = (0, 2, "exact")

#: Scenes or cages that a warning names.
MOST_NAMES = 12

#: Ports of a memory unit's RAM: as FPGAs have them, and what the cycle model knows to the clock.
DEFAULT_PORTS = 2


@dataclass(frozen=True)
class AtlasOptions:
    """What can be asked of an atlas.

    ``scenes``         as of every command
    ``cages``          as ``Cage.named`` reads them; none: the default ones
    ``nodes``          each cage's smallest piece that repeats is taken so often; none: as it is
    ``sizes``          of the pictures
    ``fraction_bits``  numbers of them, or ``exact``
    ``retain``         cages of nodes with lists (True), without (False), or both; those that make
                       the triangles of objects have none
    ``simulate``       each point in RTL, too
    ``check_node``     one node of each chain and tree with lists, at exact precision, in RTL
    ``engine``         a name of ``engines.ENGINES`` or ``auto``
    ``machine``        of all cages, and how scenes are looked at
    ``cluster``        the address of a Dask scheduler, or ``local``; None: this machine's cores
    ``processes``      on this machine, as many as there are cores where that is None
    """

    scenes: Sequence[str] = DEFAULT_SCENES
    cages: Sequence[str] = ()
    nodes: Sequence[int] = ()
    sizes: Sequence[tuple[int, int]] = DEFAULT_SIZES
    fraction_bits: Sequence[FractionBits] = DEFAULT_FRACTION_BITS
    retain: bool | None = None
    simulate: bool = False
    check_node: bool = False
    engine: str = AUTO
    machine: MachineOptions = field(default_factory=MachineOptions)
    cluster: str | None = None
    processes: int | None = None

    def __post_init__(self) -> None:
        for nodes in self.nodes:
            if not 1 <= nodes <= MAXIMUM_NODES:
                raise InputError(f"--nodes: {nodes} is not from 1 to {MAXIMUM_NODES}; nodes may "
                                 "have several elements each, as in 64x(16x(PM)C)")
        if self.cluster is not None and self.processes is not None:
            raise InputError("--processes: a cluster has its own; leave it out, or --cluster")
        if self.machine.setup not in (None, "host"):
            raise InputError("--setup: controllers with a set-up were not counted, so that nobody "
                             "knows how large such a machine is; leave it out")

    def asked_cages(self) -> list[Cage]:
        """Every cage, of cages of nodes first the one that is sent its triangles in each frame."""
        nodes = self.nodes or (() if self.cages else DEFAULT_NODES)
        found: dict[Cage, None] = {}
        for name in self.cages or DEFAULT_CAGES:
            named = Cage.named(name)
            spelled = named.spelled or ""
            lists = [False, True] if self.retain is None else [self.retain]
            for retained in lists if named.can_retain else [False]:
                for cards in ([repeated(repeated_piece(spelled), number) for number in nodes]
                              if spelled and nodes else [named.cards]):
                    found[replace(named, cards=cards, retained=retained)] = None
        return list(found)

    def points(self) -> list[AtlasPoint]:
        """Precision after precision of one machine, then the next machine.  Raises ``InputError``
        for a scene that cannot be read, or not at such a size."""
        machine = replace(self.machine, memory_ports=self.machine.memory_ports or DEFAULT_PORTS)
        if self.simulate or self.check_node:
            make_engine(self.engine)  # one that cannot run is no fault of a point's
        found = []
        for name in self.scenes:
            for size in self.sizes:
                scene = AtlasScene.of(name, size, machine)
                for cage in self.asked_cages():
                    for bits in dict.fromkeys(self.fraction_bits):
                        check = self.check_node and bits == "exact" and can_check_node(cage)
                        found.append(AtlasPoint(
                            scene, cage, bits, machine, self.simulate, check,
                            self.engine if self.simulate or check else None))
        if not found:
            raise InputError("atlas: there is nothing to measure; give a scene, a size and a cage")
        if self.check_node and not any(point.check_node for point in found):
            raise InputError("--check-node: there is no chain or tree with lists among the points, "
                             "of two nodes or more than three, at exact precision; name one, such "
                             "as --cages '64x(16x(PM)C)' --retain")
        return found


@dataclass(frozen=True, eq=False)
class Atlas:
    """All points that were asked for.

    ``figures``   of those that have some
    ``failures``  of the others
    ``recalled``  how many were measured before
    ``report``    where ``atlas.html`` is, if it was written
    """

    options: AtlasOptions
    figures: dict[AtlasPoint, Figures]
    failures: dict[AtlasPoint, Failure]
    recalled: int
    warnings: Sequence[str]
    command_line: str | None
    wall_seconds: float
    report: Path | None = None

    @property
    def differences(self) -> list[str]:
        """A line for each point whose machine, picture or process is wrong."""
        return [f"{point.label}: {failure.reason}" for point, failure in self.failures.items()
                if failure.failed]

    @property
    def refused(self) -> list[str]:
        """A line for each reason why there can be no such machine: how many points have it, of
        which scenes and cages."""
        reasons: dict[str, list[AtlasPoint]] = {}
        for point, failure in self.failures.items():
            if not failure.failed:
                reasons.setdefault(failure.reason, []).append(point)
        return [f"{_several(point.scene.name for point in points)} on "
                f"{_several(point.cage.label for point in points)}, "
                f"{counted(len(points), 'point')}: {reason}" for reason, points in reasons.items()]


def _several(names: Iterable[str]) -> str:
    """Each once, in their order; of many the first ones alone, and how many more there are."""
    found = list(dict.fromkeys(names))
    more = len(found) - MOST_NAMES
    return ", ".join(found) if more <= 1 else (
        f"{', '.join(found[:MOST_NAMES])} and {more:,} more")


def make_atlas(options: AtlasOptions | None = None, *, out: str | Path | None = None,
               command_line: str | None = None,
               bar: Callable[[int], Any] | None = None) -> Atlas:
    """Measure every point, or recall it, and write the page.

    ``out``  folder of the report; None writes none
    ``bar``  makes of the number of points a context of a function that is told of points found

    Raises ``InputError`` for what cannot be used or written, and where no point has figures.
    """
    options = options or AtlasOptions()
    if out is None:
        return _measured(options, command_line, bar)
    from .atlas_report import ATLAS_FILES, write_atlas

    out = Path(out)
    with atomic_folder(out, ATLAS_FILES) as folder:
        atlas = replace(_measured(options, command_line, bar), report=out / "atlas.html")
        with output_errors(out, "--out"), saying(lambda: KEPT):
            write_atlas(atlas, folder)
    return atlas


def _measured(options: AtlasOptions, command_line: str | None,
              bar: Callable[[int], Any] | None) -> Atlas:
    began = time.perf_counter()
    sweep = Sweep(options.points(), workers_for(options.cluster, options.processes))
    with ExitStack() as shown:
        done: Done = ((lambda points, label: None) if bar is None else
                      shown.enter_context(bar(len(sweep.points))))
        with saying(sweep.what_is_kept):
            found = sweep.run(done)
    figures = {point: outcome for point, outcome in found.items()
               if not isinstance(outcome, Failure)}
    failures = {point: outcome for point, outcome in found.items()
                if isinstance(outcome, Failure)}
    if not figures and not any(failure.failed for failure in failures.values()):
        raise InputError("atlas: no such machine can be built: "
                         + "; ".join(dict.fromkeys(each.reason for each in failures.values())))
    warnings = ([] if sweep.not_kept is None else
                [f"results are not kept, so that they are measured again the next time "
                 f"({sweep.not_kept}); CARDCAGE_CACHE names another folder"])
    atlas = Atlas(options, figures, failures, sweep.recalled, warnings, command_line,
                  time.perf_counter() - began)
    return replace(atlas, warnings=[*warnings, *atlas.refused])
