"""Objects made in nodes against triangles sent by the host: words on the host link, clocks to draw.

A thousand spheres of 512 triangles, eight pixels in radius, on sixteen nodes that merge in a tree,
both ways by vertices: the host sends every triangle, set up by the controller; or the meshes once
and then objects, whose triangles each node makes and sets up.  Clocks are those of the cycle model,
or with ``--simulate`` of the machine as well, whose picture and counts are then compared.
"""

from __future__ import annotations

import tempfile
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import click

from cardcage.golden.cycles.cycle_model import predict_cycles
from cardcage.golden.cycles.merge_clocks import predict_merge
from cardcage.golden.merging.cage import merge_cage
from cardcage.golden.objects.making import link_words, triangle_link_words
from cardcage.golden.planning.machine_plan import plan
from cardcage.golden.scene_display_list import make_display_list
from cardcage.golden.specification.configuration import MachineConfiguration
from cardcage.golden.specification.display_list import DisplayList
from cardcage.testbenches.frames.compare import compare
from cardcage.testbenches.frames.node_counts import count_differences, node_figures
from cardcage.testbenches.frames.object_figures import object_figures
from cardcage.testbenches.frames.setup_timing import setup_timing
from cardcage.testbenches.frames.simulation import simulate_frame
from cardcage.testbenches.frames.wrong_counts import wrong_counts
from cardcage.testbenches.machine_options import SETUPS, SetupChoice
from cardcage.testbenches.support.text_table import TextTable

#: Packets of each way: of triangles, and of objects.
PACKET = 10


@dataclass(frozen=True)
class Rates:
    """``words``, of 32 bits, with the meshes; ``draw`` and ``merge`` in clocks."""

    words: int
    draw: int
    merge: int
    simulated: int | None = None


def spheres(count: int, recursion: int, radius: float, size: int) -> DisplayList:
    """So many, of so many pixels, all over the picture."""
    scale = 2.0 * radius / size
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder, "spheres.scene")
        path.write_text(f"size {size}x{size}\nobj sphere scale {scale:.9f} recursion {recursion} "
                        f"num {count} seed 1 color random\n", encoding="utf-8")
        return make_display_list(path, width=size, height=size).display_list


def machine(listed: DisplayList, nodes: int, setup: SetupChoice, **fields: Any
            ) -> MachineConfiguration:
    return plan(listed, cards=f"{nodes}x(PMMT)", memory_ports=2, clocks_per_pixel=2,
                packet=PACKET, **SETUPS[setup], **fields).configuration


def rates(configuration: MachineConfiguration, listed: DisplayList, *, simulate: bool) -> Rates:
    """Raises ``SystemExit`` where a simulated picture or a count is not golden's."""
    words = (triangle_link_words(configuration, listed) if configuration.objects is None
             else link_words(configuration, listed).total)
    draw = round(predict_cycles(configuration, listed, setup=setup_timing(configuration)).cycles)
    found = None
    if simulate:
        simulation = simulate_frame(configuration, listed, engine="verilator")
        golden = merge_cage(configuration, listed)[1]
        counts = count_differences(node_figures(configuration, listed, simulation, golden))
        counts += wrong_counts(object_figures(configuration, listed, simulation))
        if counts or not compare(configuration, listed, simulation).equal:
            raise SystemExit(f"{configuration.cards}: the picture or a count differs: {counts}")
        found = simulation.draw_cycles
    return Rates(words, draw, predict_merge(configuration, listed), found)


@click.command()
@click.option("--count", type=click.IntRange(1, 4000), default=1000, show_default=True)
@click.option("--recursion", type=click.IntRange(0, 5), default=3, show_default=True,
              help="Subdivisions of an octahedron.")
@click.option("--radius", type=float, default=8.0, show_default=True, help="In pixels.")
@click.option("--size", type=click.IntRange(16, 1024), default=512, show_default=True)
@click.option("--nodes", type=click.IntRange(1, 64), default=16, show_default=True)
@click.option("--setup", type=click.Choice(["fast", "small"]), default="fast", show_default=True,
              help="Of the controller, and of each node.")
@click.option("--simulate", is_flag=True, help="Draw it in RTL, too, and compare.")
def main(count: int, recursion: int, radius: float, size: int, nodes: int, setup: SetupChoice,
         simulate: bool) -> None:
    """Objects made in nodes against triangles sent by the host."""
    listed = spheres(count, recursion, radius, size)
    ways = {"triangles from the host": machine(listed, nodes, setup),
            "objects made in nodes": machine(listed, nodes, setup, objects="nodes")}
    found = {way: rates(configuration, listed, simulate=simulate)
             for way, configuration in ways.items()}
    host, made = found.values()
    rows = [(way, f"{each.words:,}", f"{each.draw:,}",
             "-" if each.simulated is None else f"{each.simulated:,}", f"{each.merge:,}")
            for way, each in found.items()]
    rows.append(("ratio", f"1/{host.words / made.words:.0f}", f"1/{host.draw / made.draw:.1f}",
                 "-" if made.simulated is None or host.simulated is None else
                 f"1/{host.simulated / made.simulated:.1f}", "-"))
    click.echo(TextTable(
        f"{count:,} spheres of {listed.triangles // count} triangles, radius {radius:g} pixels, "
        f"{nodes}x(PMMT), {size}x{size}, set-up {setup}",
        ("way", "words on the link", "clocks to draw", "simulated", "to merge"),
        tuple(rows)).text())


if __name__ == "__main__":
    main()
