"""The machines on which each of Blazek's decompositions draws the example scenes."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any, Literal, get_args

from cardcage.testbenches.machine_options import SETUPS

from .broadcast_rates import ways

Decomposition = Literal["host", "nodes", "forwarding", "broadcast"]
DECOMPOSITIONS: tuple[Decomposition, ...] = get_args(Decomposition)

#: Of merge cards; a bus of one node is no bus.
MERGES = "CT"

#: In between: a controller that makes all triangles is to be slow enough to be small, and fast
#: enough to make 128,000 of them.
_AT_CONTROLLER = {"setup": "hardware", "setup_interval": 8}


@dataclass(frozen=True)
class DecompositionCage:
    """One machine.

    ``decomposition``  of the four
    ``nodes``          or processing elements, where all are one node's
    ``cards``          their order
    ``how``            the picture is shared, or pictures are merged
    ``fields``         of the configuration, besides
    ``perspective``    draws scenes in perspective, which have no objects
    ``orthographic``   draws those that have
    """

    decomposition: Decomposition
    nodes: int
    cards: str
    how: str
    fields: dict[str, Any]
    perspective: bool = False
    orthographic: bool = True


def decomposition_cages(decomposition: Decomposition, nodes: int,
                        height: int) -> Iterator[DecompositionCage]:
    """All kinds of that decomposition, for a picture of that height."""
    merged = {f"merge {card}": f"{nodes}x(PMM{card})" for card in MERGES}
    shared = {how: fields for how, fields in ways(nodes, height).items()
              if decomposition == "broadcast" or how in ("strips", "grid")}
    alone = f"{nodes}x(PM)"
    if decomposition == "host":
        for how, cards in merged.items():
            yield DecompositionCage(decomposition, nodes, cards, how, {"packet": 10},
                                    perspective=True)
    elif decomposition == "nodes":
        for how, cards in merged.items():
            yield DecompositionCage(decomposition, nodes, cards, how,
                                    SETUPS["small"] | {"packet": 1, "objects": "nodes"})
    elif decomposition == "forwarding":
        for how, fields in shared.items():
            yield DecompositionCage(decomposition, nodes, alone, how, SETUPS["small"] | fields | {
                "packet": 1, "objects": "elements"})
    else:
        for how, fields in shared.items():
            yield DecompositionCage(decomposition, nodes, alone, how, _AT_CONTROLLER | fields | {
                "objects": "controller"})
            yield DecompositionCage(decomposition, nodes, alone, f"{how}, triangles", fields,
                                    perspective=True, orthographic=False)
