"""What of a plan only cages of nodes have: the order that pixels carry, and lists."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from ..organisations.shares import Shares
from ..specification.commands import list_word_bits
from ..specification.configuration import MachineConfiguration
from ..specification.display_list import DisplayList
from ..specification.errors import InputError
from .node_needs import NodeNeeds
from .plan_line import PlanLine


def needs_of_nodes(machine: MachineConfiguration, display_lists: Sequence[DisplayList],
                   exact_fraction_bits: int, retain: bool) -> list[NodeNeeds]:
    """Of each list; none where all is one node, in which nothing can be retained."""
    if machine.merge is not None:
        return [NodeNeeds(machine, each, exact_fraction_bits) for each in display_lists]
    if retain:
        raise InputError(f"retain: lists are kept in nodes, and {machine.cards} has no merge card; "
                         "end its nodes with one, as in 2x(PMMC)")
    return []


def fields_of_nodes(nodes: Sequence[NodeNeeds], retain: bool, rest: dict[str, Any]
                    ) -> dict[str, int]:
    """The fields that are planned for nodes, those that are given left out.

    A machine that keeps the round of one list keeps those of all.
    """
    planned: dict[str, int] = {}
    if nodes and rest.get("order_bits") is None:
        rounds = any(each.keeps_rounds for each in nodes)
        planned["order_bits"] = max(each.bits_of_rounds if rounds else each.order_bits
                                    for each in nodes)
    if nodes and retain and not rest.get("list_words"):
        planned["list_words"] = max(each.list_words for each in nodes)
    return planned


def check_given(planned: MachineConfiguration, nodes: Sequence[NodeNeeds]) -> None:
    """``InputError`` where too little was asked for."""
    for field, needed, reason, _ in (lack for each in nodes for lack in each.lacks(planned)):
        raise InputError(f"{field}: {getattr(planned, field)} asked for, the display list needs "
                         f"{needed} {reason}; leave it out, or take {needed}")


def lines_of_nodes(planned: MachineConfiguration, full: MachineConfiguration,
                   nodes: Sequence[NodeNeeds], given: int | None) -> list[PlanLine]:
    """The lines; ``given`` is an order that was asked for."""
    shares = max((each.shares for each in nodes), key=lambda shares: shares.rounds)
    reason = "asked for" if given is not None else _order_reason(planned, shares)
    lines = [PlanLine("order bits", str(planned.order_bits), str(full.order_bits), reason,
                      full.round_bits - planned.round_bits)]
    if planned.list_words:
        bits = list_word_bits(planned)
        lines.append(PlanLine(
            "list words", f"{planned.list_words:,}", "-",
            f"the largest of {planned.nodes} shares has "
            f"{max(each.list_words for each in nodes):,} triangles that may "
            f"cover a pixel; {bits} bits each, {planned.list_words * bits:,} in each node"))
    return lines


def _order_reason(planned: MachineConfiguration, shares: Shares) -> str:
    """What decides how many bits of order were planned."""
    rounds = f"{shares.rounds:,} rounds of a packet each"
    if planned.node_order_bits:
        if not planned.order_bits:
            return "no two nodes tie where they are seen"
        return ("nodes tie at some pixel, where their fragments come in any order: "
                f"{planned.node_order_bits} for the node" + (
                    f", the rest for {rounds}" if planned.round_bits else ""))
    if shares.rounds == 1:
        return "each node draws one run of the list, so that ties go to the lower one"
    if planned.order_bits:
        return f"nodes tie at some pixel, and have {rounds}"
    return "no tie between nodes goes to a higher one"
