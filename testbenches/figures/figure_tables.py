"""The tables of the page, for a terminal and for the page itself."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

from ..support.text_table import TextTable
from .assignments.assignment import ASSIGNMENTS, ROUND_ROBIN
from .assignments.frame_times import MAP_NODES, mean_times
from .claims import summary
from .cox_hanrahan import CoxHanrahan
from .figure_scenes import Size
from .findings import assignment_findings
from .merge_costs import NODES, MergeCosts, merge_size
from .paper_table import contradictions, paper_rows
from .scene_traffic import PACKETS, SHUFFLED

#: Stands for a figure that was not measured.
ON_REQUEST = "--cells"
NOTHING = "-"


def headline(found: CoxHanrahan) -> list[str]:
    """What machines did otherwise, then each claim of the paper, and what was found beyond it."""
    return [*(f"DIFFERENT: {line}" for line in found.differences),
            *map(str, summary(found.scenes)), *assignment_findings(found.maps)]


def tables(found: CoxHanrahan) -> list[TextTable]:
    """All that there are figures for."""
    made = [table_1(found), paper_table(), traffic_table(found)]
    if found.maps:
        made.append(assignment_table(found))
    if found.merges:
        made.append(merge_table(found.merges, found.size))
    return made


def table_1(found: CoxHanrahan) -> TextTable:
    width, height = found.size
    return TextTable(
        f"table 1, our scenes at {width}x{height}",
        ("scene", "triangles", "after clipping", "mean size", "fragments", "area", "depth",
         "pixels drawn", "depth of these"),
        tuple((scene.name, f"{scene.given:,}", f"{scene.triangles:,}", f"{scene.mean_size:.2f}",
               f"{scene.fragments:,}", f"{scene.area:,}", f"{scene.depth:.2f}",
               f"{scene.pixels:,}", f"{scene.drawn_depth:.2f}") for scene in found.scenes))


def paper_table() -> TextTable:
    wrong = len(contradictions())
    return TextTable(
        f"table 1, as the paper prints it; {wrong} rows do not multiply out",
        ("scene", "primitives", "after clipping", "mean size", "pixels", "area", "depth",
         "mean size by the counts", "depth by the counts"),
        tuple((row.name, NOTHING if row.given is None else f"{row.given:,}",
               f"{row.triangles:,}", f"{row.mean_size:,.2f}", f"{row.fragments:,}",
               f"{row.area:,}", f"{row.depth:.2f}", f"{row.found_size:,.2f}",
               f"{row.found_depth:.2f}") for row in paper_rows()))


def traffic_table(found: CoxHanrahan) -> TextTable:
    names = (*PACKETS, SHUFFLED)
    return TextTable(
        f"traffic over the least, {NODES} nodes (the busiest node's part of the fragments)",
        ("scene", *names, "expected, equation 4", "equation 3", f"among {NODES}", "maximum"),
        tuple((scene.name, *(f"{scene.observed(NODES, name):.2f} "
                             f"({scene.busiest(NODES, name):.0%})" for name in names),
               f"{scene.expected:.2f}", f"{scene.expected_by_pixel:.2f}",
               f"{scene.among(NODES):.2f}", f"{scene.maximum:.2f}")
              for scene in found.scenes))


def assignment_table(found: CoxHanrahan) -> TextTable:
    columns = [mean_times(found.maps, ROUND_ROBIN)] + [
        mean_times([each for each in found.maps if each.nodes == nodes], ROUND_ROBIN)
        for nodes in MAP_NODES]
    return TextTable(
        "frame time against round robin, geometric mean of the scenes: drawing alone / drawn, "
        "then merged / overlapped",
        ("assignment", "all", *(f"{nodes} nodes" for nodes in MAP_NODES), "keeps the order"),
        tuple((each.name, *(" / ".join(f"{mean:.2f}" for mean in column[each.name])
                            for column in columns),
               "yes" if each.keeps_order else "no") for each in ASSIGNMENTS))


#: The rows of the last table.
_COSTS: dict[str, Callable[[MergeCosts], str]] = {
    "draw, clocks": lambda cost: f"{cost.facts['cycles']['draw']:,}",
    "merge, clocks": lambda cost: f"{cost.facts['cycles']['merge']:,}",
    "a frame, clocks": lambda cost: f"{cost.facts['cycles']['frame']:,}",
    "a frame, scans": lambda cost: "{:.2f}".format(
        cost.facts["cycles"]["frame"] / cost.facts["cycles"]["scan"]),
    "last triangle to picture": lambda cost: _latency(cost, "merged"),
    "last triangle to pins": lambda cost: _latency(cost, "pins"),
    "fragments": lambda cost: f"{cost.facts['fragments']:,}",
    "of the busiest node": lambda cost: f"{cost.facts['busiest_node_share']:.1%}",
    "pixels sent": lambda cost: f"{cost.facts['traffic']['pixels']:,}",
    "on the busiest link": lambda cost: f"{cost.facts['traffic']['busiest_link']['pixels']:,}",
    "bits sent": lambda cost: f"{cost.facts['traffic']['bits']:,}",
    "bits on the busiest link": lambda cost: f"{cost.facts['traffic']['busiest_link']['bits']:,}",
    "memory, bits": lambda cost: f"{cost.facts['memory']['bits']:,}",
    "LUTs of a merge card": lambda cost: _placed(cost.board and f"{cost.board.luts:,}"),
    "MHz of a merge card": lambda cost: _placed(cost.board and f"{cost.board.mhz:.0f}"),
    "LUTs of all cards": lambda cost: _placed(cost.cage_luts and f"{cost.cage_luts:,}"),
    "fragments a clock": lambda cost: f"{cost.fragments_per_clock:.3f}",
    "fragments a clock for 1,000 LUTs": lambda cost: _placed(
        cost.per_lut and f"{1000 * cost.per_lut:.4f}"),
}


def _placed(words: Any) -> str:
    """What was measured of boards that were placed."""
    return str(words or ON_REQUEST)


def _latency(cost: MergeCosts, until: str) -> str:
    latency = cost.facts["latency"]
    return NOTHING if latency is None else f"{latency[until]:,}"


def merge_table(merges: Sequence[MergeCosts], size: Size) -> TextTable:
    """``size`` of the figures."""
    width, height = merge_size(size)
    return TextTable(
        f"merges on {NODES} nodes at {width}x{height}, lists retained, dealt out round robin",
        ("", *(f"{cost.cage.cards} {cost.scene}" for cost in merges)),
        tuple((name, *(word(cost) for cost in merges)) for name, word in _COSTS.items()))
