"""``cardcage compare``."""

from __future__ import annotations

import json
import sys
from pathlib import Path
from typing import Any

import click

from ....golden.specification.card_order import MAXIMUM_NODES
from ...comparison.compare_cages import (
    DEFAULT_SIMULATE,
    compare_cages,
    default_cards,
    expected_steps,
)
from ...comparison.comparison_facts import comparison_facts
from ...comparison.comparison_table import comparison_table, comparison_text
from ...engines.choose_engine import AUTO, ENGINE_NAMES
from ...render import DEFAULT_SCENE
from ...support.progress import step_bar
from ..command_group import EXIT_DIFFERENT, warn
from ..command_options import Several, machine_options_of_cages, sequence_options


@click.command(name="compare")
@click.argument("scene", default=DEFAULT_SCENE, metavar="[SCENE]")
@machine_options_of_cages
@click.option("--nodes", type=Several(click.IntRange(1, MAXIMUM_NODES), "N,…"),
              help="Also each kind of cage with so many nodes: speed-up of the scene, and of one "
              "that grows with the machine.")
@sequence_options
@click.option("--simulate", type=click.IntRange(0, MAXIMUM_NODES), default=DEFAULT_SIMULATE,
              show_default=True, metavar="N", help="With --nodes: simulate cages of up to N nodes; "
              "of all of them the cycle model is asked.")
@click.option("--cells", is_flag=True, help="Also count the cells of every board with yosys, half "
              "a minute for each cage.")
@click.option("--engine", type=click.Choice([AUTO, *ENGINE_NAMES]), default=AUTO, show_default=True,
              help="The simulator.")
@click.option("--random-memory", type=click.IntRange(0), metavar="SEED",
              help="Start with random words in every memory, as after power-on.")
@click.option("--json", "as_json", is_flag=True, help="For programs: print one object.")
@click.option("--out", type=click.Path(path_type=Path), default=Path("cardcage-out"),
              show_default=True, metavar="DIR", help="Folder of the report.")
@click.pass_obj
def compare_command(command_line: str, /, scene: str, cards: tuple[str, ...],
                    retain: bool | None, nodes: tuple[int, ...] | None, as_json: bool,
                    **options: Any) -> None:
    """Draw SCENE on several cages and compare what they show and what it costs.

    All elements of one node see every triangle; nodes each draw a share of them and merge their
    pictures: in a chain (C) while the screen is scanned, in a tree (T) when drawing is done, or on
    a bus (S) to frame units (F); or each fragment goes to its memory unit directly (D).  With
    regions, as in 4x(PMM)/8x8, elements draw the parts of the screen that a table gives them.  With
    a place behind it, as in 4x(PMMT)@nodes, 4x(PMM)/4x4@elements and 4x(PMM)@controller, a cage
    makes the triangles of a scene file's objects there, whatever --objects asks of the others.
    Every pixel, every fragment and every pixel sent between nodes is compared with the golden
    model.  For each cage: clocks to load, draw and merge, the latency from the last triangle to the
    screen, the busiest node's share, what goes over the busiest link, memory.  All options but
    --cards are for all cages, which are simulated at the same time, on all cores.  The report goes
    to DIR: open comparison.html.

    \b
    Examples:
      cardcage compare
      cardcage compare mesh.obj --size 128x128 --memory-ports 2
      cardcage compare teapot --cards '8x(PMM)' --cards '8x(PMMT)' --packet contiguous
      cardcage compare teapot --cards '4x(PMMPMMC)' --cards '2x(PMMPMMPMMPMMC)' --immediate
      cardcage compare --cards '4x(PMM)' --cards '4x(PMMS)FF' --cards '4xPD8xM'
      cardcage compare teapot --cards '4x(PMM)' --cards '4x(PMM)/8x8' --cards '3x(PMM)/8x8'
      cardcage compare teapot --cards '4x(PMM)/1x4' --cards '4x(PMM)/2x2' --balance static
      cardcage compare three_cubes --cards '2x(PMMT)' --cards '2x(PMMT)@nodes' --setup fast
      cardcage compare crystals --cards '4x(PMM)@controller' --cards '4x(PMM)/4x4@elements'
      cardcage compare teapot --frames 8 --turn 45
      cardcage compare sphereflake:depth=1 --nodes 1,2,4,8,16
      cardcage compare sphereflake:depth=1 --nodes 1,2,4,8,16,32,64 --simulate 0
      cardcage compare random:n=40,size=12,seed=7 --size 32x32 --cells --json

    Exit status: 0 every picture and every count as golden, 1 otherwise, or a cage delivers no
    picture, 2 the input or the system is at fault, or no cage can be built for the scene.
    """
    which: dict[str, Any] = {"cards": cards or default_cards(scene), "retain": retain,
                             "nodes": nodes or ()}
    with step_bar(expected_steps(**which)) as step:
        comparison = compare_cages(scene, step=step, command_line=command_line, **which, **options)
    for warning in comparison.warnings:
        warn(warning)
    if as_json:
        click.echo(json.dumps(comparison_facts(comparison), indent=2))
    else:
        if sys.stdout.isatty():
            comparison_table(comparison)
        else:
            click.echo(comparison_text(comparison))
        click.echo(f"report: {comparison.report}")
    if not comparison.equal:
        click.get_current_context().exit(EXIT_DIFFERENT)
