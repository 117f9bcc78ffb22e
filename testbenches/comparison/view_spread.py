"""A cage's figures over several views of one scene, and how far they spread."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

from ...golden.balancing.table_policy import Policy
from ...golden.merging.cage import merge_cage
from ...golden.specification.configuration import MachineConfiguration
from ...golden.specification.display_list import DisplayList
from ..frames.node_counts import count_differences, node_figures, unit_differences
from ..frames.wrong_counts import wrong_counts
from ..sequence.sequence_run import SequenceFrame, simulate_sequence
from ..views.scene_frames import SceneFrames


@dataclass(frozen=True)
class ViewFigures:
    """What a cage did for one view.

    ``differences``   a line each: what is not as the golden model has it
    ``busiest_share`` the most fragments of a node, as a part of all; 0 where there are none
    ``sent``          pixels between nodes, in the machine's own count
    """

    differences: Sequence[str]
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
               memory_seed: int | None, policy: Policy | None = None) -> list[ViewFigures]:
    """Every view on one machine, which is booted once; raises what ``simulate_sequence`` does."""
    return [_figures(configuration, lists[frame.number], frame) for frame in simulate_sequence(
        configuration, lists, engine, triangles=lists.most_triangles, memory_seed=memory_seed,
        policy=policy)]


def _figures(configuration: MachineConfiguration, display_list: DisplayList,
             frame: SequenceFrame) -> ViewFigures:
    simulation = frame.simulation
    golden = merge_cage(configuration, display_list)[1]
    nodes = node_figures(configuration, display_list, simulation, golden)
    differences = [] if frame.equal else ["the picture differs from the golden one"]
    differences += [*wrong_counts(frame.regions, frame.objects), *count_differences(nodes),
                    *unit_differences(simulation, golden)]
    sent = nodes[:-1] if configuration.scans_rank else nodes  # not to the pins
    fragments = [node.fragments for node in nodes]
    draw, merged = simulation.draw_cycles, simulation.merge_cycles
    return ViewFigures(differences, draw, 0 if merged is None else merged - draw, sum(fragments),
                       max(fragments) / max(sum(fragments), 1), sum(node.sent for node in sent))


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
