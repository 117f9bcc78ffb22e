"""What the map of assignments, and the paper's own table, say: sentences, made of the numbers."""

from __future__ import annotations

from collections.abc import Sequence

from .assignments.assignment import ASSIGNMENTS, NEAREST_WORK, ROUND_ROBIN
from .assignments.frame_times import MAP_NODES, AssignmentTimes, MeanTimes, mean_times
from .expected_traffic import evenly
from .paper_table import PaperRow, paper_rows


def area_of_equation_4() -> str | None:
    """On which pixels the paper's own figure must have taken the average depth."""
    row = next((row for row in paper_rows() if _bounds_nothing(row)), None)
    if row is None:
        return None
    return (f"Over the screen, whose average depth is {row.found_depth:.2f}, equation 4 gives all "
            f"{row.fragments:,} pixels of {row.name}, which no traffic exceeds; yet the authors "
            "observe more than they expect.  So their average cannot be over the whole screen; "
            "here it is over the pixels that are drawn.")


def _bounds_nothing(row: PaperRow) -> bool:
    return row.name == "Zinnia" and evenly(row.area, row.fragments) == row.fragments


def assignment_findings(maps: Sequence[AssignmentTimes]) -> list[str]:
    """Of all maps together; then what moves with the nodes."""
    if not maps:
        return []
    means = mean_times(maps, ROUND_ROBIN)
    kept = [assignment.name for assignment in ASSIGNMENTS if assignment.keeps_order]
    best = min(kept, key=lambda name: means[name].in_turn)
    packet = min((name for name in kept if not name.startswith("runs")),
                 key=lambda name: means[name].in_turn)
    lines = [
        f"Shortest of those that keep the list's order: {best}, {_part(means[best])}.  Shortest of "
        f"the packets: {packet}, {_part(means[packet])}.",
        f"Shortest of all: {NEAREST_WORK}; {_part(means[NEAREST_WORK])}.  "
        f"{_least(maps, NEAREST_WORK)}",
    ]
    def imbalance(each: AssignmentTimes) -> float:
        return each.of("contiguous").busiest - each.of(best).busiest

    worst = max((each for each in maps if each.nodes == MAP_NODES[1]), key=imbalance)
    lines.append(
        f"Contiguous shares send less than round robin, and balance worse: of {worst.scene} one "
        f"node of {worst.nodes} draws {100 * worst.of('contiguous').busiest:.0f} %, and with "
        f"{best} {100 * worst.of(best).busiest:.0f} %.")
    bound = [each for each in maps if each.of(best).merge >= each.of(best).draw]
    lines.append(
        f"Merging takes longer than drawing in {len(bound)} of {len(maps)} cases even with {best}: "
        "there, overlapped, the bus alone decides, and what is sent is what counts.")
    return lines


def _part(mean: MeanTimes) -> str:
    return (f"{mean.in_turn:.2f} of a frame by round robin where it is drawn and then merged, "
            f"{mean.overlapped:.2f} where both overlap, {mean.draw:.2f} of its drawing alone")


def _least(maps: Sequence[AssignmentTimes], name: str) -> str:
    close = [each for each in maps if each.of(name).sent < 1.02]
    return (f"In {len(close)} of {len(maps)} cases it sends at most 2 % more than the least that "
            "there can be.  It is another list: of equal depths another triangle may be seen, and "
            "a list that is retained is only nearest first from where it was sorted.")
