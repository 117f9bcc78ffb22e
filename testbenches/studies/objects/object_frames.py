"""The example scenes, their triangles made in nodes or at the controller, on cages of many sizes,
against golden.

On each cage one machine draws all orthographic examples in one run, with a host that
pauses at random; every colour on the pins, every depth and every count is compared.
"""

from __future__ import annotations

import time
from typing import Any

import click

from cardcage.golden.cycles.frame_clocks import most_frame_clocks
from cardcage.golden.merging.cage import merge_cage
from cardcage.golden.organisations.organisation_of import organisation_of
from cardcage.golden.planning.machine_plan import plan
from cardcage.golden.scene_display_list import read_scene
from cardcage.golden.scenes.quantise import PictureFormat
from cardcage.golden.scenes.scene_files.examples import EXAMPLES
from cardcage.golden.specification import commands
from cardcage.golden.specification.commands import Opcode
from cardcage.golden.specification.display_list import DisplayList
from cardcage.testbenches.engines.engine import Job
from cardcage.testbenches.engines.verilator_engine import VerilatorEngine
from cardcage.testbenches.frames.compare import compare
from cardcage.testbenches.frames.conversation import responses_owed
from cardcage.testbenches.frames.frame_job import frame_commands
from cardcage.testbenches.frames.node_counts import count_differences, node_figures
from cardcage.testbenches.frames.object_figures import object_figures
from cardcage.testbenches.frames.responses import Answers
from cardcage.testbenches.frames.wrong_counts import wrong_counts
from cardcage.testbenches.machine_options import SETUPS

from .broadcast_rates import ways

READ = [commands.command(opcode) for opcode in (Opcode.READ_DEPTH, Opcode.READ_COUNTERS)]


def examples(size: int) -> dict[str, DisplayList]:
    """The orthographic ones."""
    files = {name: read_scene(name).file for name in EXAMPLES}
    return {name: file.display_list(PictureFormat(size, size)) for name, file in files.items()
            if file is not None and file.orthographic}


def differences(cards: str, lists: dict[str, DisplayList], seed: int, **fields: Any
                ) -> tuple[int, int, list[str]]:
    """Pixels compared, clocks simulated, and a line for each thing that is not golden's."""
    configuration = plan(list(lists.values()), cards=cards, packet=1, clocks_per_pixel=2,
                         **SETUPS["small"], **fields).configuration
    words = [word for listed in lists.values()
             for word in [*frame_commands(configuration, listed), *READ]]
    triangles = sum(listed.triangles for listed in lists.values())
    run = VerilatorEngine().run(Job(
        configuration, words, responses_owed(organisation_of(configuration), words),
        memory_seed=seed, stall_seed=seed,
        maximum_cycles=most_frame_clocks(configuration, max(len(words), triangles))))
    answers, found, pixels = Answers(configuration, run), [], 0
    for number, (name, listed) in enumerate(lists.items()):
        simulation = answers.frame(number, reading=number)
        compared = compare(configuration, listed, simulation)
        pixels += compared.pixels_compared
        if not compared.equal:
            found.append(f"{name}: {compared.pixels_different} colours, "
                         f"{compared.depths_different} depths differ")
        golden = merge_cage(configuration, listed)[1]
        found += count_differences(node_figures(configuration, listed, simulation, golden))
        found += wrong_counts(object_figures(configuration, listed, simulation))
    return pixels, run.cycles, found


@click.command()
@click.option("--nodes", default="1,2,3,4,8,16", show_default=True)
@click.option("--merge", default="CT", show_default=True, help="Kinds of merge cards.")
@click.option("--broadcast", is_flag=True, help="In place of nodes, elements of one cage to which "
              "the controller sends the triangles, however they share the picture.")
@click.option("--size", type=click.IntRange(8, 512), default=32, show_default=True)
@click.option("--seed", type=click.IntRange(0), default=1, show_default=True)
def main(nodes: str, merge: str, broadcast: bool, size: int, seed: int) -> None:
    """Objects made in nodes or at the controller, against golden."""
    lists, wrong = examples(size), 0
    for count in map(int, nodes.split(",")):
        cages = {f"{count}x(PMM{card})": {"objects": "nodes"} for card in merge}
        if broadcast:
            cages = {f"{count}x(PM), {way}": fields | {"objects": "controller"}
                     for way, fields in ways(count, size).items()}
        for called, fields in cages.items():
            began = time.perf_counter()
            pixels, cycles, found = differences(called.partition(",")[0], lists, seed, **fields)
            click.echo(f"{called}: {len(lists)} scenes, {pixels:,} pixels, {cycles:,} clocks, "
                       f"{len(found)} differences, {time.perf_counter() - began:.0f} s")
            for line in found:
                click.echo(f"  {line}")
            wrong += len(found)
    raise SystemExit(1 if wrong else 0)


if __name__ == "__main__":
    main()
