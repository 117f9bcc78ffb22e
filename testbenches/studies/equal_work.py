"""Runs of equal work where the host sends all triangles in every frame: how long drawing takes.

Whose each triangle is then matters less than when it is sent, a triangle a clock for all nodes
together.  Runs of a list have different numbers of triangles; they are sent side by side

* by place: the first of each run, the second of each, …
* by work: so that of each run as much work has been sent

and compared with what the machine's packets take, by the cycle model; sixteen nodes ``PMM`` with
two ports that merge in a chain.
"""

from __future__ import annotations

from unittest.mock import patch

import click
import numpy as np
from numpy.typing import NDArray

from cardcage.golden.cycles.cycle_model import predict_cycles
from cardcage.golden.organisations.organisation import Organisation
from cardcage.golden.organisations.shares import Shares
from cardcage.golden.planning.machine_plan import plan
from cardcage.golden.specification.configuration import MachineConfiguration
from cardcage.golden.specification.display_list import DisplayList
from cardcage.testbenches.figures.assignments.assignment import runs, work
from cardcage.testbenches.figures.cox_hanrahan import DEFAULT_SIZE
from cardcage.testbenches.figures.figure_scenes import figure_scenes
from cardcage.testbenches.support.text_table import TextTable

NODES = 16
SCENES = ("teapot", "sphereflake", "spheres", "tetra", "terrain", "random as Wash.ht")

Int64 = NDArray[np.int64]


def planned(display_list: DisplayList, packet: int | str) -> MachineConfiguration:
    return plan(display_list, cards=f"{NODES}x(PMMC)", memory_ports=2, packet=packet).configuration


def dealt(node: Int64, order: Int64) -> Shares:
    """Shares of one round: ``node`` of each triangle, in the ``order`` in which they are sent."""
    shares = Shares(NODES, len(node), "contiguous")
    place = np.empty(len(order), np.int64)
    place[order] = np.arange(len(order))
    # What the packets would say is taken from where it is kept once it is known.
    vars(shares).update(node=node, host_order=order, host_place=place)
    return shares


def draw_clocks(display_list: DisplayList) -> dict[str, int]:
    """By each way to deal and to send the triangles."""
    found = {name: round(predict_cycles(planned(display_list, packet), display_list).cycles)
             for name, packet in (("round robin", 1), ("contiguous", "contiguous"))}
    costs = work(display_list)
    node = runs(costs, NODES)
    begins = np.searchsorted(node, node)  # the first triangle of each one's run
    before = np.cumsum(costs) - costs
    keys = {"place": np.arange(len(node)) - begins, "work": before - before[begins] + costs / 2}
    machine = planned(display_list, "contiguous")
    for name, key in keys.items():
        shares = dealt(node, np.lexsort((node, key)))
        with patch.object(Organisation, "shares", lambda self, triangles, shares=shares: shares):
            found[f"equal work, sent by {name}"] = round(
                predict_cycles(machine, display_list).cycles)
    return found


@click.command()
def main() -> None:
    """Print the clocks of six scenes.

    \b
    Example:
      python -m testbenches.studies.equal_work
    """
    rows = {scene.name: draw_clocks(scene.display_list(DEFAULT_SIZE))
            for scene in figure_scenes(DEFAULT_SIZE) if scene.name in SCENES}
    columns = tuple(next(iter(rows.values())))
    click.echo(TextTable(
        f"clocks to draw, {NODES} nodes, triangles sent in every frame", ("scene", *columns),
        tuple((name, *(f"{found[column]:,}" for column in columns))
              for name, found in rows.items())).text())


if __name__ == "__main__":
    main()
