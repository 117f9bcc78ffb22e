"""The example scenes on all four of Blazek's decompositions and cages of many sizes, against
golden.

On each cage one machine draws all of its scenes in one run, with a host that pauses at
random; every colour on the pins, every depth and every count is compared.  Scenes in perspective
have no objects: they are drawn where the host makes the triangles, by nodes that merge and by
elements that share the picture.
"""

from __future__ import annotations

from dataclasses import dataclass

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
from cardcage.testbenches.support.processes import run_jobs
from cardcage.testbenches.support.progress import step_bar
from cardcage.testbenches.support.text_table import TextTable

from .decomposition_cages import DECOMPOSITIONS, DecompositionCage, decomposition_cages

READ = [commands.command(opcode) for opcode in (Opcode.READ_DEPTH, Opcode.READ_COUNTERS)]


@dataclass(frozen=True)
class Judged:
    """One cage: scenes that it drew, colours compared and depths besides, clocks simulated, and a
    line for each thing that is not golden's."""

    scenes: int
    pixels: int
    cycles: int
    differences: list[str]


@dataclass(frozen=True)
class CageJob:
    """What one cage is to draw, in pictures of ``size`` by ``size``; ``seed`` of the memories'
    contents and of the host's pauses."""

    cage: DecompositionCage
    size: int
    seed: int

    def run(self) -> Judged:
        lists = examples(self.size, self.cage)
        configuration = plan(list(lists.values()), cards=self.cage.cards, clocks_per_pixel=2,
                             **self.cage.fields).configuration
        words = [word for listed in lists.values()
                 for word in [*frame_commands(configuration, listed), *READ]]
        triangles = sum(listed.triangles for listed in lists.values())
        run = VerilatorEngine().run(Job(
            configuration, words, responses_owed(organisation_of(configuration), words),
            memory_seed=self.seed, stall_seed=self.seed,
            maximum_cycles=most_frame_clocks(configuration, max(len(words), triangles))))
        answers, found, pixels = Answers(configuration, run), [], 0
        for number, (name, listed) in enumerate(lists.items()):
            simulation = answers.frame(number, reading=number)
            compared = compare(configuration, listed, simulation)
            pixels += compared.pixels_compared
            if not compared.equal or compared.depths_compared != self.size ** 2:
                found.append(f"{name}: {compared.pixels_different} colours, "
                             f"{compared.depths_different} depths differ")
            golden = merge_cage(configuration, listed)[1]
            found += count_differences(node_figures(configuration, listed, simulation, golden))
            found += wrong_counts(object_figures(configuration, listed, simulation))
        return Judged(len(lists), pixels, run.cycles, found)


def examples(size: int, cage: DecompositionCage) -> dict[str, DisplayList]:
    """Those that such a cage draws."""
    files = {name: read_scene(name).file for name in EXAMPLES}
    return {name: file.display_list(PictureFormat(size, size)) for name, file in files.items()
            if file is not None
            and (cage.orthographic if file.orthographic else cage.perspective)}


@click.command()
@click.option("--decomposition", type=click.Choice(DECOMPOSITIONS), multiple=True,
              default=DECOMPOSITIONS, help="All four, unless told otherwise.")
@click.option("--nodes", default="1,2,3,4,8,16", show_default=True)
@click.option("--size", type=click.IntRange(8, 512), default=32, show_default=True)
@click.option("--seed", type=click.IntRange(0), default=1, show_default=True)
@click.option("--processes", type=click.IntRange(1), help="As many as there are cores.")
def main(decomposition: tuple[str, ...], nodes: str, size: int, seed: int,
         processes: int | None) -> None:
    """The example scenes on cages of all decompositions, against golden."""
    jobs = [CageJob(cage, size, seed) for count in map(int, nodes.split(","))
            for each in DECOMPOSITIONS if each in decomposition
            for cage in decomposition_cages(each, count, size)]
    with step_bar(len(jobs)) as step:
        judged = run_jobs(jobs, "cages", processes, step)
    rows = [(cage.decomposition, cage.cards, cage.how, f"{found.scenes}", f"{found.pixels:,}",
             f"{found.cycles:,}", f"{len(found.differences)}")
            for cage, found in zip((job.cage for job in jobs), judged, strict=True)]
    click.echo(TextTable(
        f"The example scenes, {size}x{size}, with a host that pauses at random, seed {seed}",
        ("decomposition", "cards", "how", "scenes", "pixels", "clocks", "differences"),
        tuple(rows)).text())
    wrong = [f"{job.cage.cards}, {job.cage.how}: {line}"
             for job, found in zip(jobs, judged, strict=True) for line in found.differences]
    for line in wrong:
        click.echo(line)
    click.echo(f"{len(jobs)} cages, {sum(found.pixels for found in judged):,} pixels: "
               f"{len(wrong)} differences")
    raise SystemExit(1 if wrong else 0)


if __name__ == "__main__":
    main()
