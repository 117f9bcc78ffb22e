"""Writes what was redrawn of Blazek: one page, one JSON file, a picture."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, TypeVar

from ...reports.page import page_environment
from ...support.any_characters import readable
from ..verdict import Summary, Verdict
from . import claims
from .blazek import Blazek
from .charts import save_figures, seeds_chart, sensitivity_chart, speed_up_chart
from .claims import Methods, claims_of, claims_of_all, summary
from .facts import PAPER, blazek_facts
from .figure_tables import (
    costs_with_reasons,
    link_table,
    point_table,
    sensitivity_table,
    speed_up_table,
)
from .his_machine import his_claims
from .his_machine.his_claims import his_claims_of, his_summary, polygons_claim
from .his_machine.times import GRID, STRIPS
from .scenes.spheres import SPHERES

#: Everything that ``write_blazek`` writes.
FIGURE_FILES = (f"{PAPER}.html", f"{PAPER}.json", f"{PAPER}.png")

Method = TypeVar("Method")


@dataclass(frozen=True)
class Section:
    """A method: the ``figures`` that are redrawn, what he says of it, how its forms' names begin,
    and which claims are about it."""

    figures: str
    title: str
    sentence: str
    begins: str
    claims: Sequence[str]


SECTIONS = (
    Section("12 and 13", "host initiated",
            "As expected, the host initiated decomposition yields very poor results due to the "
            "host-to-node communications bottleneck.", "host initiated",
            (claims.POOR, his_claims.LINK, claims.FALLS, claims.PACKET, claims.POORER)),
    Section("14 and 15", "node initiated",
            "The node initiated method yielded the best results of all four methods. … The results "
            "come from a minimization of overall communications and an absolutely equal load "
            "balance. Higher numbers of nodes and larger numbers of polygons would maintain the "
            "high results.", "node initiated",
            (claims.BEST, his_claims.BALANCED, claims.MAINTAINED, claims.MERGED)),
    Section("16 and 17", "node initiated with object forwarding",
            "The communications cost of object forwarding weighs very heavily on test runs with "
            "large number of nodes, thus having narrow strips of the frame buffer. … The "
            "performance curves wander quite a bit. … Averaging the run times of many tests would "
            "smooth out the curves, but it is certain that the results would be well below "
            "optimal.", "forwarding",
            (claims.NARROW, claims.WELL_BELOW, his_claims.COMMUNICATION, his_claims.WANDERS,
             his_claims.GRID_FORWARDS, his_claims.POLYGONS)),
    Section("18 and 19", "host broadcast",
            "The broadcast method yielded very good results, though not quite as good as the node "
            "initiated method. … As the number of nodes generating a particular scene increases, "
            "the time to tessellate the broadcast objects remains constant, while the time spent "
            "rendering decreases.", "broadcast",
            (claims.GOOD, his_claims.CONSTANT, claims.LINES, his_claims.BALANCES,
             his_claims.HIERARCHICAL)),
)


@dataclass(frozen=True)
class Shown:
    """A claim on the page."""

    claim: str
    outcome: str
    numbers: str


def write_blazek(found: Blazek, folder: Path) -> None:
    """Write ``FIGURE_FILES`` to ``folder``, which exists."""
    facts = blazek_facts(found)
    page, plain, picture = FIGURE_FILES
    (folder / plain).write_text(json.dumps(facts, indent=2) + "\n", encoding="utf-8")
    (folder / page).write_text(readable(blazek_page(found, facts)), encoding="utf-8")
    save_figures(found.times, found.clocks, found.points, found.sensitivity, folder / picture)


def blazek_page(found: Blazek, facts: dict[str, Any]) -> str:
    """The page, complete in itself."""
    his, ours = Methods(found.times), Methods(found.clocks)
    most = SPHERES[-1]
    of_his = _shown([*summary(his), *his_summary(found.times, found.size)],
                    [*claims_of(his, most), *his_claims_of(found.times, found.size, most),
                     *claims_of_all(his), polygons_claim(found.size)])
    of_ours = _shown(summary(ours), [*claims_of(ours, most), *claims_of_all(ours)])
    return page_environment().get_template("blazek.html").render(
        {name: fact for name, fact in facts.items() if name not in (
            "claims", "points", "sensitivity")},
        warnings=[],
        sections=[(section, speed_up_chart(_of(found.times, section)), _claims(of_his, section),
                   speed_up_chart(_of(found.clocks, section), found.points),
                   _claims(of_ours, section)) for section in SECTIONS],
        seeds_chart=seeds_chart([found.times[STRIPS], found.times[GRID]]),
        sensitivity_chart=sensitivity_chart(found.sensitivity),
        sensitivity_tables=[sensitivity_table(each) for each in found.sensitivity],
        costs_with_reasons=costs_with_reasons(),
        his_table=speed_up_table("his machine: speed-up, seconds", found.times),
        our_table=speed_up_table("ours: speed-up, clocks", found.clocks),
        link_table=link_table(found.clocks),
        point_table=point_table(found.points) if found.points else None,
    )


def _of(methods: Mapping[str, Method], section: Section) -> dict[str, Method]:
    return {name: method for name, method in methods.items() if name.startswith(section.begins)}


def _shown(summaries: Sequence[Summary], verdicts: Sequence[Verdict]) -> dict[str, Shown]:
    """By claim: how often it came out, and the numbers of the largest scene, or of the only
    one."""
    numbers = {verdict.claim: verdict.numbers for verdict in verdicts}
    return {each.claim: Shown(each.claim, each.outcome, numbers[each.claim] if each.scenes == 1 else
                              f"{each.numbers}.  With {SPHERES[-1]:,} spheres: "
                              f"{numbers[each.claim]}") for each in summaries}


def _claims(shown: Mapping[str, Shown], section: Section) -> list[Shown]:
    return [shown[claim] for claim in section.claims if claim in shown]
