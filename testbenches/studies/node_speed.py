"""How fast nodes draw: shares sent one after another and lists kept in the nodes, with the bounds.

Sixteen nodes of one processing element and two memory units, 512 by 512 pixels, triangles set up
by the host; ``random_bbox16`` has its list sixteen times, so that a run of it for each node is the
list once.  Every picture is compared with the golden one.
"""

from __future__ import annotations

import json
from collections.abc import Iterator
from dataclasses import asdict, dataclass

import click

from cardcage.golden.cycles.cycle_model import predict_cycles
from cardcage.golden.cycles.merge_clocks import predict_merge
from cardcage.golden.merging.cage import merge_cage
from cardcage.golden.organisations.organisation_of import organisation_of
from cardcage.golden.planning.machine_plan import plan
from cardcage.golden.specification.configuration import Packet
from cardcage.golden.specification.display_list import DisplayList
from cardcage.testbenches.frames.compare import compare
from cardcage.testbenches.frames.simulation import simulate_frame
from cardcage.testbenches.speed.cases import case_lists
from cardcage.testbenches.support.text_table import TextTable

NODES = 16
CASES = {"random_bbox16": 16, "mesh": 1}  # how often the list is repeated
WAYS: tuple[tuple[bool, Packet], ...] = (
    (False, "contiguous"), (False, 100), (False, 1), (True, "contiguous"), (True, 1))


@dataclass(frozen=True)
class Row:
    """A list on a cage; clocks are of one frame, pictures equal to the golden one.

    ``bound``        the greater of the broadcast and the busiest node's work, at best
    ``model``        draw clocks by the cycle model
    ``merge``, ``merge_model``  after drawing
    ``merge_bound``  1.05 · Σ over steps of the longest list + Σ (64 + 4·2^s + words / 4096)
    """

    case: str
    cards: str
    retained: bool
    packet: Packet
    order_bits: int
    triangles: int
    draw: int
    bound: float
    model: float
    fragments_per_clock: float
    clocks_per_triangle: float
    merge: int
    merge_model: int
    merge_bound: float
    sent: int
    equal: bool


def measured(case: str, display_list: DisplayList, cards: str, ports: int, retained: bool,
             packet: Packet) -> Row:
    """Draw the list once on a simulated cage, and follow it with the model."""
    machine = plan(display_list, cards=cards, memory_ports=ports, packet=packet,
                   retain=retained).configuration
    simulation = simulate_frame(machine, display_list)
    model = predict_cycles(machine, display_list, retained=retained)
    _, traffic = merge_cage(machine, display_list)
    after_drawing = organisation_of(machine).merges_after_drawing
    bound = sum(1.05 * pixels + 64 + 4 * 2**step + machine.words / 4096
                for step, pixels in enumerate(traffic.steps)) if after_drawing else 0
    assert simulation.merge_cycles is not None
    sends = {send.sender: send.pixels for send in traffic.sends}
    fragments = sum(work.fragments for work in simulation.work)
    return Row(
        case, cards, retained, packet, machine.order_bits, display_list.triangles,
        simulation.draw_cycles, model.bound, model.cycles,
        fragments / simulation.draw_cycles, simulation.draw_cycles / display_list.triangles,
        simulation.merge_cycles - simulation.draw_cycles, predict_merge(machine, display_list),
        bound, traffic.pixels,
        compare(machine, display_list, simulation).equal
        and all(simulation.sent[node] == pixels for node, pixels in sends.items()))


def rows(merge: str, ports: int, cases: tuple[str, ...]) -> Iterator[Row]:
    for case in cases:
        display_list = case_lists(case, order="random", times=CASES[case]).once
        for retained, packet in WAYS:
            yield measured(case, display_list, f"{NODES}x(PMM{merge})", ports, retained, packet)


@click.command()
@click.option("--merge", type=click.Choice(["C", "T"]), default="C", show_default=True)
@click.option("--ports", type=click.IntRange(1, 2), default=2, show_default=True,
              help="Of each memory unit.")
@click.option("--case", "cases", type=click.Choice(list(CASES)), multiple=True,
              default=list(CASES), show_default=True)
@click.option("--json", "as_json", is_flag=True)
def main(merge: str, ports: int, cases: tuple[str, ...], as_json: bool) -> None:
    """Measure sixteen nodes.

    \b
    Examples:
      python -m testbenches.studies.node_speed
      python -m testbenches.studies.node_speed --merge T --case mesh --json
    """
    found = []
    for row in rows(merge, ports, cases):
        found.append(row)
        if not as_json:
            click.echo(f"{row.case} {'retained' if row.retained else 'immediate'} {row.packet}: "
                       f"{row.draw:,}", err=True)
    if as_json:
        click.echo(json.dumps([asdict(row) for row in found], indent=2))
        return
    click.echo(table(merge, found).text())


def table(merge: str, found: list[Row]) -> TextTable:
    return TextTable(
        f"{NODES} nodes, merged by {merge}",
        ("case", "lists", "packet", "draw", "of bound", "model", "fragments/clock",
         "clocks/triangle", "merge", "of bar", "model", "sent", "equal"),
        tuple((
            row.case, "retained" if row.retained else "immediate", str(row.packet),
            f"{row.draw:,}", f"{row.draw / row.bound:.3f}", f"{row.model / row.draw:.3f}",
            f"{row.fragments_per_clock:.2f}", f"{row.clocks_per_triangle:.3f}", f"{row.merge:,}",
            f"{row.merge / row.merge_bound:.2f}" if row.merge_bound else "-",
            f"{row.merge_model / row.merge:.3f}" if row.merge else "-", f"{row.sent:,}",
            "yes" if row.equal else "NO") for row in found))


if __name__ == "__main__":
    main()
