"""Draw one scene on several cages and compare what they show and what it costs."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterable, Sequence
from contextlib import ExitStack
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np

from ...golden.objects.object_words import made_of_objects
from ...golden.scene_display_list import SceneDisplayList, description_of
from ...golden.specification.card_order import MAXIMUM_NODES
from ...golden.specification.errors import InputError
from ...golden.specification.fields.making import Objects
from ..engines.choose_engine import AUTO, make_engine
from ..machine_options import MachineOptions, load_scene
from ..render import DEFAULT_SCENE
from ..support.atomic_output import atomic_folder, output_errors
from ..support.processes import run_jobs
from ..views.scene_frames import SceneFrames
from .cage import Cage, CageJob, CageRun, Refused
from .node_sweep import Curve, Place, Point, PointJob, curves_of, places, time_of

#: As many processing elements and memory units in one node and in four.
DEFAULT_CARDS = ("4x(PMM)", "4x(PMMC)", "4x(PMMT)")

#: Cages of a sweep are simulated up to so many nodes.
DEFAULT_SIMULATE = 4

#: Where triangles of objects are made: a cage that makes them there.
_MAKES_TRIANGLES = {"controller": "4x(PMM)", "nodes": "4x(PMMC)", "elements": "4x(PMM)/1x4"}

#: Told before each step what is begun.
Step = Callable[[str], None]


def default_cards(scene: str | Path) -> tuple[str, ...]:
    """Three kinds of cages of as many elements, or nodes, as a scene file says; elements of one
    node are the next power of two.  Raises ``InputError``."""
    description = description_of(scene)
    if description is None or description.nodes is None:
        return DEFAULT_CARDS
    nodes = description.nodes
    return f"{1 << (nodes - 1).bit_length()}x(PMM)", f"{nodes}x(PMMC)", f"{nodes}x(PMMT)"


@dataclass(frozen=True)
class CompareOptions:
    """What can be asked of a comparison besides ``machine``, which is for all cages.

    ``cards``          a cage each, as ``Cage.named`` reads it
    ``retain``         cages of nodes with list memories (True), without (False), or both
    ``nodes``          of the cages of a sweep; none makes no sweep
    ``simulate``       cages of the sweep are simulated up to so many nodes
    ``cells``          count the cells of the cages
    ``engine``         a name of ``engines.ENGINES`` or ``auto``
    ``random_memory``  seed of the memories' contents before boot; None: zero
    ``processes``      at the same time; as many as there are cores by default
    ``frames``, ``turn``, ``path``  several views of a mesh, as of ``render_frames``
    """

    machine: MachineOptions
    cards: Sequence[str] = DEFAULT_CARDS
    retain: bool | None = None
    nodes: Sequence[int] = ()
    simulate: int = DEFAULT_SIMULATE
    cells: bool = False
    engine: str = AUTO
    random_memory: int | None = None
    processes: int | None = None
    frames: int | None = None
    turn: float | None = None
    path: Path | None = None

    @property
    def seen(self) -> MachineOptions:
        """What is asked of the scene: nothing that only some kinds of cages can be asked."""
        return replace(self.machine, packet=None, queue=None, slots=None, balance=None,
                       balancer=None)

    def views(self, scene: str | Path) -> SceneFrames | None:
        """The scene from all sides, if any were asked for.  Raises ``InputError``."""
        if self.frames is None and self.path is None:
            if self.turn is not None:
                raise InputError("--turn: is for several views; give --frames as well")
            return None
        return SceneFrames(scene, self.seen, frames=self.frames, turn=self.turn, path=self.path)

    def __post_init__(self) -> None:
        for nodes in self.nodes:
            if not 1 <= nodes <= MAXIMUM_NODES:
                raise InputError(f"nodes: {nodes} is not from 1 to {MAXIMUM_NODES}; a cage of a "
                                 "sweep has so many")

        regions = any(Cage.named(cards).regions for cards in self.cards)
        for name in ("slots", "balance", "balancer"):
            if getattr(self.machine, name) is not None and not regions:
                raise InputError(f"--{name}: is for cages whose regions are dealt out; name one, "
                                 "as in 4x(PMM)/8x8, or leave it out")

    def cages(self) -> list[Cage]:
        """Of cages of nodes the one that is sent its triangles in each frame comes first."""
        found: dict[Cage, None] = {}
        for cards in self.cards:
            lists = [False, True] if self.retain is None else [self.retain]
            for retained in lists if Cage.named(cards).can_retain else [False]:
                found[Cage.named(cards, retained)] = None
        return list(found)

    def points(self) -> list[Place]:
        """Of the sweep."""
        return list(places(self.cages(), self.nodes))


def expected_steps(**options: Any) -> int:
    """How many cages there are, those of the sweep as well: for a progress bar.

    ``options`` as in ``compare_cages``.
    """
    asked = CompareOptions(MachineOptions(), **options)
    return len(asked.cages()) + len(asked.points())


@dataclass(frozen=True, eq=False)
class CageComparison:
    """A scene on several cages.

    ``runs``     of the cages that drew it, in the order in which they were asked for
    ``refused``  the other cages, and those of the sweep that there cannot be
    ``curves``   of the sweep
    ``wrong``    simulated cages of the sweep that are not as the golden model has them
    ``report``   where ``comparison.html`` is, if it was written
    """

    scene: SceneDisplayList
    runs: Sequence[CageRun]
    refused: Sequence[Refused]
    curves: Sequence[Curve]
    wrong: Sequence[str]
    command_line: str | None
    wall_seconds: float
    report: Path | None = None

    @property
    def pictures(self) -> list[list[CageRun]]:
        """Cages that show the same picture, and have the same depths, together; the first cage's
        first."""
        groups: list[list[CageRun]] = []
        for run in self.runs:
            group = next((group for group in groups if _same(group[0], run)), None)
            if group is None:
                groups.append([run])
            else:
                group.append(run)
        return groups

    @property
    def differences(self) -> list[str]:
        """A line each: what is not as the golden model has it, and which cage fails."""
        return [*(f"{run.cage.label}: {line}" for run in self.runs for line in run.differences),
                *self.wrong, *(str(each) for each in self.refused if each.failed)]

    @property
    def equal(self) -> bool:
        """Every picture, and every counter, is as the golden model has it."""
        return not self.differences

    @property
    def identical(self) -> bool:
        """They are, and all cages show one picture."""
        return self.equal and len(self.pictures) == 1

    @property
    def warnings(self) -> list[str]:
        """A line each."""
        found = [*self.scene.notes, *(str(each) for each in self.refused if not each.failed)]
        for run in self.runs:
            found += [line if line in run.simulation.notes else f"{run.cage.label}: {line}"
                      for line in run.warnings]
        return list(dict.fromkeys(found))


def _same(one: CageRun, other: CageRun) -> bool:
    depth, others = one.simulation.depth, other.simulation.depth
    assert depth is not None and others is not None  # they are always read
    return (np.array_equal(one.simulation.video, other.simulation.video)
            and np.array_equal(depth, others))


def compare_cages(scene: str | Path = DEFAULT_SCENE, cards: Iterable[str] = DEFAULT_CARDS, *,
                  out: str | Path | None = None, step: Step | None = None,
                  command_line: str | None = None, retain: bool | None = None,
                  nodes: Sequence[int] = (), simulate: int = DEFAULT_SIMULATE, cells: bool = False,
                  engine: str = AUTO, random_memory: int | None = None,
                  processes: int | None = None, frames: int | None = None,
                  turn: float | None = None, path: str | Path | None = None,
                  **machine: Any) -> CageComparison:
    """Draw a scene on several simulated cages, each in a process of its own, and compare them
    with the golden model and with each other.

    ``scene``    a mesh file, a saved display list (``.npz``), ``hard:NAME`` or a built-in scene
    ``cards``    a cage each; one alone may be a string; with regions as in ``4x(PMM)/8x8``, or with
                 where it makes triangles of objects as in ``4x(PMMT)@nodes``
    ``out``      folder of the report; None writes none
    ``step``     is called with a few words as the work begins, and as each cage is done
    ``machine``  the fields of ``MachineOptions`` that are for all cages: ``size``,
                 ``memory_ports``, ``packet`` and the others that the command line has

    The others are the fields of ``CompareOptions``.  Raises ``InputError`` for what cannot be
    used or written, and where no cage can be built for the scene.  Where some can the others are
    ``refused``, and a picture that differs is no exception: see ``equal``.

    >>> import cardcage
    >>> comparison = cardcage.compare_cages("tetra:depth=0", ["PM", "2x(PMC)"], retain=False,
    ...                                     size=(8, 8), engine="pysim")
    >>> comparison.identical, [run.fragments for run in comparison.runs]
    (True, [38, 38])
    """
    cages = (cards,) if isinstance(cards, str) else tuple(cards)
    options = CompareOptions(MachineOptions(**machine), cages, retain, tuple(nodes), simulate,
                             cells, engine, random_memory, processes, frames, turn,
                             None if path is None else Path(path))
    if out is None:
        return _compared(scene, options, command_line, step)
    from .comparison_report import COMPARISON_FILES, write_comparison  # charts take a second

    out = Path(out)
    with ExitStack() as outputs:
        folder = outputs.enter_context(atomic_folder(out, COMPARISON_FILES))
        comparison = replace(_compared(scene, options, command_line, step),
                             report=out / "comparison.html")
        with output_errors(out, "--out"):
            write_comparison(comparison, folder)
    return comparison


def _check_objects(scene: SceneDisplayList, asked: MachineOptions, cages: Sequence[Cage]) -> None:
    """``InputError`` where objects are asked for and the scene has none, or no cage makes any."""
    if asked.objects is None:
        return
    made_of_objects(scene.display_list)
    if not any(cage.makes_triangles(asked) == asked.objects for cage in cages):
        raise InputError(f"objects: none of these cages makes triangles of objects in "
                         f"{asked.objects}; give one that does, such as "
                         f"{_MAKES_TRIANGLES[asked.objects]}, or leave objects out")


def _compared(scene: str | Path, options: CompareOptions, command_line: str | None,
              step: Step | None) -> CageComparison:
    began = time.perf_counter()
    make_engine(options.engine)  # one that cannot run is no fault of a cage's
    views = options.views(scene)
    loaded = load_scene(scene, options.seen) if views is None else views.first
    job = CageJob(Cage(""), loaded, options.machine, options.engine, options.random_memory)
    cages, points = options.cages(), options.points()
    _check_objects(loaded, options.machine, cages)
    known = {(cage.spelled, *_used(cage)) for cage in cages}
    jobs: list[CageJob | PointJob] = [replace(job, cage=cage, cells=options.cells, views=views)
                                      for cage in cages]
    jobs += [PointJob(place, job, place.nodes <= options.simulate and _key(place) not in known)
             for place in points]
    results = run_jobs(jobs, "cages", options.processes, step or (lambda doing: None))
    drawn, found = results[:len(cages)], results[len(cages):]
    runs = [run for run in drawn if isinstance(run, CageRun)]
    refused = [each for each in [*drawn, *found] if isinstance(each, Refused)]
    if not runs and not any(each.failed for each in refused):
        reasons = dict.fromkeys(str(each) for each in refused) or ["no cards were given"]
        raise InputError(f"no cage to compare: {'; '.join(reasons)}")
    return CageComparison(loaded, runs, list(dict.fromkeys(refused)), *_curves(found, runs),
                          command_line, time.perf_counter() - began)


#: How a cage is used: with lists, with regions, and where it makes triangles of objects.
_Used = tuple[bool, tuple[int, int] | None, Objects | None]


def _used(cage: Cage) -> _Used:
    return cage.retained, cage.regions, cage.objects


def _key(place: Place) -> tuple[str | None, bool, tuple[int, int] | None, Objects | None] | None:
    """As which cage of the comparison a point is drawn, if it is one."""
    return None if place.copies > 1 else (place.cage.spelled, *_used(place.cage))


def _curves(found: Sequence[Any], runs: Sequence[CageRun]) -> tuple[list[Curve], list[str]]:
    """The curves, and what is wrong with the cages that were simulated for them alone."""
    compared = {(run.configuration.cards, *_used(run.cage)): run for run in runs}
    points: list[Point] = []
    wrong: list[str] = []
    for result in found:
        if isinstance(result, Refused):
            continue
        point, run = result
        if isinstance(run, Refused):
            wrong.append(str(run))
        elif isinstance(run, CageRun):
            wrong += [f"{run.cage.label}, {point.triangles:,} triangles: {line}"
                      for line in run.differences]
        key = _key(point.place)
        if point.simulated is None and key in compared:
            point = replace(point, simulated=time_of(compared[key]))
        points.append(point)
    return curves_of(points), wrong
