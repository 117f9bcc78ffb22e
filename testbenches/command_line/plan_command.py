"""``cardcage plan``."""

from __future__ import annotations

import json
import sys
from pathlib import Path
from typing import Any

import click

from ..machine_options import MachineOptions
from ..render import DEFAULT_SCENE
from ..support.progress import busy
from ..views.asked_views import AskedViews
from .command_group import warn
from .command_options import machine_options, sequence_options
from .tables.plan_table import plan_table, plan_text
from .tables.scene_plan import plan_facts, plan_scene


@click.command(name="plan")
@click.argument("scene", default=DEFAULT_SCENE, metavar="[SCENE]")
@machine_options
@sequence_options
@click.option("--cycles", type=click.IntRange(1), metavar="N",
              help="Choose the cards: the fewest that draw a frame in about that many cycles.")
@click.option("--cells", is_flag=True, help="Also count the cells of a processing element with "
              "yosys, some ten seconds.")
@click.option("--json", "as_json", is_flag=True, help="For programs: one object.")
def plan_command(scene: str, cycles: int | None, cells: bool, as_json: bool,
                 frames: int | None, turn: float | None, path: Path | None,
                 **options: Any) -> None:
    """Say which machine SCENE needs, every number with its reason and what it saves.

    The machine is the one that `cardcage render SCENE` simulates and `cardcage export SCENE`
    writes.  Without --max-error or --fraction-bits its picture is exact.  With --frames or
    --path it is one machine that is exact for all pictures, the one that these commands build with
    the same words; its cycles are those of the slowest picture.

    \b
    Examples:
      cardcage plan
      cardcage plan mesh.obj --size 640x480 --cards '4x(PMM)'
      cardcage plan teapot --max-error 1 --cells
      cardcage plan teapot --frames 8 --turn 45
      cardcage plan sphereflake:depth=2 --cycles 15000 --json
    """
    with busy("counting cells" if cells else "planning"):
        planned = plan_scene(scene, MachineOptions(**options), cycles, count=cells,
                             asked=AskedViews(frames, turn, path))
    for warning in planned.warnings:
        warn(warning)
    if as_json:
        click.echo(json.dumps(plan_facts(planned), indent=2))
    elif sys.stdout.isatty():
        plan_table(planned)
    else:
        click.echo(plan_text(planned))
