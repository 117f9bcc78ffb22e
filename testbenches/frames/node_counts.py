"""What the nodes of a cage count for a picture, beside what the golden model says."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from ...golden.cycles.node_work import share_of_node
from ...golden.merging.cage import merge_cage
from ...golden.merging.direct import DirectTraffic
from ...golden.merging.traffic import Traffic
from ...golden.organisations.organisation_of import organisation_of
from ...golden.reference.exact import depth_complexity
from ...golden.specification.configuration import MachineConfiguration
from ...golden.specification.display_list import DisplayList
from .responses import Simulation


@dataclass(frozen=True, eq=False)
class NodeFigures:
    """What one node did for a picture, in the machine's own count, and golden's.

    ``sent``  pixels to the next node, to frame units, to memory units, or to the pins
    """

    fragments: int
    golden_fragments: int
    sent: int
    golden_sent: int


def golden_traffic(configuration: MachineConfiguration, display_list: DisplayList,
                   simulation: Simulation) -> Traffic | None:
    """What is sent to merge the picture; None where there is one node, or the counters that tell
    of it were not read."""
    if not organisation_of(configuration).merges or not simulation.work:
        return None
    return merge_cage(configuration, display_list)[1]


def node_figures(configuration: MachineConfiguration, display_list: DisplayList,
                 simulation: Simulation, golden: Traffic) -> list[NodeFigures]:
    """Of each node, left to right; the counters were read."""
    organisation = organisation_of(configuration)
    sent, golden_sent = simulation.sent or [0], golden.sent
    if configuration.scans_rank:  # the last one's: to the pins
        golden_sent[-1] = configuration.width * configuration.height
    return [NodeFigures(
        fragments=sum(work.fragments for work in simulation.work if work.node == node),
        golden_fragments=int(depth_complexity(
            share_of_node(configuration, display_list, node)[1],
            **organisation.resolution.shifts).sum()),
        sent=sent[node], golden_sent=golden_sent[node]) for node in range(organisation.nodes)]


def count_differences(nodes: Sequence[NodeFigures]) -> list[str]:
    """A line for each count that is not golden's."""
    return [f"node {number} {verb} {got:,} {what}, golden {wanted:,}"
            for number, node in enumerate(nodes)
            for verb, what, got, wanted in (
                ("drew", "fragments", node.fragments, node.golden_fragments),
                ("sent", "pixels", node.sent, node.golden_sent))
            if got != wanted]


def unit_differences(simulation: Simulation, golden: Traffic) -> list[str]:
    """The same for what memory units took from all elements."""
    wanted = golden.taken.sum(axis=0).tolist() if isinstance(golden, DirectTraffic) else []
    return [f"memory unit {unit} took {got:,} fragments, golden {of_golden:,}"
            for unit, (got, of_golden) in enumerate(zip(simulation.taken, wanted, strict=True))
            if got != of_golden]
