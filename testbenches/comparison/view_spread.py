"""A cage's figures over several views of one scene, and how far they spread."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

from ...golden.specification.configuration import MachineConfiguration
from ..sequence.scene_frames import SceneFrames
from ..sequence.sequence_run import SequenceFrame, simulate_sequence


@dataclass(frozen=True)
class ViewFigures:
    """What a cage did for one view.

    ``equal``         it was the golden picture, on every scan
    ``busiest_share`` the most fragments of a node, as a part of all; 0 where there are none
    ``sent``          pixels between nodes, in the machine's own count
    """

    equal: bool
    draw: int
    merge: int
    fragments: int
    busiest_share: float
    sent: int


@dataclass(frozen=True)
class Spread:
    """The least, the mean and the greatest of a figure over all views."""

    least: float
    mean: float
    greatest: float

    @classmethod
    def of(cls, values: Sequence[float]) -> Spread:
        return cls(min(values), sum(values) / len(values), max(values))


def draw_views(configuration: MachineConfiguration, lists: SceneFrames, engine: str,
               memory_seed: int | None) -> list[ViewFigures]:
    """Every view on one machine, which is booted once; raises what ``simulate_sequence`` does."""
    return [_figures(configuration, frame) for frame in simulate_sequence(
        configuration, lists, engine, triangles=lists.most_triangles, memory_seed=memory_seed)]


def _figures(configuration: MachineConfiguration, frame: SequenceFrame) -> ViewFigures:
    simulation = frame.simulation
    sent = simulation.sent[:-1] if configuration.scans_rank else simulation.sent  # not to the pins
    drawn: dict[int, int] = {}
    for work in simulation.work:
        drawn[work.node] = drawn.get(work.node, 0) + work.fragments
    fragments = sum(drawn.values())
    draw, merged = simulation.draw_cycles, simulation.merge_cycles
    return ViewFigures(frame.equal, draw, 0 if merged is None else merged - draw, fragments,
                       max(drawn.values()) / max(fragments, 1), sum(sent))


#: The figures whose spread is told, by what they are called.
SPREAD: dict[str, Callable[[ViewFigures], float]] = {
    "draw": lambda view: view.draw,
    "merge": lambda view: view.merge,
    "fragments": lambda view: view.fragments,
    "busiest_node_share": lambda view: view.busiest_share,
    "pixels_sent": lambda view: view.sent,
}


def spreads(views: Sequence[ViewFigures]) -> dict[str, Spread]:
    """Of each figure; ``views`` are one at least."""
    return {name: Spread.of([figure(view) for view in views]) for name, figure in SPREAD.items()}
